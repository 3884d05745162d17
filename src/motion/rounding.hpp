#pragma once
// Bounds of rounding that several files on arcs use (statement A8, proofs/arcs.md): private to the room.

#include "core/roundoff.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace isostat {

using roundoff::u;
/// Factor for sums over all coordinates, their roots, a few products: relative rounding below 1e-9 (B1).
inline constexpr double upward = 1 + 1e-9; // arcs.md A8
using roundoff::root2;
/// Relative error of a product with the exact row of a contact, in units of u: entries, products and their sum.
constexpr double row_units(int dimension) {
    return dimension == 2 ? 16 : 22; // 16: arcs.md A8 (a row); 22: arcs.md A8 (a row, in space)
}

template <std::size_t size> inline double dot(const std::array<double, size>& x, const std::array<double, size>& y) {
    double sum = 0;
    for (std::size_t c = 0; c < size; ++c) {
        sum += x[c] * y[c];
    }
    return sum;
}

/// A sum of products, and the sum of their absolute values, to which its rounding is relative.
struct RoundedSum {
    double value = 0;
    double absolute = 0;

    void add(double term) {
        value += term;
        absolute += std::abs(term);
    }
    /// x . y.
    template <std::size_t size> void add(const std::array<double, size>& x, const std::array<double, size>& y) {
        double sum = 0;
        double terms = 0;
        for (std::size_t c = 0; c < size; ++c) {
            sum += x[c] * y[c];
            terms += std::abs(x[c] * y[c]);
        }
        value += sum;
        absolute += terms;
    }
};

/// Half the coefficient of s^k in |d_1 s + d_2 s^2 + ...|^2 (d_0 is not read): a product of two vectors is taken once.
template <std::size_t size> inline RoundedSum half_square(std::span<const std::array<double, size>> d, std::size_t k) {
    const std::size_t order = d.size() - 1;
    RoundedSum sum;
    if (k % 2 == 0) {
        sum.add(d[k / 2], d[k / 2]);
        sum.value *= 0.5; // 0.5: exact: a half
        sum.absolute *= 0.5;
    }
    for (std::size_t i = k > order ? k - order : 1; 2 * i < k; ++i) {
        sum.add(d[i], d[k - i]);
    }
    return sum;
}

} // namespace isostat
