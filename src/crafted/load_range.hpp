#pragma once
/// \file
/// How far one force of a load may change until forces >= 0 balance it no longer: private to the room.

#include <isostat/crafted/exact_packing.hpp>

namespace isostat::crafted {

/// Ends of {t : f + t change + sum of c_s stresses_s >= 0 for some c}, exact; nothing where no t is in it. Each end is
/// proved by an optimum of the linear programme and of its dual. Contacts of `LoadRange` are set where the stresses are
/// none.
std::optional<LoadRange> load_range(const std::vector<Number>& forces, const std::vector<Number>& change,
                                    const std::vector<std::vector<Number>>& stresses);

} // namespace isostat::crafted
