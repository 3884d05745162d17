#pragma once
/// \file
/// Where the force of one contact vanishes as the load varies.

#include "checker/replay.hpp"

namespace isostat::checker {

/// Way in stress from that of the place to the one at which the force of a contact vanishes; its slope is told from 0.
Range step_to_limit(const Place& place, std::size_t contact);
/// All forces after a step in stress.
std::vector<Range> forces_after(const Place& place, const Range& step);
/// First-order term of the stress at which the force of a contact vanishes, from its first-order term there.
Range limit_rate(const Range& first, const Range& slope);

} // namespace isostat::checker
