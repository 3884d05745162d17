#pragma once
/// \file
/// Quotients of enclosures: private to the rooms statics and trajectory.

#include "core/roundoff.hpp"

#include <isostat/core/result.hpp>

#include <cmath>

namespace isostat {

/// a / b, for b > 0; with radius infinity when b > 0 is not proved.
inline Enclosure quotient(const Enclosure& a, const Enclosure& b) {
    using roundoff::u;
    const double value = a.value / b.value;
    const double smallest = b.value - b.radius;
    if (!(smallest > 0)) {
        return {value, roundoff::infinity};
    }
    // precision.md B9
    return {value, (a.radius + std::abs(value) * b.radius) / smallest * (1 + 8 * u) + 2 * u * std::abs(value)};
}

} // namespace isostat
