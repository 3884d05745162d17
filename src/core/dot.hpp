#pragma once
/// \file
/// Scalar product and largest component of long vectors.

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>

namespace isostat {

/// |x|, summed in order.
inline double euclidean_norm(std::span<const double> x) {
    double sum = 0;
    for (const double c : x) {
        sum += c * c;
    }
    return std::sqrt(sum);
}

/// a . b in double, relative to |a| . |b| within n u. Four sums at a time, because a single sum would wait for each
/// addition. The order of additions is fixed, so the bits are the same everywhere.
inline double dot(std::span<const double> a, std::span<const double> b) {
    assert(a.size() == b.size());
    std::array<double, 4> sum{}; // 4: exact: numbers of a vector register
    std::size_t i = 0;
    for (; i + 4 <= a.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k) {
            sum[k] += a[i + k] * b[i + k];
        }
    }
    for (; i < a.size(); ++i) {
        sum[0] += a[i] * b[i];
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]); // exact: the last of four sums
}

/// max |x_i|; 0 without components; NaN when a component is NaN, so that comparisons with the result fail. Several
/// maxima at a time, as in `dot`.
inline double largest(std::span<const double> x) {
    constexpr std::size_t lanes = 8; // exact: numbers of two vector registers
    std::array<double, lanes> most{};
    const auto take = [](double& largest, double size) {
        largest = size <= largest || std::isnan(largest) ? largest : size;
    };
    std::size_t i = 0;
    for (; i + lanes <= x.size(); i += lanes) {
        for (std::size_t k = 0; k < lanes; ++k) {
            take(most[k], std::abs(x[i + k]));
        }
    }
    for (; i < x.size(); ++i) {
        take(most[0], std::abs(x[i]));
    }
    for (const double lane : most) {
        take(most[0], lane);
    }
    return most[0];
}

} // namespace isostat
