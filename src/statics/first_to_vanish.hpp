#pragma once
// Which of several quantities that change at constant rates vanishes first.

#include "core/roundoff.hpp"

#include <optional>

namespace isostat {

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
