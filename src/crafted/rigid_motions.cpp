#include "crafted/rigid_motions.hpp"

#include <algorithm>

namespace isostat::crafted {

namespace {

/// Planes that the grains can turn in: those of two axes without walls.
int turns(const Walls& walls, int disks, std::size_t axes) {
    const auto open = [&walls](std::size_t a) {
        return walls.lower[a] == WallKind::absent && walls.upper[a] == WallKind::absent;
    };
    int planes = 0;
    for (std::size_t b = 1; b < axes && disks > 1; ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            planes += open(a) && open(b) ? 1 : 0;
        }
    }
    return planes == 3 && disks == 2 ? 2 : planes; // nothing moves as two spheres turn about their line
}

bool is_held(const Walls& walls, std::size_t a) { // a movable wall goes along
    return walls.lower[a] == WallKind::fixed || walls.upper[a] == WallKind::fixed;
}

} // namespace

int rigid_motions(const Walls& walls, const std::vector<unsigned char>& fixed, int disks, int dimension) {
    const auto axes = static_cast<std::size_t>(dimension);
    const auto held = std::count(fixed.begin(), fixed.end(), 1);
    if (held > 0) {
        return held == 1 ? turns(walls, disks, axes) : 0; // about the fixed centre
    }
    int out = turns(walls, disks, axes);
    for (std::size_t a = 0; a < axes; ++a) {
        out += is_held(walls, a) ? 0 : 1;
    }
    return out;
}

int rigid_motions(const Packing& packing, int disks) {
    if (!packing.cell.any()) {
        return rigid_motions(packing.walls, packing.fixed, disks, packing.dimension);
    }
    int out = 0;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        out += is_held(packing.walls, a) || packing.cell.periodic[a] ? 0 : 1;
    }
    return out;
}

} // namespace isostat::crafted
