#pragma once
/// \file
/// Quotients of enclosures; which of several quantities that change at constant rates vanishes first.

#include "core/roundoff.hpp"

#include <isostat/core/result.hpp>

#include <cmath>
#include <optional>

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

struct Vanishing {
    std::size_t index;
    double distance = roundoff::infinity; ///< distance on the path that the rates refer to
};

/// The first of n quantities to fall to 0, in rounded numbers. Nothing: no quantity falls.
template <class Value, class Rate>
std::optional<Vanishing> first_to_vanish(std::size_t n, const Value& value, const Rate& rate) {
    Vanishing first{n};
    for (std::size_t k = 0; k < n; ++k) {
        const double r = rate(k);
        if (r < 0 && value(k) / -r < first.distance) {
            first = {k, value(k) / -r};
        }
    }
    return first.index < n ? std::optional(first) : std::nullopt;
}

} // namespace isostat
