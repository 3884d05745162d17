#pragma once
/// \file
/// Constants of error bounds.

#include <limits>

namespace isostat::roundoff {

/// Unit of rounding of double: |fl(a op b) - (a op b)| <= u |a op b|, to nearest and without underflow.
inline constexpr double u = 0x1p-53; // exact: u, the unit of rounding

inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline constexpr double root2 = 1.4142135623731; ///< exact: above the square root of 2

/// Relative error of an entry of a contact matrix in units of u (V0, proofs/bounds.md): it grows with the number of
/// axes, because the square of the distance has so many terms.
constexpr double entry_units(int dimension) {
    return dimension == 2 ? 5.01 : 5.51; // 5.01: bounds.md V0 (plane); 5.51: bounds.md V0 (space)
}

/// Error of a sum of n products of doubles, relative to the sum of their absolute values: gamma_n = n u / (1 - n u).
constexpr double gamma(double terms) {
    return terms * u / (1 - terms * u);
}

} // namespace isostat::roundoff
