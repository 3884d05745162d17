#pragma once
// Isostatic structures by construction: every disk rests on two earlier things, the upper walls on the outermost disk.
// Loads are made from the forces that one wants.

#include "contradictions/exact.hpp"
#include "oracle/random.hpp"
#include "support/test.hpp"

namespace contradictions {

using isostat::oracle::Random;

struct PileOptions {
    int disks = 3;           ///< that can move
    int fixed = 0;           ///< disks that cannot, at random places
    bool upper_walls = true; ///< movable, on the outermost disks; else absent
    bool lower_walls = true; ///< fixed; else absent (then `fixed` >= 2)
    double smallest = 0.5;   ///< radii from here to `largest`
    double largest = 1;
    double same = 0; ///< probability that a radius repeats an earlier one (or one ulp beside it)
};

/// Coordinates in long double until `Pile::state` rounds them.
struct Pile {
    std::vector<double> radius;
    std::vector<std::array<long double, 2>> at;
    std::vector<unsigned char> fixed;
    std::vector<Contact> contacts;
};

namespace detail {

inline long double gap(const Pile& pile, std::size_t i, long double x, long double y, double r) {
    return std::hypot(pile.at[i][0] - x, pile.at[i][1] - y) - pile.radius[i] - r;
}

/// Room for a disk of radius r at (x, y), apart from the disks a and b that it rests on.
inline bool is_free(const Pile& pile, const PileOptions& options, long double x, long double y, double r) {
    const long double slack = 1e-9L;
    if (options.lower_walls && (x < r - slack || y < r - slack)) {
        return false;
    }
    for (std::size_t i = 0; i < pile.radius.size(); ++i) {
        if (gap(pile, i, x, y, r) < -slack) {
            return false;
        }
    }
    return true;
}

/// Things to rest on: -1 left wall, -2 bottom wall, i a disk.
inline Contact touches(int thing, int disk) {
    return thing < 0 ? Contact{ContactKind::lower_wall, disk, -1 - thing}
                     : Contact{ContactKind::disk_disk, std::min(thing, disk), std::max(thing, disk)};
}

/// Where a disk of radius r touches both things; `side` chooses one of two places.
inline std::optional<std::array<long double, 2>> resting_place(const Pile& pile, int a, int b, double r, int side) {
    if (a < 0 && b < 0) {
        return std::array<long double, 2>{r, r};
    }
    if (a < 0) {
        std::swap(a, b);
    }
    const auto& p = pile.at[static_cast<std::size_t>(a)];
    const long double reach = static_cast<long double>(pile.radius[static_cast<std::size_t>(a)]) + r;
    if (b < 0) {
        const std::size_t axis = b == -1 ? 0 : 1;
        const long double across = r - p[axis];
        if (std::abs(across) >= reach) {
            return {};
        }
        std::array<long double, 2> place{};
        place[axis] = r;
        place[1 - axis] = p[1 - axis] + (side > 0 ? 1 : -1) * std::sqrt(reach * reach - across * across);
        return place;
    }
    const auto& o = pile.at[static_cast<std::size_t>(b)];
    const long double other = static_cast<long double>(pile.radius[static_cast<std::size_t>(b)]) + r;
    const long double dx = o[0] - p[0];
    const long double dy = o[1] - p[1];
    const long double d = std::hypot(dx, dy);
    const long double along = (reach * reach - other * other + d * d) / (2 * d);
    const long double square = reach * reach - along * along;
    if (square <= 0.01L * reach * reach) {
        return {}; // too far, or nearly straight
    }
    const long double across = (side > 0 ? 1 : -1) * std::sqrt(square);
    return std::array<long double, 2>{p[0] + (along * dx - across * dy) / d, p[1] + (along * dy + across * dx) / d};
}

} // namespace detail

/// A radius for the next disk.
inline double draw_radius(const Pile& pile, const PileOptions& options, Random& random) {
    if (!pile.radius.empty() && random.real() < options.same) {
        const double old = pile.radius[static_cast<std::size_t>(random.integer(static_cast<int>(pile.radius.size())))];
        const int how = random.integer(4);
        return how == 0   ? std::nextafter(old, 9.0)
               : how == 1 ? std::nextafter(old, 0.0)
               : how == 2 ? old * (1 + std::ldexp(random.real(-1, 1), -10 - random.integer(40)))
                          : old;
    }
    return random.real(options.smallest, options.largest);
}

inline std::optional<Pile> make_pile(const PileOptions& options, Random& random) {
    Pile pile;
    for (int i = 0, tries = 0; i < options.fixed && tries < 100; ++tries) {
        const double r = draw_radius(pile, options, random);
        const double x = random.real(r + 0.1, 3.5);
        const double y = random.real(r + 0.1, 2.0);
        if (detail::is_free(pile, options, x, y, r)) {
            pile.radius.push_back(r);
            pile.at.push_back({x, y});
            pile.fixed.push_back(1);
            ++i;
        }
    }
    const int lowest = options.lower_walls ? -2 : 0;
    int placed = 0;
    for (int tries = 0; placed < options.disks && tries < 300; ++tries) {
        const int count = static_cast<int>(pile.radius.size());
        if (count - lowest < 2) {
            return {};
        }
        const int a = lowest + random.integer(count - lowest);
        const int b = lowest + random.integer(count - lowest);
        const double r = draw_radius(pile, options, random);
        if (a == b) {
            continue;
        }
        const auto place = detail::resting_place(pile, a, b, r, random.integer(2) == 0 ? -1 : 1);
        if (!place || !detail::is_free(pile, options, (*place)[0], (*place)[1], r)) {
            continue;
        }
        pile.radius.push_back(r);
        pile.at.push_back(*place);
        pile.fixed.push_back(0);
        pile.contacts.push_back(detail::touches(a, count));
        pile.contacts.push_back(detail::touches(b, count));
        ++placed;
    }
    return placed == options.disks ? std::optional(pile) : std::nullopt;
}

/// Walls around the pile, coordinates rounded; no load yet.
inline State state_of(const Pile& pile, const PileOptions& options) {
    State state;
    auto& packing = state.packing;
    packing.radius = pile.radius;
    for (const auto& p : pile.at) {
        packing.q.push_back(static_cast<double>(p[0]));
        packing.q.push_back(static_cast<double>(p[1]));
    }
    if (options.fixed > 0) {
        packing.fixed = pile.fixed;
    }
    state.contacts = pile.contacts;
    packing.walls = options.lower_walls ? isostat::Walls::box() : isostat::Walls::none();
    packing.walls.upper.fill(options.upper_walls ? WallKind::movable : WallKind::absent);
    for (std::size_t axis = 0; axis < 2; ++axis) {
        std::size_t outermost = 0;
        const auto reach = [&](std::size_t i) { return pile.at[i][axis] + pile.radius[i]; };
        for (std::size_t i = 1; i < pile.radius.size(); ++i) {
            outermost = reach(i) > reach(outermost) ? i : outermost;
        }
        packing.q.push_back(static_cast<double>(reach(outermost)));
        if (options.upper_walls) {
            state.contacts.push_back({ContactKind::upper_wall, static_cast<int>(outermost), static_cast<int>(axis)});
        }
    }
    state.load.stress = {1, 1};
    state.load.reference_length = {1, 1};
    state.load.infinitesimal.assign(2 * pile.radius.size(), 0.0);
    return state;
}

/// Coordinates put on the true vertex, rounded to nearest. False: there is none nearby.
inline bool polish(State& state) {
    const Truth truth(state);
    if (!truth.known) {
        return false;
    }
    for (std::size_t k = 0; k < truth.q.size(); ++k) {
        state.packing.q[k] = static_cast<double>(truth.q[k]);
    }
    return true;
}

/// The finite load that gives (almost: it is rounded) these forces at the true vertex: wall stresses for the reference
/// lengths of the state, the rest as forces on the disks. `only_walls`: no force on a disk is written.
inline void load_for(State& state, const Truth& truth, const std::vector<double>& forces) {
    const std::size_t n = state.packing.radius.size();
    Vector external(2 * n + 2, Real(0));
    const auto add = [&](std::size_t coordinate, const Real& value) { external[coordinate] += value; };
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& c = state.contacts[l];
        const auto i = static_cast<std::size_t>(c.i);
        const auto j = static_cast<std::size_t>(c.j);
        const Real f = forces[l];
        switch (c.kind) {
        case ContactKind::disk_disk: {
            const Real dx = truth.q[2 * j] - truth.q[2 * i];
            const Real dy = truth.q[2 * j + 1] - truth.q[2 * i + 1];
            const Real d = sqrt(dx * dx + dy * dy);
            add(2 * i, f * dx / d);
            add(2 * i + 1, f * dy / d);
            add(2 * j, -f * dx / d);
            add(2 * j + 1, -f * dy / d);
            break;
        }
        case ContactKind::lower_wall: add(2 * i + j, -f); break;
        case ContactKind::upper_wall:
            add(2 * i + j, f);
            add(2 * n + j, -f);
            break;
        case ContactKind::held: add(i, -f); break;
        }
    }
    state.load.disk_force.assign(2 * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        if (state.packing.fixed.empty() || state.packing.fixed[i] == 0) {
            state.load.disk_force[2 * i] = static_cast<double>(external[2 * i]);
            state.load.disk_force[2 * i + 1] = static_cast<double>(external[2 * i + 1]);
        }
    }
    for (std::size_t a = 0; a < 2; ++a) {
        if (state.packing.walls.upper[a] == WallKind::movable) {
            const Real length = state.load.kind == isostat::LoadKind::nominal ? Real(state.load.reference_length[1 - a])
                                                                              : truth.q[2 * n + 1 - a];
            state.load.stress[a] = static_cast<double>(Real(-external[2 * n + a] / length));
        }
    }
}

} // namespace contradictions
