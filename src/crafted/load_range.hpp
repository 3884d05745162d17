#pragma once
/// \file
/// How far one force of a load may change while forces >= 0 can still balance the load: private to the room.

#include <isostat/crafted/exact_packing.hpp>

namespace isostat::crafted {

/// Ends of {t : f + t change + sum of c_s stresses_s >= 0 for some c}, exact; nothing
/// when this set is empty. Each end is proved by an optimum of the linear programme
/// and of its dual. Contacts of `LoadRange` are set where there are no self-stresses.
std::optional<LoadRange> load_range(const std::vector<Number>& forces, const std::vector<Number>& change,
                                    const std::vector<std::vector<Number>>& stresses);

} // namespace isostat::crafted
