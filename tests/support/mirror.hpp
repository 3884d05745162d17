#pragma once
// Small packings with genuine ties: mirror images, and lattices of equal disks.

#include "support/crafted.hpp"

namespace crafted {

/// The same rho for all disks: nothing of first order in the radii tells mirror images apart.
inline State alike(State state) {
    state.perturbation.emplace().rho.assign(state.packing.radius.size(), 0.5);
    return state;
}

/// Two disks of radius 3 on a fixed one of radius 2, pushed together by 12, under the top wall; weights 1. Loading
/// parts them at sigma2 = 1.5, and they reach the bottom together: a tie of two gaps. Unloaded, both lose the top wall
/// together at sigma2 = 0.
inline State mirror_gaps() {
    State state = in_box({{2, 10, 2.5}, {3, 7, 6.5}, {3, 13, 6.5}}, 20, 9.5, 1, 1,
                         {pair(0, 1), pair(0, 2), pair(1, 2), top(1), top(2)});
    state.packing.fixed = {1, 0, 0};
    state.packing.walls.upper[0] = isostat::WallKind::fixed;
    state.load.reference_length = {20, 9.5};
    state.load.disk_force = {0, 0, 12, -1, -12, -1};
    state.load.infinitesimal[0] = state.load.infinitesimal[1] = 0;
    return state;
}

/// A disk of radius 2 between two of radius 3 at fixed side walls, under the top wall; the two are lifted by 3.5 each.
/// Unloading, both leave the bottom at sigma2 = 0.5: a tie of two forces. Afterwards one of them stands at force 0.
inline State mirror_forces() {
    State state = in_box({{2, 7, 6}, {3, 3, 3}, {3, 11, 3}}, 14, 8, 1, 1,
                         {pair(0, 1), pair(0, 2), left(1), bottom(1), right(2), bottom(2), top(0)});
    state.packing.walls.upper[0] = isostat::WallKind::fixed;
    state.load.reference_length = {14, 8};
    state.load.disk_force = {0, 0, 0, 3.5, 0, 3.5};
    return state;
}

/// Two equal disks side by side in the box: h = 1, the top wall rests on both.
inline State equal_pair() {
    State state = in_box({{1, 1, 1}, {1, 3, 1}}, 4, 2, 1, 1,
                         {left(0), pair(0, 1), right(1), bottom(0), bottom(1), top(0), top(1)});
    state.load.reference_length = {4, 2};
    return state;
}

/// A square of four equal disks in the box: opposite forces stay equal at first order, whatever the radii.
inline State square() {
    State state = equal_pair();
    state.packing.radius = {1, 1, 1, 1};
    state.packing.q = {1, 1, 3, 1, 1, 3, 3, 3, 4, 4};
    state.load.infinitesimal = isostat::generic_infinitesimal(state.packing.radius, 7);
    state.load.reference_length = {4, 4};
    state.contacts = {left(0),  bottom(0), bottom(1),  right(1),   left(2),    top(2),
                      right(3), top(3),    pair(0, 1), pair(2, 3), pair(0, 2), pair(1, 3)};
    return state;
}

/// Rows of `columns` and `columns` - 1 equal disks in turn, from the bottom: a triangular lattice between the walls,
/// with all its contacts. h > 0 from three columns on.
inline State triangular(int columns, int rows) {
    std::vector<DiskAt> disks;
    for (int row = 0; row < rows; ++row) {
        const int count = row % 2 == 0 ? columns : columns - 1;
        for (int c = 0; c < count; ++c) {
            disks.push_back({1, 1.0 + row % 2 + 2 * c, 1 + row * std::sqrt(3.0)});
        }
    }
    const double lx = 2 * columns;
    const double ly = 2 + (rows - 1) * std::sqrt(3.0);
    std::vector<Contact> contacts;
    const int n = static_cast<int>(disks.size());
    for (int i = 0; i < n; ++i) {
        const DiskAt& a = disks[static_cast<std::size_t>(i)];
        for (int j = i + 1; j < n; ++j) {
            const DiskAt& b = disks[static_cast<std::size_t>(j)];
            if (std::hypot(a.x - b.x, a.y - b.y) < 2.5) {
                contacts.push_back(pair(i, j));
            }
        }
        const auto near = [](double gap) { return std::abs(gap) < 0.5; };
        if (near(a.x - 1)) {
            contacts.push_back(left(i));
        }
        if (near(lx - a.x - 1)) {
            contacts.push_back(right(i));
        }
        if (near(a.y - 1)) {
            contacts.push_back(bottom(i));
        }
        if (near(ly - a.y - 1)) {
            contacts.push_back(top(i));
        }
    }
    State state = in_box(disks, lx, ly, 1, 1, contacts);
    state.load.reference_length = {lx, ly};
    return state;
}

/// A row of `columns` unit disks on the bottom, disks of radius 3/2 in the gaps between them that touch each other,
/// under the top wall; F1 = 1, F2 = `load`. h = `columns` - 3. With P = F1 / 0.6 the load of the top wall is carried by
/// end contacts of force P and inner contacts of forces 0 <= p <= P, 1.6 (P + sum p) = F2: the row stands for 8/3 <= F2
/// <= 8/3 (columns - 1), and spreads at the upper end until all disks of radius 3/2 reach the bottom at once.
inline State pile(int columns, double load) {
    std::vector<DiskAt> disks;
    std::vector<Contact> contacts{left(0), right(columns - 1)};
    for (int c = 0; c < columns; ++c) {
        disks.push_back({1, 1.0 + 3 * c, 1});
        contacts.push_back(bottom(c));
    }
    for (int c = 0; c + 1 < columns; ++c) {
        const int i = columns + c;
        disks.push_back({1.5, 2.5 + 3 * c, 3});
        contacts.insert(contacts.end(), {pair(c, i), pair(c + 1, i), top(i)});
        if (c > 0) {
            contacts.push_back(pair(i - 1, i));
        }
    }
    return in_box(disks, 3 * columns - 1, 4.5, 1, load, contacts);
}

/// Disks 0 and 1 of radius 2, one above the other, at the crests of fixed disks of radii 1 and 2 to their left, both
/// under the right wall: disk 0 on the bottom and pushed up by 1.5, disk 1 under the top wall, each pushed left by 1.
/// h = 1; F1 = 1. Unloaded from F2 = 2 to 1.5, disk 0 leaves the bottom, and both roll up by s: they fall by s^2 / 6
/// and s^2 / 8. So the right wall stays with disk 1; a list without 1-right lets it overlap at second order, with -1/3
/// + 1/4, and the row of 1-right is 0-right + 0-2 - 1-3. Disk 1 ends at the fixed disk 4.
inline State two_crests(bool disk_0_is_larger) {
    State state = in_box({{2, 7, 2}, {2, 7, 6}, {1, 4, 2}, {2, 3, 6}, {0.3, 4.9, 7.5}}, 9, 8, 1.0 / 8, 2.0 / 9,
                         {bottom(0), pair(0, 1), pair(0, 2), pair(1, 3), right(0), right(1), top(1)});
    state.packing.fixed = {0, 0, 1, 1, 1};
    state.load.reference_length = {9, 8};
    state.load.disk_force = {-1, 1.5, -1, 0, 0, 0, 0, 0, 0, 0};
    for (std::size_t k = 4; k < state.load.infinitesimal.size(); ++k) {
        state.load.infinitesimal[k] = 0;
    }
    // What is larger at first order touches the right wall, and the other one does not.
    state.perturbation.emplace();
    state.perturbation->rho = {disk_0_is_larger ? 0.5 : 0.0, disk_0_is_larger ? 0.0 : 0.5, 0, 0, 0};
    return state;
}

} // namespace crafted
