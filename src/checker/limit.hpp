#pragma once
/// \file
/// Where the force of one contact vanishes as the load varies.

#include "checker/replay.hpp"

namespace isostat::checker {

/// First-order term of the stress at which the force of a contact vanishes, from the first-order term of the force.
inline Range limit_rate(const Range& first, const Range& slope) {
    return -(first / slope);
}

} // namespace isostat::checker
