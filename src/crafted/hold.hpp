#pragma once
// Which disks and contacts can carry a force, from the positions of the normals.

#include <isostat/crafted/exact_packing.hpp>

namespace isostat::crafted {

/// Fills `hold` and `carrying` of an inspection whose contacts are set.
void judge_holds(Inspection& inspection, const ExactPacking& packing);

} // namespace isostat::crafted
