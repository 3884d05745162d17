#pragma once
/// \file
/// A real number known to a bound.

#include <isostat/core/floating_point.hpp>

#include <cmath>

namespace isostat {

/// The exact value lies in [value - radius, value + radius]. NaN anywhere means: nothing is known.
struct Enclosure {
    double value = 0;
    double radius = 0;
    [[nodiscard]] bool positive() const { return value > radius; }
    [[nodiscard]] bool negative() const { return -value > radius; }
    /// The sign is proved. False says nothing.
    [[nodiscard]] bool decided() const { return positive() || negative(); }
    /// |value| / radius: above 1 the sign is proved. Infinity when the radius is 0 and the value is not.
    [[nodiscard]] double margin() const { return std::abs(value) / radius; }
};

/// Enclosure of the difference; the rounding of the subtraction is added to the radius (2 ulp).
Enclosure operator-(const Enclosure& a, const Enclosure& b);

} // namespace isostat
