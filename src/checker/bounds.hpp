#pragma once
/// \file
/// Intervals of doubles; every operation rounds outwards by one step,
/// so that results contain the exact results in any rounding mode.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace isostat::checker {

// exact: above the square root of 2 (checker.md K18, K19)
inline constexpr double root_of_two = 1.4142135623730952;

/// As `std::nextafter` towards infinity, without a call: there are millions.
inline double next_above(double x) {
    if (x == 0 || !(std::abs(x) < std::numeric_limits<double>::infinity())) {
        return std::nextafter(x, std::numeric_limits<double>::infinity());
    }
    return std::bit_cast<double>(std::bit_cast<std::int64_t>(x) + (x > 0 ? 1 : -1));
}
inline double next_below(double x) {
    return -next_above(-x);
}

/// All numbers from lower to upper. An operation that meets NaN or overflows gives an interval of all numbers.
struct Bounds {
    double lower = 0;
    double upper = 0;
    Bounds() = default;
    Bounds(double value) : lower(value), upper(value) {} // NOLINT(google-explicit-constructor): a double is one
    Bounds(double from, double to) : lower(from), upper(to) {
        if (!(lower <= upper)) {
            lower = -std::numeric_limits<double>::infinity();
            upper = std::numeric_limits<double>::infinity();
        }
    }
    static Bounds outwards(double from, double to) { return {next_below(from), next_above(to)}; }
    static Bounds around(double radius) { return {-radius, radius}; }
    [[nodiscard]] bool positive() const { return lower > 0; }
    [[nodiscard]] bool negative() const { return upper < 0; }
    /// Largest magnitude.
    [[nodiscard]] double size() const { return std::max(std::abs(lower), std::abs(upper)); }
    [[nodiscard]] double middle() const { return lower + (upper - lower) / 2; }
};

inline Bounds operator+(const Bounds& a, const Bounds& b) {
    return Bounds::outwards(a.lower + b.lower, a.upper + b.upper);
}
inline Bounds operator-(const Bounds& a, const Bounds& b) {
    return Bounds::outwards(a.lower - b.upper, a.upper - b.lower);
}
inline Bounds operator-(const Bounds& a) {
    return {-a.upper, -a.lower};
}
inline Bounds operator*(const Bounds& a, const Bounds& b) {
    if (a.lower == 0 && a.upper == 0) {
        return a;
    }
    if (b.lower == 0 && b.upper == 0) {
        return b;
    }
    const double p = a.lower * b.lower;
    const double q = a.lower * b.upper;
    const double r = a.upper * b.lower;
    const double s = a.upper * b.upper;
    if (std::isnan(p + q + r + s)) {
        return {1, -1};
    }
    return Bounds::outwards(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}

// Upper bounds of non-negative numbers.
inline double sum_above(double a, double b) {
    return next_above(a + b);
}
inline double product_above(double a, double b) {
    return a == 0 || b == 0 ? 0 : next_above(a * b);
}
inline double quotient_above(double a, double b) {
    return a == 0 ? 0 : next_above(a / b);
}
inline double root_above(double a) {
    return a == 0 ? 0 : next_above(std::sqrt(a));
}

} // namespace isostat::checker
