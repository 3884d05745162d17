#pragma once
// Common rigid motions of a packing.

#include <isostat/packing/packing.hpp>

#include <vector>

namespace isostat::crafted {

/// Dimension of the common rigid motions that neither a fixed disk nor a wall takes away; `disks` of them take part.
int rigid_motions(const Walls& walls, const std::vector<unsigned char>& fixed, int disks, int dimension = 2);
/// The same where axes may be periodic: along them a disk is pinned, and nothing turns.
int rigid_motions(const Packing& packing, int disks);

} // namespace isostat::crafted
