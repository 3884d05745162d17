#pragma once
/// \file
/// Where the force of one contact vanishes as the load varies.

#include "checker/replay.hpp"

namespace isostat::checker {

/// Change of the stress from that of the place to where the force of a contact vanishes. \pre its slope is not 0
Range step_to_limit(const Place& place, std::size_t contact);
/// First-order term of the stress at which the force of a contact vanishes, from the first-order term of the force.
Range limit_rate(const Range& first, const Range& slope);

} // namespace isostat::checker
