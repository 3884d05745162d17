#pragma once
// Upper bounds of 2-norms over the whole range of double: private to the room, and to descent.cpp of trajectory.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace isostat {

/// Raises a computed sum of at most so many terms >= 0, or its root, above the exact one (B1).
constexpr double sum_slack(std::size_t terms) {
    // 1e-10: precision.md B1; 0x1p-53: exact: u, the unit of rounding
    return 1 + std::max(1e-10, 2 * static_cast<double>(terms) * 0x1p-53);
}

/// A product or quotient that underflows errs by at most this (in truth 2^-1075).
inline constexpr double underflow_unit = 0x1p-1074; // precision.md B1

/// An upper bound of the 2-norm, scaled by a power of two where a
/// square might under- or overflow. NaN or infinity when an entry is.
inline double norm_above(std::span<const double> x) {
    double plain = 0;
    for (const double c : x) {
        plain += c * c;
    }
    if (plain > 0x1p-900 && plain < 0x1p1000) { // the underflow is below 2^-1022 n; precision.md B1
        return std::sqrt(plain) * sum_slack(x.size());
    }
    double largest = 0;
    for (const double entry : x) {
        const double c = std::abs(entry);
        if (!(c <= 0x1p1020)) { // precision.md B1
            return c * 16;      // NaN, infinity, or too large to be used; precision.md B1
        }
        largest = std::max(largest, c);
    }
    if (largest == 0) {
        return 0;
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    // precision.md B1
    exponent = std::max(exponent, -1000); // the scale stays finite, and no square of such small entries underflows
    const double scale = std::ldexp(1.0, -exponent);
    double sum = 0;
    for (const double c : x) {
        const double scaled = c * scale;
        sum += scaled * scaled; // the underflow here is below 2^-1022 n, and the largest term is then at least 1/4
    }
    return std::ldexp(std::sqrt(sum) * sum_slack(x.size()), exponent) + underflow_unit;
}

} // namespace isostat
