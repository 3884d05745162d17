// What is claimed of a true vertex against statements V4 to V7, with a bound of the inverse that is made worse on
// purpose: then every term of every bound is large enough to be seen.
#include "certificate/parts.hpp"
#include "certificate/true_vertex.hpp"
#include "contact/candidates.hpp"
#include "core/dot.hpp"
#include "oracle/random.hpp"
#include "support/cells.hpp"
#include "support/crafted.hpp"
#include "support/free_grains.hpp"
#include "support/scratch.hpp"
#include "verified/enclosed_vertex.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

using namespace isostat;
using namespace crafted;

namespace {

void check_above(double value, double least, double slack) {
    BOOST_TEST(value >= least * (1 - 1e-12), value << " is below " << least);
    BOOST_TEST(value <= least * (1 + slack), value << " is far above " << least);
}

/// Two disks pushed off their vertex; beta is such that beta K eta = h in T9.
struct Worse {
    State state = pushed(two_disks(1, 2, 1, 1), 1e-9);
    std::unique_ptr<ProvedStructure> centre = std::move(ProvedStructure::make(state.packing, state.contacts).value());
    double k = 2.0 / 3;  ///< K of V4: one contact, lengths 1 + 2
    double residual = 0; ///< |F|
    double beta = 0;
    double radius = 0; ///< 1.18 eta
    std::optional<Subject> subject;
    std::unique_ptr<TrueVertex> vertex;

    explicit Worse(double h, LoadKind kind = LoadKind::nominal) {
        state.load.kind = kind;
        state.load.loaded_axis = 0; // whose forces the two disks pass on
        std::vector<double> f;
        for (const Contact& c : state.contacts) {
            f.push_back(gap(state.packing, c)); // F = gap (1 + gap / 2 D)
        }
        residual = euclidean_norm(f);
        beta = std::sqrt(h / (k * residual));
        radius = 1.18 * beta * residual;
        give_inverse_norm(beta);
        subject.emplace(state, centre->structure);
        vertex = in_double(*subject, *centre);
    }
    /// Claims a bound of the inverse that makes the bound of |DF^-1| at q (V4) what is asked for.
    void give_inverse_norm(double norm) const {
        centre->inverse.sigma_min = (1 + 2 * worst_gap_ratio(state.packing, state.contacts)) / norm;
    }
    /// max_i sum |x_l| / D_l: only one contact has two disks.
    [[nodiscard]] double weight(const std::vector<double>& x) const {
        const auto l = std::ranges::find(state.contacts, pair(0, 1)) - state.contacts.begin();
        return std::abs(x[static_cast<std::size_t>(l)]) / 3;
    }
    [[nodiscard]] std::vector<double> middle(const std::vector<Interval>& x) const {
        std::vector<double> m;
        for (const Interval& i : x) {
            m.push_back((i.lower + i.upper) / 2);
        }
        return m;
    }
    /// Forces per unit of the loaded stress.
    [[nodiscard]] std::vector<double> slopes() const {
        std::vector<double> x(state.contacts.size(), 0.0);
        for (const WallForce& wall : state.load.wall_forces(state.packing)) {
            if (wall.rate != 0) {
                x[static_cast<std::size_t>(subject->changing_rows.front())] = -wall.length;
            }
        }
        centre->factorisation.solve_forces(x);
        return x;
    }
};

} // namespace

BOOST_AUTO_TEST_CASE(the_centre_has_the_constants_of_V4) {
    for (const double size : {0.0, 1e-5}) {
        const State state = pushed(read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state, size);
        const auto centre = required(ProvedStructure::make(state.packing, state.contacts));
        const auto near = Neighbourhood::of(centre->packing, state.contacts, centre->inverse);
        std::vector<int> count(state.packing.radius.size(), 0);
        double smallest = 1e300, ratio = 0, largest = 0;
        for (const Contact& c : state.contacts) {
            const auto i = static_cast<std::size_t>(c.i);
            const auto j = static_cast<std::size_t>(c.j);
            const double h = std::abs(gap(state.packing, c));
            largest = std::max(largest, h);
            if (c.kind == ContactKind::disk_disk) {
                const double d = state.packing.radius[i] + state.packing.radius[j];
                smallest = std::min(smallest, d);
                ratio = std::max(ratio, h / d);
                ++count[i];
                ++count[j];
            }
        }
        check_above(near.lipschitz, 2 * std::sqrt(*std::ranges::max_element(count)) / smallest, 1e-12);
        check_above(near.inverse_norm * centre->inverse.sigma_min, 1 / (1 - ratio), 3 * ratio + 1e-12);
        BOOST_TEST(near.inverse_norm * centre->inverse.sigma_min >= 1 + 2 * ratio);
        BOOST_TEST(certify(state).stored_gap >= largest);
    }
}

BOOST_AUTO_TEST_CASE(a_vertex_exists_up_to_the_quarter_of_Kantorovich_and_its_radii_are_those_of_V5) {
    for (const double h : {0.01, 0.1, 0.2, 0.245, 0.2501, 0.3, 0.4}) {
        const Worse worse(h);
        BOOST_TEST(worse.vertex->exists() == (h < 0.25), h);
        if (!worse.vertex->exists()) {
            continue;
        }
        const double room = 1.7 / (worse.beta * worse.k) / std::sqrt(6.0);
        check_above(worse.vertex->distance(), worse.radius * 1.172 / 1.18, 0.01);
        check_above(worse.vertex->radius(), worse.radius * 1.172 / 1.18, 0.01);
        const double sigma = 1 / worse.beta - worse.k * worse.radius;
        BOOST_TEST(worse.vertex->sigma_min() <= sigma);
        BOOST_TEST(worse.vertex->sigma_min() >= sigma * (1 - 1e-6));
        BOOST_TEST(worse.vertex->unique_radius() <= room);
        BOOST_TEST(worse.vertex->unique_radius() >= worse.vertex->radius());
        // The gap of any pair, to the true vertex.
        const Interval gap = worse.vertex->gap(left(1));
        check_above((gap.upper - gap.lower) / 2, std::sqrt(2.0) * worse.radius * (1 - 1e-9), 0.01);
    }
}

BOOST_AUTO_TEST_CASE(the_stored_point_is_within_the_radius_claimed) {
    // In double-double the enclosure is about a corrected point: the way there is part of the radius.
    Worse worse(0.01);
    worse.give_inverse_norm(10);
    const auto vertex = in_double_double(*worse.subject, *worse.centre);
    BOOST_TEST_REQUIRE(vertex->exists());
    std::vector<double> step;
    std::ranges::transform(worse.state.contacts, std::back_inserter(step),
                           [&](const Contact& c) { return gap(worse.state.packing, c); });
    worse.centre->factorisation.solve_velocities(step);
    check_above(vertex->radius(), largest(step) * (1 - 1e-6), 1e-3);
    check_above(vertex->distance(), euclidean_norm(step) * (1 - 1e-6), 1e-3);
}

BOOST_AUTO_TEST_CASE(forces_have_the_bound_of_V6) {
    for (const LoadKind kind : {LoadKind::nominal, LoadKind::true_stress}) {
        Worse worse(0.01, kind);
        BOOST_TEST_REQUIRE(worse.vertex->exists());
        const std::vector<Interval> forces = worse.vertex->forces();
        const double load = kind == LoadKind::nominal ? 0 : std::hypot(1.0, 1.0) * worse.radius;
        const double turned = 2 * worse.weight(worse.middle(forces)) * worse.radius;
        const double bound = (forces[0].upper - forces[0].lower) / 2;
        check_above(bound * worse.vertex->sigma_min(), (turned + load) * (1 - 1e-6), 0.01);
    }
}

BOOST_AUTO_TEST_CASE(ends_of_the_interval_have_the_bound_of_V7) {
    for (const double h : {0.001, 0.02}) {
        Worse worse(h);
        BOOST_TEST_REQUIRE(worse.vertex->exists());
        const LoadEndAnswer high = worse.vertex->load_end(+1);
        BOOST_TEST_REQUIRE(high.claim.has_value(), high.open_question);
        const std::vector<double> f = worse.middle(worse.vertex->forces());
        const std::vector<double> b = worse.slopes();
        const double a_bound = (worse.vertex->forces()[0].upper - worse.vertex->forces()[0].lower) / 2;
        const double b_bound = 2 * worse.weight(b) * worse.radius / worse.vertex->sigma_min();
        const auto opens = static_cast<std::size_t>(std::ranges::find(worse.state.contacts, high.claim->opens) -
                                                    worse.state.contacts.begin());
        const double t = f[opens] / b[opens];
        const double least = (a_bound + std::abs(t) * b_bound) / (std::abs(b[opens]) - b_bound);
        BOOST_TEST(b_bound > 1e-3 * std::abs(b[opens])); // so that every term counts
        check_above((high.claim->stress.upper - high.claim->stress.lower) / 2, least * (1 - 1e-6), 0.01);
    }
}

BOOST_AUTO_TEST_CASE(pairs_beyond_the_list_are_as_far_as_its_reach_less_the_way_to_the_vertex) {
    // Disk 2 is 1e-10 off its true place, and disk 3 stands where the list just ends: whatever is not listed may come
    // nearer than that. Disk 6 carries so little that the vertex is known in double-double, hence far better than
    // 1e-10.
    State state;
    state.packing =
        without_walls::free_grains({3, 3, 2, 1, 3, 3, 2}, {-3, 0, 3, 0, 0, 4 + 1e-10, 0, 0, -3, -90, 3, -90, 0, -86});
    state.packing.fixed = {1, 1, 0, 1, 1, 1, 0};
    state.load.disk_force = {0, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, -1e-25};
    state.contacts = {pair(0, 2), pair(1, 2), pair(4, 6), pair(5, 6)};
    const double reach = find_candidates(state.packing, 0.82).reach;
    state.packing.q[7] = state.packing.q[5] + 3 + reach - 2e-11;
    BOOST_TEST_REQUIRE(find_candidates(state.packing, 0.82).reach == reach);
    const Certification c = certify(state);
    BOOST_TEST_REQUIRE(c.claims.gaps.has_value());
    BOOST_TEST((c.claims.gaps->rung == Rung::double_double));
    BOOST_TEST(c.claims.gaps->smallest <= reach - 1e-10 * std::sqrt(2.0));
    BOOST_TEST(c.claims.gaps->smallest >= reach - 1e-9);
}

BOOST_AUTO_TEST_CASE(what_the_grid_moved_the_pinned_disk_by_is_part_of_the_radius_in_a_cell) {
    State state = read_any_state(scratch::data("cells/tilt_16.json")).state;
    snap_to_grid(state.packing);
    const auto centre = std::move(ProvedStructure::make(state.packing, state.contacts).value());
    const auto radius = [&](double off_the_grid) {
        State stored = state;
        const auto pin = static_cast<std::size_t>(state.packing.cell.pin);
        stored.packing.q[2 * pin] += off_the_grid;
        stored.packing.q[2 * (pin + 1)] -= off_the_grid;
        const auto vertex = in_double(Subject(stored, centre->structure), *centre);
        BOOST_TEST_REQUIRE(vertex->exists());
        return vertex->radius();
    };
    BOOST_TEST(radius(0) < 1e-9);
    check_above(radius(1e-6), 2e-6, 0.01); // the vertex has the pin where it is stored: the other disk is 2e-6 off
}

BOOST_AUTO_TEST_CASE(pairs_beyond_the_list_of_a_cell_have_the_weight_of_C4) {
    // One disk and its images in a cell of fixed tilt, off its vertex by 1e-10. The tilt is such that the nearest pair
    // is just inside the list: then what is claimed is the reach of the list, less C4's weight times the distance.
    State state = cells::in_cell({{0.5, 0.25, 0.5}}, {1, 1, 0}, false, 1, 1,
                                 {cells::across(0, 0, 0, 1), cells::across(0, 0, 1, 0)});
    const double reach = find_candidates(state.packing, 0.82).reach;
    const double tilt = std::ldexp(std::round(std::ldexp(1 - std::pow(1 + reach - 1e-11, 2) / 2, 45)), -45);
    const double off = 1e-10;
    const double height = std::sqrt(1 - tilt * tilt);
    state.packing.q = {0.25, 0.5, 1, height - off, tilt};
    BOOST_TEST_REQUIRE(find_candidates(state.packing, 0.82).reach == reach);
    const Certification c = certify(state);
    BOOST_TEST_REQUIRE(c.claims.gaps.has_value());
    const double stretch = height / std::hypot(1.0, tilt, height); // determinant over the norm
    const double weight = std::sqrt(2.0) + (2 * 0.5 + reach) / stretch;
    check_above(reach - c.claims.gaps->smallest, weight * c.claims.vertex->radius * (1 - 1e-3), 0.01); // Ly alone moves
}

BOOST_AUTO_TEST_CASE(true_stresses_on_a_sphere_press_on_the_areas_of_the_true_vertex) {
    constexpr double side = 2000; // of the cube at the vertex: what an area lacks is far more than what a length lacks
    State state;
    state.packing.dimension = state.packing.cell.dimension = state.load.dimension = 3;
    state.packing.walls = Walls::box(3);
    state.packing.radius = {side / 2};
    state.packing.q = {side / 2, side / 2, side / 2, side + 1e-6, side + 2e-6, side - 1e-6};
    state.load.kind = LoadKind::true_stress;
    state.load.stress = {1, 2, 3};
    state.load.loaded_axis = 2;
    for (int a = 0; a < 3; ++a) {
        state.contacts.push_back({ContactKind::lower_wall, 0, a});
        state.contacts.push_back({ContactKind::upper_wall, 0, a});
    }
    const auto centre = std::move(ProvedStructure::make(state.packing, state.contacts).value());
    const Subject subject(state, centre->structure);
    const auto vertex = in_double(subject, *centre);
    BOOST_TEST_REQUIRE(vertex->exists());
    const std::vector<Interval> forces = vertex->forces();
    for (std::size_t l = 0; l < forces.size(); ++l) {
        const double exact = state.load.stress[l / 2] * side * side;
        BOOST_TEST((forces[l].lower <= exact && exact <= forces[l].upper));
        BOOST_TEST(forces[l].upper - forces[l].lower < 1e-6 * exact);
    }
    const LoadEndAnswer end = vertex->load_end(-1); // the force along z vanishes without a stress
    BOOST_TEST_REQUIRE(end.claim.has_value());
    BOOST_TEST((end.claim->stress.lower <= 0 && end.claim->stress.upper >= 0));
}

BOOST_AUTO_TEST_CASE(periods_in_space_are_stretched_as_little_as_C4_counts_on) {
    oracle::Random random(8);
    Packing packing = without_walls::free_grains({1}, {}, 3); // one sphere, which has no extent
    double nearest = 0;                                       // of the least stretch found to the bound
    for (int trial = 0; trial < 200; ++trial) {
        packing.q.assign(9, 0.0);
        for (std::size_t a = 0; a < 3; ++a) {
            packing.cell.periodic[a] = a == static_cast<std::size_t>(trial % 3) || random.integer(2) == 0;
            packing.q[3 + a] = packing.cell.periodic[a] ? random.real(0.2, 3) : 5;
        }
        for (std::size_t b = 1; b < 3; ++b) {
            for (std::size_t a = 0; a < b; ++a) {
                packing.q[packing.tilt_at(a, b)] =
                    packing.cell.periodic[a] && packing.cell.periodic[b] ? random.real(-2, 2) : 0;
            }
        }
        const double least = (2 + 0.5) / (far_weight(packing, 0.5) - 1.4143);
        for (int k = 1; k < 13 * 13 * 13; ++k) {
            const std::array<int, 3> m{k % 13 - 6, k / 13 % 13 - 6, k / 169 - 6};
            std::array<double, 3> x{};
            bool there = m != std::array<int, 3>{};
            for (std::size_t b = 0; b < 3; ++b) {
                there = there && (m[b] == 0 || packing.cell.periodic[b]);
                for (std::size_t a = 0; a <= b; ++a) {
                    x[a] += packing.lattice(a, b) * m[b];
                }
            }
            const double stretch = std::hypot(x[0], x[1], x[2]) / std::hypot(m[0], m[1], m[2]);
            if (there) {
                BOOST_TEST(stretch >= least * (1 - 1e-9));
                nearest = std::max(nearest, least / stretch);
            }
        }
    }
    BOOST_TEST(nearest > 0.99);
}
