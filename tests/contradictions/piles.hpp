#pragma once
// Isostatic structures by construction: every disk rests on two earlier things, a sphere on three, the upper walls on
// the outermost grain.
// Loads are made from the forces that one wants.

#include "contradictions/exact.hpp"
#include "oracle/random.hpp"
#include "support/test.hpp"

namespace contradictions {

using isostat::oracle::Random;

struct PileOptions {
    int disks = 3; ///< that can move
    int dimension = 2;
    int fixed = 0;           ///< disks that cannot, at random places
    bool upper_walls = true; ///< movable, on the outermost disks; else absent
    bool lower_walls = true; ///< fixed; else absent (then `fixed` >= 2)
    double smallest = 0.5;   ///< radii from here to `largest`
    double largest = 1;
    double same = 0; ///< probability that a radius repeats an earlier one (or one ulp beside it)
};

using Place = std::array<long double, 3>;

/// Coordinates in long double until `Pile::state` rounds them.
struct Pile {
    std::vector<double> radius;
    std::vector<Place> at;
    std::vector<unsigned char> fixed;
    std::vector<Contact> contacts;
};

namespace detail {

inline long double gap(const Pile& pile, std::size_t i, const Place& p, double r) {
    return std::hypot(pile.at[i][0] - p[0], pile.at[i][1] - p[1], pile.at[i][2] - p[2]) - pile.radius[i] - r;
}

/// Room for a grain of radius r there, apart from those that it rests on.
inline bool is_free(const Pile& pile, const PileOptions& options, const Place& p, double r) {
    const long double slack = 1e-9L;
    for (int a = 0; options.lower_walls && a < options.dimension; ++a) {
        if (p[static_cast<std::size_t>(a)] < r - slack) {
            return false;
        }
    }
    for (std::size_t i = 0; i < pile.radius.size(); ++i) {
        if (gap(pile, i, p, r) < -slack) {
            return false;
        }
    }
    return true;
}

/// Things to rest on: -1 - a the lower wall of axis a, i a grain.
inline Contact touches(int thing, int disk) {
    return thing < 0 ? Contact{ContactKind::lower_wall, disk, -1 - thing}
                     : Contact{ContactKind::disk_disk, std::min(thing, disk), std::max(thing, disk)};
}

/// Where a disk of radius r touches both things; `side` chooses one of two places.
inline std::optional<Place> resting_place(const Pile& pile, int a, int b, double r, int side) {
    if (a < 0 && b < 0) {
        return Place{r, r};
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
        Place place{};
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
    return Place{p[0] + (along * dx - across * dy) / d, p[1] + (along * dy + across * dx) / d};
}

/// Where a sphere of radius r touches three things, by Newton's method from `place`; their normals are not nearly in
/// one plane.
inline std::optional<Place> resting_place(const Pile& pile, const std::array<int, 3>& things, double r, Place place) {
    Eigen::Matrix<long double, 3, 3> normals;
    Eigen::Matrix<long double, 3, 1> gaps;
    for (int iteration = 0; iteration < 30; ++iteration) {
        for (int k = 0; k < 3; ++k) {
            const int thing = things[static_cast<std::size_t>(k)];
            normals.row(k).setZero();
            if (thing < 0) {
                normals(k, -1 - thing) = 1;
                gaps(k) = place[static_cast<std::size_t>(-1 - thing)] - r;
                continue;
            }
            const auto i = static_cast<std::size_t>(thing);
            gaps(k) = gap(pile, i, place, r);
            const long double d = gaps(k) + pile.radius[i] + r;
            for (std::size_t a = 0; a < 3; ++a) {
                normals(k, static_cast<Eigen::Index>(a)) = (place[a] - pile.at[i][a]) / d;
            }
        }
        if (!(std::abs(normals.determinant()) > 0.05L)) {
            return {};
        }
        if (gaps.cwiseAbs().maxCoeff() < 1e-17L) {
            return place;
        }
        const Eigen::Matrix<long double, 3, 1> step = normals.fullPivLu().solve(gaps);
        for (std::size_t a = 0; a < 3; ++a) {
            place[a] -= step(static_cast<Eigen::Index>(a));
        }
    }
    return {};
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
    const bool space = options.dimension == 3;
    for (int i = 0, tries = 0; i < options.fixed && tries < 100; ++tries) {
        const double r = draw_radius(pile, options, random);
        const double x = random.real(r + 0.1, 3.5);
        const double y = random.real(r + 0.1, 2.0);
        const double z = space ? random.real(r + 0.1, 2.0) : 0;
        if (detail::is_free(pile, options, {x, y, z}, r)) {
            pile.radius.push_back(r);
            pile.at.push_back({x, y, z});
            pile.fixed.push_back(1);
            ++i;
        }
    }
    const int lowest = options.lower_walls ? -options.dimension : 0;
    int placed = 0;
    for (int tries = 0; placed < options.disks && tries < 300; ++tries) {
        const int count = static_cast<int>(pile.radius.size());
        if (count - lowest < options.dimension) {
            return {};
        }
        const int a = lowest + random.integer(count - lowest);
        const int b = lowest + random.integer(count - lowest);
        const int c = space ? lowest + random.integer(count - lowest) : count;
        const double r = draw_radius(pile, options, random);
        if (a == b || b == c || c == a) {
            continue;
        }
        const auto place =
            space ? detail::resting_place(pile, {a, b, c}, r, {random.real(0, 3), random.real(0, 3), random.real(0, 3)})
                  : detail::resting_place(pile, a, b, r, random.integer(2) == 0 ? -1 : 1);
        if (!place || !detail::is_free(pile, options, *place, r)) {
            continue;
        }
        pile.radius.push_back(r);
        pile.at.push_back(*place);
        pile.fixed.push_back(0);
        for (const int thing : {a, b, c}) {
            if (thing != count) {
                pile.contacts.push_back(detail::touches(thing, count));
            }
        }
        ++placed;
    }
    return placed == options.disks ? std::optional(pile) : std::nullopt;
}

/// Walls around the pile, coordinates rounded; no load yet.
inline State state_of(const Pile& pile, const PileOptions& options) {
    State state;
    auto& packing = state.packing;
    const auto axes = static_cast<std::size_t>(options.dimension);
    packing.dimension = packing.cell.dimension = options.dimension;
    packing.radius = pile.radius;
    for (const Place& p : pile.at) {
        for (std::size_t a = 0; a < axes; ++a) {
            packing.q.push_back(static_cast<double>(p[a]));
        }
    }
    if (options.fixed > 0) {
        packing.fixed = pile.fixed;
    }
    state.contacts = pile.contacts;
    packing.walls = options.lower_walls ? isostat::Walls::box(options.dimension) : isostat::Walls::none();
    for (std::size_t axis = 0; axis < axes; ++axis) {
        packing.walls.upper[axis] = options.upper_walls ? WallKind::movable : WallKind::absent;
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
    for (std::size_t axis = 0; axis < axes; ++axis) {
        state.load.stress[axis] = state.load.reference_length[axis] = 1;
    }
    state.load.dimension = options.dimension;
    state.load.loaded_axis = options.dimension - 1;
    state.load.infinitesimal.assign(axes * pile.radius.size(), 0.0);
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
    const auto axes = static_cast<std::size_t>(state.packing.dimension);
    Vector external(axes * (n + 1), Real(0));
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& c = state.contacts[l];
        const auto i = static_cast<std::size_t>(c.i);
        const auto j = static_cast<std::size_t>(c.j);
        const Real f = forces[l];
        switch (c.kind) {
        case ContactKind::disk_disk:
        case ContactKind::bar: {
            const auto r = truth.between(c);
            const Real d = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
            for (std::size_t a = 0; a < axes; ++a) {
                external[axes * i + a] += f * r[a] / d;
                external[axes * j + a] += -f * r[a] / d;
            }
            break;
        }
        case ContactKind::lower_wall: external[axes * i + j] -= f; break;
        case ContactKind::upper_wall:
            external[axes * i + j] += f;
            external[axes * n + j] -= f;
            break;
        case ContactKind::held: external[i] -= f; break;
        }
    }
    state.load.disk_force.assign(axes * n, 0.0);
    for (std::size_t k = 0; k < axes * n; ++k) {
        if (state.packing.fixed.empty() || state.packing.fixed[k / axes] == 0) {
            state.load.disk_force[k] = static_cast<double>(external[k]);
        }
    }
    for (std::size_t a = 0; a < axes; ++a) {
        if (state.packing.walls.upper[a] != WallKind::movable) {
            continue;
        }
        Real size = 1; // of the wall
        for (std::size_t b = 0; b < axes; ++b) {
            size *= a == b                                          ? Real(1)
                    : state.load.kind == isostat::LoadKind::nominal ? Real(state.load.reference_length[b])
                                                                    : truth.q[axes * n + b];
        }
        state.load.stress[a] = static_cast<double>(Real(-external[axes * n + a] / size));
    }
}

} // namespace contradictions
