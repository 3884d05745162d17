#pragma once
// Grains without walls.

#include <isostat/contact/state.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace without_walls {

/// `q`: the centres, then the lengths and tilts of a cell, which may be left out.
inline isostat::Packing free_grains(std::vector<double> radius, std::vector<double> q, int dimension = 2) {
    isostat::Packing packing;
    packing.dimension = packing.cell.dimension = dimension;
    packing.walls = isostat::Walls::none();
    packing.radius = std::move(radius);
    packing.q = std::move(q);
    packing.q.resize(std::max(packing.q.size(), packing.coordinate_count()), 0.0);
    return packing;
}

/// Disk 2 touches the disks 0 and 1, which are fixed.
inline isostat::State held_by_two(std::vector<double> radius, std::vector<double> centres) {
    using enum isostat::ContactKind;
    isostat::State state;
    state.packing = free_grains(std::move(radius), std::move(centres));
    state.packing.fixed = {1, 1, 0};
    state.contacts = {{disk_disk, 0, 2}, {disk_disk, 1, 2}};
    return state;
}

} // namespace without_walls
