#pragma once
// States in periodic cells that lie at the thresholds of the program's decisions.

#include "contradictions/cells.hpp"

namespace contradictions::detail {

inline double ulps(double x, int count) {
    for (int k = 0; k < std::abs(count); ++k) {
        x = std::nextafter(x, count > 0 ? HUGE_VAL : -HUGE_VAL);
    }
    return x;
}
inline int few(Random& random) {
    return random.integer(7) - 3;
}
inline double a_few_ulps_from(double x, Random& random) {
    return ulps(x, few(random));
}

/// From 1 to 2, up to ten times as large, equal, or equal but for little.
inline std::vector<double> cell_radii(int disks, Random& random) {
    const int law = random.integer(5);
    const double spread = law < 2 ? 1 : law == 2 ? 9 : law == 3 ? std::ldexp(1.0, -4 - random.integer(46)) : 0;
    std::vector<double> radii;
    for (int i = 0; i < disks; ++i) {
        radii.push_back(0.5 * (1 + spread * random.real()));
    }
    return radii;
}

inline void draw_infinitesimal(State& state, Random& random) {
    state.load.infinitesimal.clear();
    for (std::size_t k = 0; k < state.packing.axes() * state.packing.radius.size(); ++k) {
        state.load.infinitesimal.push_back(random.integer(8) == 0 ? 0.0 : random.real(-1, 0.3));
    }
    isostat::balance(state.load.infinitesimal, state.packing.cell);
}

/// One more grain, in a void: it rests on two others, a sphere on three, or on their images. \pre state at its vertex
inline bool add_rattler(State& state, Random& random) {
    const State before = state;
    const auto& p = before.packing;
    const std::size_t axes = p.axes();
    const int count = p.disk_count();
    for (int tries = 0; tries < 60; ++tries) {
        const double r = p.min_radius() * random.real(0.1, 0.6);
        Pile below; // what carries it
        std::vector<Contact> contacts;
        for (std::size_t side = 0; side < axes; ++side) {
            const auto i = static_cast<std::size_t>(random.integer(count));
            isostat::Image m;
            for (std::size_t a = 0; a < axes; ++a) {
                m.m[a] = side > 0 && p.cell.periodic[a] ? static_cast<std::int8_t>(random.integer(3) - 1) : 0;
            }
            Place at{};
            for (std::size_t a = 0; a < axes; ++a) {
                at[a] = p.q[axes * i + a];
                for (std::size_t b = a; b < axes; ++b) {
                    at[a] += m.m[b] == 0 ? 0 : m.m[b] * p.lattice(a, b);
                }
            }
            below.radius.push_back(p.radius[i]);
            below.at.push_back(at);
            contacts.push_back(isostat::pair_of(count, static_cast<int>(i), m));
        }
        bool near = true;
        for (std::size_t k = 1; k < axes; ++k) {
            const bool again = std::find(contacts.begin(), contacts.begin() + static_cast<long>(k), contacts[k]) !=
                               contacts.begin() + static_cast<long>(k);
            near = near && !again && gap(below, 0, below.at[k], below.radius[k]) <= 2 * r;
        }
        if (!near) {
            continue;
        }
        const auto beside = [&](std::size_t a) { return below.at[0][a] + random.real(-1, 1) * (below.radius[0] + r); };
        const auto place = axes == 2 ? resting_place(below, 0, 1, r, random.integer(2) == 0 ? -1 : 1)
                                     : resting_place(below, {0, 1, 2}, r, {beside(0), beside(1), beside(2)});
        if (!place) {
            continue;
        }
        state = before;
        state.packing.radius.push_back(r);
        std::vector<double> at;
        for (std::size_t a = 0; a < axes; ++a) {
            at.push_back(static_cast<double>((*place)[a]));
        }
        state.packing.q.insert(state.packing.q.begin() + static_cast<long>(axes) * count, at.begin(), at.end());
        state.contacts.insert(state.contacts.end(), contacts.begin(), contacts.end());
        std::ranges::sort(state.contacts);
        state.load.infinitesimal.insert(state.load.infinitesimal.end(), axes, 0);
        const Truth truth(state);
        if (truth.known && (truth.others.empty() || truth.others.front().gap > 0)) {
            return true;
        }
    }
    state = before;
    return false;
}

/// The shear at which the force of one contact vanishes, or a few ulps beside it.
inline void shear_to_the_end(State& state, const Truth& truth, Random& random) {
    const auto tilt = static_cast<std::size_t>(random.integer(state.packing.dimension == 2 ? 1 : 3));
    State sheared = state;
    sheared.load.shear[tilt] += 1;
    const Truth other(sheared);
    const auto l = static_cast<std::size_t>(random.integer(static_cast<int>(state.contacts.size())));
    const Real rate = other.force[l] - truth.force[l];
    if (abs(rate) > Real(1e-3)) {
        const Real at = Real(state.load.shear[tilt]) - truth.force[l] / rate;
        state.load.shear[tilt] = a_few_ulps_from(static_cast<double>(at), random);
    }
}

inline void stress_to_the_end(State& state, const Truth& truth, Random& random) {
    const End& end = random.integer(2) == 0 ? truth.low : truth.high;
    if (!end.unbounded && abs(end.stress) > 1e-30) {
        state.load.set_loaded_stress(a_few_ulps_from(static_cast<double>(end.stress), random));
    }
}

inline CellOptions cell_options(CellKind kind, int disks, Random& random) {
    CellOptions options{.kind = kind, .radii = cell_radii(disks, random)};
    if (random.integer(3) != 0) {
        options.force = {random.real(0.5, 2), random.real(0.5, 2)};
    }
    options.shear_force = kind == CellKind::tilted && random.integer(2) == 0 ? random.real(-0.3, 0.3) : 0;
    return options;
}

/// A packing, perhaps with a rattler, described by whatever pin and representatives.
inline std::optional<State> in_small_cell(const CellOptions& options, Random& random) {
    auto state = make_cell(options, random);
    if (!state) {
        return {};
    }
    describe_otherwise(*state, random);
    if (!polish(*state)) {
        return {};
    }
    if (random.integer(3) == 0) {
        add_rattler(*state, random);
    }
    if (random.integer(3) != 0) {
        isostat::snap_to_grid(state->packing); // a run asks for that
    }
    draw_infinitesimal(*state, random);
    return state;
}

/// Of one to six disks.
inline std::optional<State> in_small_cell(CellKind kind, Random& random) {
    const CellOptions options = cell_options(kind, 1 + random.integer(5), random);
    return in_small_cell(options, random);
}

/// The length along x does not move; as often as not it is such that the images of the largest disk touch.
inline std::optional<State> in_cell_of_fixed_length(Random& random) {
    CellOptions options = cell_options(CellKind::tilted, 1 + random.integer(4), random);
    const double widest = 2 * *std::ranges::max_element(options.radii);
    options.fixed_length = random.integer(2) == 0 ? widest : widest * random.real(1, 2);
    return in_small_cell(options, random);
}

/// Moved to a threshold, or near it.
inline std::optional<State> at_threshold(std::optional<State> state, Random& random) {
    if (!state) {
        return {};
    }
    const Truth truth(*state);
    if (!truth.known) {
        return {};
    }
    const int axes = state->packing.dimension;
    switch (random.integer(6)) {
    case 0: stress_to_the_end(*state, truth, random); break;
    case 1:
        if (state->packing.cell.tilt_moves[0]) {
            shear_to_the_end(*state, truth, random);
        }
        break;
    case 2:
        for (double& x : state->packing.q) {
            x = x == 0 ? 0 : a_few_ulps_from(x, random);
        }
        break;
    case 3: state->load.stress[static_cast<std::size_t>(random.integer(axes))] = 0; break;
    case 4:
        for (int a = 0; a < axes; ++a) {
            state->load.reference_length[static_cast<std::size_t>(a)] = random.real(0.5, 3);
        }
        stress_to_the_end(*state, Truth(*state), random);
        break;
    default: break;
    }
    return state;
}

inline std::optional<State> cell_at_threshold(CellKind kind, Random& random) {
    return at_threshold(in_small_cell(kind, random), random);
}

/// Forty packings of two to six spheres in cells of a kind: to prepare one for each state would take most of the time.
inline const std::vector<State>& prepared_spheres(isostat::PreparedCell kind) {
    static std::map<isostat::PreparedCell, std::vector<State>> made;
    std::vector<State>& all = made[kind];
    for (std::uint64_t seed = 1; all.size() < 40; ++seed) {
        Random random(seed);
        isostat::PreparationOptions options{.dimension = 3, .radii = cell_radii(2 + random.integer(5), random)};
        options.cell = kind;
        options.seed = seed;
        try {
            if (const auto prepared = prepared_or_none(options)) {
                all.push_back(*prepared);
            }
        } catch (const isostat::Error&) { // too narrow for the largest
        }
    }
    return all;
}

/// One of them, described otherwise; one in two has a rattler, and every other one of these is pinned.
inline std::optional<State> spheres_at_threshold(isostat::PreparedCell kind, Random& random) {
    State state = prepared_spheres(kind)[static_cast<std::size_t>(random.integer(40))];
    describe_otherwise(state, random);
    if (!polish(state)) {
        return {};
    }
    if (random.integer(2) == 0 && add_rattler(state, random) && random.integer(2) == 0) {
        state.packing.cell.pin = state.packing.disk_count() - 1;
    }
    if (random.integer(3) != 0) {
        isostat::snap_to_grid(state.packing); // a run asks for that
    }
    draw_infinitesimal(state, random);
    return at_threshold(std::move(state), random);
}

/// Cells whose doubles touch exactly, so that crafted inspection speaks of them: one disk in a rectangle, in a channel,
/// in a tilted cell; two disks that also touch through their images. `fixed`: the length along x does not move.
inline std::optional<State> exact_cell(Random& random, bool fixed = false) {
    State state;
    auto& p = state.packing;
    p.walls = isostat::Walls::none();
    const auto own = [&](int i, int x, int y) { return isostat::pair_of(i, i, {{std::int8_t(x), std::int8_t(y), 0}}); };
    const auto both = [&](int x, int y) { return isostat::pair_of(0, 1, {{std::int8_t(x), std::int8_t(y), 0}}); };
    switch (fixed ? 2 * random.integer(2) : random.integer(4)) {
    case 0: // one disk, all of its images in a row along x and along y
        p.radius = {2};
        p.q = {0.5, -1, 4, 4, 0};
        p.cell = {{true, true}, {true, true}, {false}, 0};
        state.contacts = {own(0, 0, 1), own(0, 1, 0)};
        if (fixed) { // they touch, but cannot move apart
            p.cell.period_moves[0] = false;
            state.contacts.pop_back();
        }
        break;
    case 1: // one disk and its images between walls
        p.radius = {2};
        p.q = {0.5, 2, 4, 4, 0};
        p.cell = {{true, false}, {true, false}, {false}, 0};
        p.walls.lower[1] = WallKind::fixed;
        p.walls.upper[1] = WallKind::movable;
        state.contacts = {own(0, 1, 0), {ContactKind::lower_wall, 0, 1}, {ContactKind::upper_wall, 0, 1}};
        break;
    case 2: // A7: (3, 4) from one disk to four images of the other, and to its own image
        p.radius = {3, 2};
        p.q = {0, 0, 3, 4, 6, 8, 0};
        p.cell = {{true, true}, {true, true}, {true}, random.integer(2)};
        state.contacts = {both(-1, -1), both(-1, 0), both(0, -1), both(0, 0), own(0, 1, 0)};
        if (fixed) {
            p.cell.period_moves[0] = false;
            state.contacts.pop_back();
        }
        break;
    default: // A8, state B: the large disk and its images at the bottom, the small one in a gap of them
        p.radius = {3, 2};
        p.q = {0, 3, 3, 7, 6, 9, 0};
        p.cell = {{true, false}, {true, false}, {false}, random.integer(2)};
        p.walls.lower[1] = WallKind::fixed;
        p.walls.upper[1] = WallKind::movable;
        state.contacts = {
            both(-1, 0), both(0, 0), own(0, 1, 0), {ContactKind::lower_wall, 0, 1}, {ContactKind::upper_wall, 1, 1}};
    }
    std::ranges::sort(state.contacts);
    state.load.reference_length = {1.0 + random.integer(3), 1.0 + random.integer(3)};
    state.load.stress = {static_cast<double>(random.integer(6)), static_cast<double>(random.integer(6))};
    state.load.shear = {p.cell.tilt_moves[0] ? random.integer(7) - 3.0 : 0.0};
    draw_infinitesimal(state, random);
    return state;
}

} // namespace contradictions::detail
