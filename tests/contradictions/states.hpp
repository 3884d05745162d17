#pragma once
// States that lie at the thresholds of the program's decisions, class by class.

#include "contradictions/cell_states.hpp"
#include "support/free_grains.hpp"

namespace contradictions {

struct StateClass {
    const char* name;
    std::function<std::optional<State>(Random&)> make;
    bool has_equilibria = true;
};

namespace detail {

/// 0, or so small that a rounding decides its sign.
inline double hardly_a_force(Random& random) {
    return random.integer(4) == 0 ? 0.0 : few(random) * std::ldexp(1.0, -50 - random.integer(14));
}

inline void infinitesimal_loads(State& state, Random& random) {
    for (double& g : state.load.infinitesimal) {
        g = random.integer(6) == 0 ? 0.0 : random.real(-1, 0.3);
    }
}

/// A pile at its vertex, with random infinitesimal loads and no finite ones yet.
inline std::optional<State> pile(const PileOptions& options, Random& random) {
    const auto made = make_pile(options, random);
    if (!made) {
        return {};
    }
    State state = state_of(*made, options);
    if (!polish(state)) {
        return {};
    }
    infinitesimal_loads(state, random);
    return state;
}

inline PileOptions small(Random& random, double same = 0, int dimension = 2) {
    return {.disks = 1 + random.integer(dimension == 2 ? 5 : 4), .dimension = dimension, .same = same};
}

/// Loads for forces from 0.1 to 2; `weak` of them hardly different from 0.
inline std::optional<State> load(std::optional<State> state, Random& random, int weak) {
    if (!state) {
        return {};
    }
    for (double& length : state->load.reference_length) {
        length = random.integer(2) == 0 ? 1.0 : random.real(0.5, 3);
    }
    const Truth truth(*state);
    if (!truth.known) {
        return {};
    }
    std::vector<double> forces;
    for (std::size_t l = 0; l < state->contacts.size(); ++l) {
        forces.push_back(random.real(0.1, 2));
    }
    for (int k = 0; k < weak; ++k) {
        forces[static_cast<std::size_t>(random.integer(static_cast<int>(forces.size())))] = hardly_a_force(random);
    }
    load_for(*state, truth, forces);
    return state;
}

/// One disk in the corner; its load on the right wall balances a product of two stored numbers up to a few ulps.
inline std::optional<State> product(Random& random) {
    State state;
    const double r = random.real(0.5, 1.5);
    state.packing.radius = {r};
    state.packing.q = {r, r, 2 * r, 2 * r};
    state.packing.walls = isostat::Walls::box();
    for (int a = 0; a < 2; ++a) {
        state.contacts.push_back({ContactKind::lower_wall, 0, a});
        state.contacts.push_back({ContactKind::upper_wall, 0, a});
    }
    state.load.infinitesimal = {random.real(-1, 1), random.real(-1, 1)};
    for (std::size_t a = 0; a < 2; ++a) {
        state.load.stress[a] = random.real(0.1, 2);
        state.load.reference_length[a] = random.real(0.5, 3);
    }
    const bool nominal = random.integer(3) != 0;
    state.load.kind = nominal ? isostat::LoadKind::nominal : isostat::LoadKind::true_stress;
    state.load.disk_force = {0, 0};
    for (std::size_t a = 0; a < 2; ++a) {
        const double length = nominal ? state.load.reference_length[1 - a] : 2 * r;
        // Force on the lower wall: stress x length - disk force.
        state.load.disk_force[a] = a == 0 || random.integer(2) == 0
                                       ? ulps(state.load.stress[a] * length, random.integer(3) - 1)
                                       : random.real(-1, 0.05);
    }
    return state;
}

/// Coordinates that differ by less than 1e-9 become equal as stored; radii of a wall row differ by a little.
inline std::optional<State> equal_as_stored(Random& random, int dimension = 2) {
    PileOptions options = small(random, 0.8, dimension);
    options.disks = 2 + random.integer(3);
    auto state = load(pile(options, random), random, random.integer(3));
    if (!state) {
        return {};
    }
    auto& q = state->packing.q;
    for (double& x : q) {
        if (random.integer(3) == 0) {
            x += std::ldexp(random.real(-1, 1), -30 - random.integer(20));
        }
    }
    const auto axes = static_cast<std::size_t>(dimension);
    for (std::size_t i = 0; i < axes * state->packing.radius.size(); ++i) {
        for (std::size_t j = i % axes; j < i; j += axes) {
            if (std::abs(q[i] - q[j]) < 1e-3 && random.integer(4) != 0) {
                q[i] = std::abs(q[i] - q[j]) < 1e-9 ? q[j] : q[i];
            }
        }
    }
    return state;
}

/// Fixed disks, some of them overlapping each other or just touching, with or without walls; q of absent walls is
/// anything.
inline std::optional<State> with_fixed(Random& random, bool overlapping) {
    PileOptions options = small(random, 0.3);
    options.disks = 1 + random.integer(3);
    options.fixed = 2 + random.integer(2);
    options.lower_walls = random.integer(2) == 0;
    options.upper_walls = options.lower_walls && random.integer(2) == 0;
    auto state = load(pile(options, random), random, random.integer(2));
    if (!state) {
        return {};
    }
    if (!options.upper_walls) {
        const std::size_t walls = 2 * state->packing.radius.size();
        for (std::size_t a = 0; a < 2; ++a) {
            state->packing.q[walls + a] = random.integer(2) == 0 ? 0 : std::ldexp(1.0, random.integer(60));
        }
    }
    if (overlapping) { // one more fixed disk, at the threshold of an overlap with another fixed one, to the left
        const double r = random.real(0.1, 0.3);
        auto& packing = state->packing;
        const std::size_t n = packing.radius.size();
        const double x = packing.q[0] - (packing.radius[0] + r) + (random.integer(3) == 0 ? 1e-3 : 0.0);
        const std::array<double, 2> at{ulps(x, few(random)), packing.q[1]};
        packing.q.insert(packing.q.begin() + static_cast<std::ptrdiff_t>(2 * n), at.begin(), at.end());
        packing.radius.push_back(r);
        packing.fixed.push_back(1);
        if (!state->load.disk_force.empty()) {
            state->load.disk_force.insert(state->load.disk_force.end(), {0, 0});
        }
        state->load.infinitesimal.insert(state->load.infinitesimal.end(), {0, 0});
    }
    return state;
}

/// A disk between two fixed ones, off the straight line by 1e-1 to 1e-12, loaded across it.
inline std::optional<State> strut(Random& random) {
    const double delta = std::pow(10.0, -random.real(1, 9)) * (random.integer(2) == 0 ? 1 : -1);
    const std::array<double, 3> r{random.real(0.5, 1), random.real(0.5, 1), random.real(0.5, 1)};
    const double left = r[0] + r[2];
    const double right = r[1] + r[2];
    const double c1 = std::sqrt(1 - delta * delta);
    const double s2 = delta * left / right;
    State state = ::without_walls::held_by_two(
        {r[0], r[1], r[2]}, {0, 0, left * c1 + right * std::sqrt(1 - s2 * s2), 0, left * c1, left * delta});
    state.load.infinitesimal = {0, 0, 0, 0, random.real(-1, 1), random.real(-1, 1)};
    state.load.stress = {1, 1};
    state.load.reference_length = {1, 1};
    if (!polish(state)) {
        return {};
    }
    return load(state, random, random.integer(2));
}

/// A sphere on three fixed ones whose normals are 1e-1 to 1e-9 from one plane, loaded across that plane.
inline std::optional<State> nearly_coplanar(Random& random) {
    State state;
    const double height = std::pow(10.0, -random.real(1, 9)) * (random.integer(2) == 0 ? 1 : -1);
    const double r = random.real(0.5, 1);
    state.packing.dimension = state.packing.cell.dimension = 3;
    state.packing.walls = isostat::Walls::none();
    for (int k = 0; k < 3; ++k) {
        const double other = random.real(0.5, 0.8);
        const double angle = 2.0944 * k + random.real(-0.4, 0.4);
        const double flat = std::sqrt((r + other) * (r + other) - height * height);
        state.packing.radius.push_back(other);
        state.packing.fixed.push_back(1);
        state.contacts.push_back({ContactKind::disk_disk, k, 3});
        state.packing.q.insert(state.packing.q.end(), {flat * std::cos(angle), flat * std::sin(angle), 0});
    }
    state.packing.radius.push_back(r);
    state.packing.fixed.push_back(0);
    state.packing.q.insert(state.packing.q.end(), {0, 0, height, 0, 0, 0});
    state.load.infinitesimal.assign(12, 0);
    infinitesimal_loads(state, random);
    state.load.stress = state.load.reference_length = {1, 1, 1};
    state.load.dimension = 3;
    state.load.loaded_axis = 2;
    return polish(state) ? load(state, random, random.integer(2)) : std::nullopt;
}

/// The loaded stress at an end of the supported interval, or a few ulps beside it.
inline std::optional<State> at_the_end(Random& random, int dimension = 2) {
    auto state = load(pile(small(random, 0.2, dimension), random), random, 0);
    if (!state) {
        return {};
    }
    const Truth truth(*state);
    const End& end = random.integer(2) == 0 ? truth.low : truth.high;
    if (!truth.known || end.unbounded || abs(end.stress) < 1e-30) { // the truth has 200 digits, not 300
        return {};
    }
    state->load.set_loaded_stress(ulps(static_cast<double>(end.stress), few(random)));
    return state;
}

/// One more fixed disk that a disk of the pile nearly touches, or overlaps by as little.
inline std::optional<State> nearly_touching(Random& random, int dimension = 2) {
    PileOptions options = small(random, 0.2, dimension);
    options.fixed = 1;
    auto state = load(pile(options, random), random, 0);
    if (!state) {
        return {};
    }
    auto& packing = state->packing;
    const std::size_t n = packing.radius.size();
    const auto i = 1 + static_cast<std::size_t>(random.integer(static_cast<int>(n) - 1));
    const double r = random.real(0.05, 0.2);
    const double angle = random.real(0, 6.28);
    const double gap = random.integer(3) == 0 ? std::ldexp(few(random), -52)
                                              : std::ldexp(random.real(-1, 1), -20 - random.integer(34));
    const double d = packing.radius[i] + r + gap;
    const double height = dimension == 2 ? 0 : random.real(-1, 1); // of the direction
    const double flat = std::sqrt(1 - height * height);
    const std::array<double, 3> normal{flat * std::cos(angle), flat * std::sin(angle), height};
    const auto axes = static_cast<std::size_t>(dimension);
    for (std::size_t a = 0; a < axes; ++a) {
        packing.q.insert(packing.q.begin() + static_cast<std::ptrdiff_t>(axes * n + a),
                         packing.q[axes * i + a] + d * normal[a]);
    }
    packing.radius.push_back(r);
    packing.fixed.push_back(1);
    state->load.disk_force.resize(axes * (n + 1), 0);
    state->load.infinitesimal.resize(axes * (n + 1), 0);
    return state;
}

/// Disks without finite load: the infinitesimal loads decide, some of which are 0 or act along a contact.
inline std::optional<State> infinitesimal_decides(Random& random, int dimension = 2) {
    PileOptions options = small(random, 0.6, dimension);
    auto state = pile(options, random);
    if (!state) {
        return {};
    }
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        state->load.stress[a] = random.integer(3) == 0 ? 0.0 : random.real(0.1, 2);
    }
    for (double& g : state->load.infinitesimal) {
        g = random.integer(3) == 0 ? 0.0 : random.integer(3) == 0 ? -1.0 : random.real(-1, 0.2);
    }
    return state;
}

inline std::optional<State> moved_by_ulps(std::optional<State> state, Random& random) {
    for (std::size_t k = 0; state && k < state->packing.q.size(); ++k) {
        state->packing.q[k] = a_few_ulps_from(state->packing.q[k], random);
    }
    return state;
}

inline std::optional<State> true_stresses(Random& random, int dimension = 2) {
    auto state = pile(small(random, 0.3, dimension), random);
    if (state) {
        state->load.kind = isostat::LoadKind::true_stress;
        for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
            state->load.stress[a] = random.real(-0.1, 2);
            state->load.reference_length[a] = random.real(0.5, 3);
        }
        if (random.integer(3) == 0) {
            const Truth truth(*state);
            const End& end = random.integer(2) == 0 ? truth.low : truth.high;
            if (truth.known && !end.unbounded && abs(end.stress) > 1e-30) {
                state->load.set_loaded_stress(ulps(static_cast<double>(end.stress), few(random)));
            }
        }
    }
    return state;
}

/// A coordinate held in place of one contact; its multiplier is 0, hardly different from 0, or anything.
inline std::optional<State> held_coordinate(Random& random, int dimension = 2) {
    auto state = pile(small(random, 0.2, dimension), random);
    if (!state) {
        return {};
    }
    for (int tries = 0; tries < 20; ++tries) {
        State other = *state;
        const auto slot = static_cast<std::size_t>(random.integer(static_cast<int>(other.contacts.size())));
        const int coordinate = random.integer(static_cast<int>(other.packing.q.size()));
        other.contacts[slot] = {ContactKind::held, coordinate, 0};
        const Truth truth(other);
        if (!truth.known) {
            continue; // nothing moves when that is held
        }
        std::vector<double> forces;
        for (std::size_t l = 0; l < other.contacts.size(); ++l) {
            forces.push_back(random.integer(4) == 0 ? -random.real(0, 2) : random.real(0.1, 2));
        }
        forces[slot] = random.integer(2) == 0 ? hardly_a_force(random) : random.real(-2, 2);
        load_for(other, truth, forces);
        return other;
    }
    return {};
}

/// Small integers and Pythagorean triples: exact as doubles, so that crafted inspection may speak of them.
inline std::optional<State> exact_lattice(Random& random) {
    State state;
    // Disk 0 in the corner, disk 1 up to the right of it at (3, 4), (4, 3), (5, 12), ... times a power of two.
    constexpr std::array<std::array<int, 3>, 4> triples{{{3, 4, 5}, {4, 3, 5}, {5, 12, 13}, {8, 15, 17}}};
    const auto& t = triples[static_cast<std::size_t>(random.integer(4))];
    const double r0 = 1 + random.integer(t[2] - 1);
    const double r1 = t[2] - r0;
    const double x = r0 + t[0];
    const double y = r0 + t[1];
    if (x < r1 || y < r1) {
        return {};
    }
    state.packing.radius = {r0, r1};
    state.packing.q = {r0, r0, x, y, x + r1, y + r1};
    state.packing.walls = isostat::Walls::box();
    state.contacts = {{ContactKind::disk_disk, 0, 1},
                      {ContactKind::lower_wall, 0, 0},
                      {ContactKind::lower_wall, 0, 1},
                      {ContactKind::upper_wall, 1, 0},
                      {ContactKind::upper_wall, 1, 1}};
    const bool on_wall = x == r1 || y == r1;
    if (on_wall || random.integer(2) == 0) { // the sixth contact
        if (!on_wall) {
            return {};
        }
        state.contacts.push_back({ContactKind::lower_wall, 1, x == r1 ? 0 : 1});
    } else {
        return {};
    }
    state.load.reference_length = {1, 1};
    state.load.stress = {static_cast<double>(random.integer(5)), static_cast<double>(random.integer(5))};
    state.load.infinitesimal = {-1.0, -1.0, 0.25, -1.0};
    state.load.disk_force = {0, 0, 0, 0};
    for (double& f : state.load.disk_force) {
        f = random.integer(2) == 0 ? 0.0 : random.integer(7) - 3.0;
    }
    return state;
}

} // namespace detail

inline std::vector<StateClass> state_classes() {
    using namespace detail;
    return {
        {"forces of 0 +- k ulp", [](Random& r) { return load(pile(small(r), r), r, 1 + r.integer(2)); }},
        {"loads whose product rounds", product},
        {"coordinates equal as stored", [](Random& r) { return equal_as_stored(r); }},
        {"radii that differ in the last bit", [](Random& r) { return load(pile(small(r, 0.9), r), r, r.integer(2)); }},
        {"fixed disks", [](Random& r) { return with_fixed(r, false); }},
        {"fixed disks that touch or overlap", [](Random& r) { return with_fixed(r, true); }},
        {"straight struts", strut},
        {"moved by ulps", [](Random& r) { return moved_by_ulps(load(pile(small(r, 0.5), r), r, r.integer(2)), r); }},
        {"at the end of the interval", [](Random& r) { return at_the_end(r); }},
        {"gaps at the threshold", [](Random& r) { return nearly_touching(r); }},
        {"infinitesimal loads decide", [](Random& r) { return infinitesimal_decides(r); }},
        {"true stresses", [](Random& r) { return true_stresses(r); }},
        {"exact numbers", exact_lattice},
        {"held coordinates", [](Random& r) { return held_coordinate(r); }, false},
        {"rectangular cells", [](Random& r) { return cell_at_threshold(CellKind::rectangular, r); }},
        {"tilted cells", [](Random& r) { return cell_at_threshold(CellKind::tilted, r); }},
        {"channels", [](Random& r) { return cell_at_threshold(CellKind::channel, r); }},
        {"exact numbers in cells", [](Random& r) { return exact_cell(r); }},
        {"a length that does not move", in_cell_of_fixed_length},
        {"exact numbers, a length that does not move", [](Random& r) { return exact_cell(r, true); }},
        {"spheres: forces of 0 +- k ulp", [](Random& r) { return load(pile(small(r, 0, 3), r), r, 1 + r.integer(2)); }},
        {"spheres: coordinates equal as stored", [](Random& r) { return equal_as_stored(r, 3); }},
        {"spheres: radii that differ in the last bit",
         [](Random& r) { return load(pile(small(r, 0.9, 3), r), r, r.integer(2)); }},
        {"spheres: moved by ulps",
         [](Random& r) { return moved_by_ulps(load(pile(small(r, 0.5, 3), r), r, r.integer(2)), r); }},
        {"spheres: at the end of the interval", [](Random& r) { return at_the_end(r, 3); }},
        {"spheres: gaps at the threshold", [](Random& r) { return nearly_touching(r, 3); }},
        {"spheres: normals nearly in one plane", nearly_coplanar},
        {"spheres: infinitesimal loads decide", [](Random& r) { return infinitesimal_decides(r, 3); }},
        {"spheres: true stresses", [](Random& r) { return true_stresses(r, 3); }},
        {"spheres: held coordinates", [](Random& r) { return held_coordinate(r, 3); }, false},
        {"spheres in orthorhombic cells",
         [](Random& r) { return spheres_at_threshold(isostat::PreparedCell::rectangular, r); }},
        {"spheres in triclinic cells",
         [](Random& r) { return spheres_at_threshold(isostat::PreparedCell::tilted, r); }},
    };
}

} // namespace contradictions
