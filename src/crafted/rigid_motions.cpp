#include "crafted/rigid_motions.hpp"

#include <algorithm>

namespace isostat::crafted {

int rigid_motions(const Walls& walls, const std::vector<unsigned char>& fixed, int disks) {
    const auto held = std::count(fixed.begin(), fixed.end(), 1);
    const bool no_walls = walls == Walls::none();
    if (held > 0) {
        return held == 1 && no_walls && disks > 1 ? 1 : 0; // turning about the fixed centre
    }
    int out = no_walls && disks > 1 ? 1 : 0;
    for (std::size_t a = 0; a < 2; ++a) {
        out +=
            walls.lower[a] == WallKind::fixed || walls.upper[a] == WallKind::fixed ? 0 : 1; // a movable wall goes along
    }
    return out;
}

int rigid_motions(const Packing& packing, int disks) {
    if (!packing.cell.any()) {
        return rigid_motions(packing.walls, packing.fixed, disks);
    }
    int out = 0;
    for (std::size_t a = 0; a < 2; ++a) {
        const bool held = packing.walls.lower[a] == WallKind::fixed || packing.walls.upper[a] == WallKind::fixed;
        out += held || packing.cell.periodic[a] ? 0 : 1;
    }
    return out;
}

} // namespace isostat::crafted
