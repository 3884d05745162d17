#pragma once
/// \file
/// Scalar product of long vectors.

#include <array>
#include <cassert>
#include <cstddef>
#include <span>

namespace isostat {

/// a . b in double, relative to |a| . |b| within n u. Four sums at a time: a single one would wait for each addition.
/// The order is fixed: the same bits everywhere.
inline double dot(std::span<const double> a, std::span<const double> b) {
    assert(a.size() == b.size());
    std::array<double, 4> sum{};
    std::size_t i = 0;
    for (; i + 4 <= a.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k) {
            sum[k] += a[i + k] * b[i + k];
        }
    }
    for (; i < a.size(); ++i) {
        sum[0] += a[i] * b[i];
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

} // namespace isostat
