#pragma once
// Periodic packings with genuine ties: a packing in a box and its mirror images at two opposite walls; lattices.

#include "support/cells.hpp"

namespace cells {

/// A packing with walls along `axis`, and its image in the lower one: the period is twice the length, a contact with a
/// wall is one of a disk with its mirror image. Disk n + i is the image of disk i of n. Where the walls have b contacts
/// there are b - 3 fewer contacts than degrees of freedom, as many if b = 3 (along a second axis 4).
inline State unfolded(const State& half, std::size_t axis) {
    State state = half;
    isostat::Packing& packing = state.packing;
    const std::size_t n = half.packing.radius.size();
    packing.radius.insert(packing.radius.end(), half.packing.radius.begin(), half.packing.radius.end());
    const std::vector<double>& q = half.packing.q;
    std::vector<double> images(q.begin(), q.begin() + static_cast<std::ptrdiff_t>(2 * n));
    for (std::size_t i = 0; i < n; ++i) {
        images[2 * i + axis] = -images[2 * i + axis];
    }
    packing.q.insert(packing.q.begin() + static_cast<std::ptrdiff_t>(2 * n), images.begin(), images.end());
    packing.q[4 * n + axis] *= 2;
    if (!packing.cell.any()) {
        packing.q.push_back(0); // the tilt
    }
    packing.cell.periodic[axis] = packing.cell.period_moves[axis] = true;
    packing.walls.lower[axis] = packing.walls.upper[axis] = isostat::WallKind::absent;
    state.contacts.clear();
    for (const Contact& c : half.contacts) {
        const int other = static_cast<int>(n);
        if (c.kind == isostat::ContactKind::disk_disk) {
            Image mirrored = c.image;
            mirrored.m[axis] = static_cast<std::int8_t>(-mirrored.m[axis]);
            state.contacts.push_back(c);
            state.contacts.push_back(isostat::pair_of(c.i + other, c.j + other, mirrored));
        } else if (c.j == static_cast<int>(axis)) {
            const bool upper = c.kind == isostat::ContactKind::upper_wall;
            Image beyond;
            beyond.m[axis] = upper ? 1 : 0;
            state.contacts.push_back(isostat::pair_of(c.i, c.i + other, beyond));
        } else {
            state.contacts.push_back(c);
            state.contacts.emplace_back(c.kind, c.i + other, c.j);
        }
    }
    std::vector<double>& small = state.load.infinitesimal;
    small = isostat::generic_infinitesimal(packing.radius, 7);
    balance(small, packing.cell);
    state.load.reference_length = {packing.q[4 * n], packing.q[4 * n + 1]};
    snap_to_grid(packing);
    return state;
}

/// Disks 0 to 2 and their mirror images 3 to 5 between walls along x, some stored a period away along y. N = N_f = 13;
/// all events but those on the mirror come in pairs.
inline State mirror_pairs() {
    State state =
        with_other_representatives(unfolded(::crafted::three_disks(1, 1.1, 1.5, 1, 1), 1),
                                   {image(0, 0), image(0, -1), image(0, 1), image(0, 0), image(0, 0), image(0, 1)});
    snap_to_grid(state.packing);
    return state;
}

/// A triangular lattice under forces of 1, with all its contacts.
inline State loaded_lattice(int columns, int double_rows, bool tilts) {
    return with_infinitesimal_loads(triangular_lattice(columns, double_rows, tilts));
}

} // namespace cells
