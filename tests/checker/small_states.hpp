#pragma once
// Small states beyond those of the box with two movable walls, each an isostatic equilibrium; the sweep for the
// smallest gap against brute force over all pairs.

#include "checker/vertex.hpp"
#include "oracle/truth.hpp"
#include "support/crafted.hpp"

namespace small_states {

using isostat::State;
using isostat::WallKind;

/// Three disks under the load and a fourth, small one that only rests in the corner: its two forces are structural
/// zeros.
inline State with_a_rattler() {
    State state = crafted::three_disks(1, 1.1, 1.3, 1, 1.5);
    const std::vector<double> lengths(state.packing.q.end() - 2, state.packing.q.end());
    state.packing.q.resize(state.packing.q.size() - 2);
    state.packing.radius.push_back(0.1);
    for (const double x : {0.1, 0.1, lengths[0], lengths[1]}) {
        state.packing.q.push_back(x);
    }
    state.contacts.push_back(crafted::left(3));
    state.contacts.push_back(crafted::bottom(3));
    state.load.infinitesimal = {0.1, -1, 0.2, -1.2, 0.15, -1.7, -0.3, -0.7};
    isostat::snap_to_grid(state.packing);
    return state;
}

/// The first of the three disks cannot move, and has no contacts with the walls.
inline State with_a_fixed_disk() {
    State state = crafted::three_disks(1, 1.1, 1.3, 1, 1.5);
    state.packing.fixed = {1, 0, 0};
    std::erase(state.contacts, crafted::left(0));
    std::erase(state.contacts, crafted::bottom(0));
    return state;
}

/// Two disks in a corner without upper walls, under forces on the disks.
inline State in_a_corner() {
    State state = crafted::in_box({{1, 1, 1}, {0.5, 0.5, 1 + std::sqrt(2.0)}}, 0, 0, 1, 1,
                                  {crafted::left(0), crafted::bottom(0), crafted::left(1), crafted::pair(0, 1)});
    state.packing.walls.upper = {WallKind::absent, WallKind::absent};
    state.load.disk_force = {-1, -0.5, 0, -1};
    return state;
}

/// A disk between two fixed ones, its centre above their line by `height`, no walls. At height 0 the two normals are
/// parallel: rank 1.
inline State between_two(double height) {
    State state =
        crafted::in_box({{1, 0, 0}, {1, 4, 0}, {1, 2, 0}}, 0, 0, 1, 1, {crafted::pair(0, 2), crafted::pair(1, 2)});
    state.packing.q[5] = height;
    state.packing.walls = isostat::Walls::none();
    state.packing.fixed = {1, 1, 0};
    return state;
}

/// The gaps that the sweep lists are those of the stored coordinates, the smallest of `pairs` among them.
inline void lists_the_smallest_gap(const isostat::State& state, const std::vector<isostat::Contact>& pairs) {
    using namespace isostat::checker;
    const Problem problem(state);
    TrueVertex vertex;
    vertex.middle = problem.stored;
    vertex.radius = 0;
    const isostat::oracle::TruthIn<long double> at(state, isostat::oracle::At::stored);
    const auto gap_of = [&at](const isostat::Contact& pair) { return static_cast<double>(at.gap(pair)); };
    double smallest = std::numeric_limits<double>::infinity();
    for (const isostat::Contact& pair : pairs) {
        smallest = is_free_pair(state, pair) ? std::min(smallest, gap_of(pair)) : smallest;
    }
    double found = std::numeric_limits<double>::infinity();
    for (const Gap& gap : smallest_gaps(problem, state, vertex)) {
        BOOST_REQUIRE(gap.pair.i >= 0);
        BOOST_TEST(is_free_pair(state, gap.pair));
        BOOST_TEST(std::abs(gap.value.lower.get_d() - gap_of(gap.pair)) < 1e-12);
        found = std::min(found, gap.value.lower.get_d());
    }
    BOOST_TEST((found == smallest || std::abs(found - smallest) < 1e-12), found << ", not " << smallest);
}

} // namespace small_states
