// Periodic packings from random disks: proved vertices, and what may not change them.
// Spheres from random starts: proved vertices in boxes and in cells of three kinds.
#include "oracle/pairs.hpp"
#include "preparation/soft.hpp"
#include "support/cells.hpp"
#include "support/free_grains.hpp"
#include "support/prepared.hpp"

#include <isostat/certificate/certify.hpp>

namespace {

using namespace isostat;

PreparationOptions periodic(int disks, std::uint64_t seed) {
    return {.disks = disks, .seed = seed, .cell = PreparedCell::rectangular};
}

PreparationOptions spheres(int count, std::uint64_t seed, PreparedCell cell = PreparedCell::none) {
    return {.dimension = 3, .disks = count, .seed = seed, .cell = cell};
}

/// With overlaps everywhere.
Packing pressed_a_little(Packing packing) {
    for (double& x : packing.q) {
        x *= 1 - 1e-6;
    }
    return packing;
}

/// Radii that are 1024 times as large give the same packing, 1024 times as large.
void scales_with_its_radii(const State& one, PreparationOptions options) {
    options.radii = one.packing.radius;
    for (double& r : options.radii) {
        r *= 1024;
    }
    const State scaled = prepared(options);
    BOOST_TEST((scaled.contacts == one.contacts));
    for (std::size_t k = 0; k < one.packing.q.size(); ++k) {
        BOOST_TEST(scaled.packing.q[k] == 1024 * one.packing.q[k]);
    }
}

/// A square or simple cubic lattice under the pressure of its overlaps, some of it beyond the cell: every grain is
/// balanced, every contact there, through the sides, edges and corners of the cell too.
void lattice_feels_its_images(int dimension, int side) {
    constexpr std::array origin{0.3, -0.7, 5.0};
    Packing packing;
    packing.dimension = packing.cell.dimension = dimension;
    packing.walls = Walls::none();
    packing.cell.repeat();
    packing.cell.move(true, false);
    BOOST_TEST_INFO_SCOPE(dimension << " dimensions");
    const int count = dimension == 2 ? side * side : side * side * side;
    for (int k = 0; k < count; ++k) {
        packing.radius.push_back(1);
        int rest = k;
        for (std::size_t a = 0; a < packing.axes(); ++a, rest /= side) {
            packing.q.push_back(1.99 * (rest % side) + origin.at(a));
        }
    }
    packing.q.insert(packing.q.end(), packing.axes(), side * 1.99);
    packing.q.insert(packing.q.end(), dimension == 2 ? 1 : 3, 0);
    isostat::preparation::SoftDynamics dynamics(packing, false, nullptr, [](double) {});
    const auto measures = dynamics.relax(dimension == 2 ? 0.01 / 1.99 : 0.01 / (1.99 * 1.99), 1e-6, 0);
    BOOST_TEST(measures.contacts == dimension * count);
    BOOST_TEST(measures.residual < 1e-9);
    BOOST_TEST(measures.pressure_error < 1e-9);
    BOOST_TEST(std::abs(measures.overlap - 0.005) < 1e-12);
}

/// Contacts closed, all other pairs open, everything proved.
void is_proved_vertex_of_spheres(const State& state, std::size_t dofs) {
    const Packing& packing = state.packing;
    BOOST_TEST(packing.dimension == 3);
    BOOST_TEST(state.load.dimension == 3);
    BOOST_TEST(state.load.loaded_axis == 2);
    BOOST_TEST(state.contacts.size() == dofs);
    BOOST_TEST(state.load.infinitesimal.size() == 3 * packing.radius.size());
    const double rounding = 16 * grid_step(packing);
    for (const Contact& pair : oracle::all_pairs(packing, 2)) {
        const bool closed = std::ranges::binary_search(state.contacts, pair);
        BOOST_TEST((gap(packing, pair) <= rounding) == closed, to_string(pair));
        BOOST_TEST(gap(packing, pair) > -rounding, to_string(pair));
    }
    BOOST_TEST((certify(state).verdict == Verdict::proved));
}

} // namespace

BOOST_AUTO_TEST_CASE(periodic_packings_are_proved_equilibria) {
    for (const auto& [disks, seeds] : {std::pair{30, 5}, {100, 2}}) {
        for (int seed = 1; seed <= seeds; ++seed) {
            BOOST_TEST_INFO_SCOPE("n = " << disks << ", seed " << seed);
            const State state = prepared(periodic(disks, static_cast<std::uint64_t>(seed)));
            const Packing& packing = state.packing;
            BOOST_TEST(packing.cell.all());
            BOOST_TEST(packing.lattice(0, 1) == 0);
            BOOST_TEST(state.contacts.size() == 2 * packing.radius.size());
            BOOST_TEST(state.load.reference_length[0] == packing.length(0));
            BOOST_TEST(state.load.reference_length[1] == packing.length(1));
            for (std::size_t a = 0; a < 2; ++a) {
                double sum = 0;
                for (std::size_t k = a; k < state.load.infinitesimal.size(); k += 2) {
                    sum += state.load.infinitesimal[k];
                }
                BOOST_TEST(sum == 0);
            }
            BOOST_TEST((certify(state).verdict == Verdict::proved));
            BOOST_TEST(packing.solid_fraction() > 0.75);
            BOOST_TEST(packing.solid_fraction() < 0.9);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_tilt_that_moves_bears_no_shear_and_has_its_contact) {
    PreparationOptions options = periodic(60, 1);
    options.cell = PreparedCell::tilted;
    const State state = prepared(options);
    BOOST_TEST(state.contacts.size() == 2 * state.packing.radius.size() + 1);
    BOOST_TEST(state.packing.lattice(0, 1) != 0);
    BOOST_TEST(std::abs(state.packing.lattice(0, 1)) < 0.1 * state.packing.length(0));
    BOOST_TEST((state.load.shear == isostat::PerTilt<double>{}));
    const Certification proof = certify(state);
    BOOST_TEST((proof.verdict == Verdict::proved));
    BOOST_TEST((inspect_cell(state, proof).strict.verdict == Verdict::proved));
    // Downhill under a larger stress along y: at an isotropic pressure a force would be negative.
    options.ratio = 1.3;
    const State pressed = vertex_near(state.packing, options);
    BOOST_TEST(pressed.packing.length(1) < state.packing.length(1));
    BOOST_TEST((inspect_cell(pressed, certify(pressed)).strict.verdict == Verdict::refuted));
}

// The vertex of the cell that is stored, found again with overlaps everywhere: all pairs across the sides count.
BOOST_AUTO_TEST_CASE(a_vertex_is_found_again_in_its_cell) {
    const State state = prepared(periodic(30, 3));
    Packing soft = pressed_a_little(state.packing);
    PreparationOptions options = periodic(30, 3);
    PreparationReport report;
    const State again = vertex_near(soft, options);
    BOOST_TEST(std::abs(again.packing.length(0) - state.packing.length(0)) < 1e-11);
    BOOST_TEST(std::abs(again.packing.length(1) - state.packing.length(1)) < 1e-11);
    soft.cell.period_moves = {true, false};
    BOOST_CHECK_THROW((void)find_vertex(soft, options, report), Error);
}

BOOST_AUTO_TEST_CASE(a_vertex_is_found_in_a_channel) {
    Packing soft = pressed_a_little(cells::of_file("channel_16").packing);
    PreparationOptions options = periodic(16, 1);
    PreparationReport report;
    const State state = vertex_near(soft, options);
    BOOST_TEST(state.contacts.size() == 2 * state.packing.radius.size() + 1);
    BOOST_TEST((certify(state).verdict == Verdict::proved));
    const auto some = [&](auto holds) { return std::ranges::any_of(state.contacts, holds); };
    BOOST_TEST(some([](const Contact& c) { return !c.image.is_here(); }));
    BOOST_TEST(some([](const Contact& c) { return c.kind == ContactKind::upper_wall; }));
    BOOST_TEST(some([](const Contact& c) { return c.kind == ContactKind::lower_wall; }));
    soft.cell.period_moves = {false, false};
    BOOST_CHECK_THROW((void)find_vertex(soft, options, report), Error);
}

BOOST_AUTO_TEST_CASE(the_same_seed_gives_the_same_cell_and_units_do_not_matter) {
    const State one = prepared(periodic(30, 2));
    BOOST_TEST(one.packing.q == prepared(periodic(30, 2)).packing.q, boost::test_tools::per_element());
    scales_with_its_radii(one, periodic(30, 2));
}

// Where the disks are drawn must not matter for the forces: all pairs across the sides are there. A cell shifted by
// half a period has other images, and relaxes to the same pressure and number of contacts.
BOOST_AUTO_TEST_CASE(soft_grains_feel_their_images) {
    lattice_feels_its_images(2, 6);
    lattice_feels_its_images(3, 4);
}

BOOST_AUTO_TEST_CASE(too_few_or_too_many_disks_are_refused) {
    PreparationReport report;
    BOOST_CHECK_THROW((void)prepare(periodic(9000, 1), report), Error);
    PreparationOptions options = periodic(30, 1);
    options.load = LoadKind::true_stress;
    BOOST_TEST((certify(prepared(options)).verdict == Verdict::proved));
    options.cell = PreparedCell::tilted; // no potential
    BOOST_CHECK_THROW((void)prepare(options, report), Error);
    PreparationOptions few = periodic(3, 1); // the cell becomes narrower than four diameters
    BOOST_CHECK_THROW((void)prepare(few, report), Error);
}

BOOST_AUTO_TEST_CASE(a_way_down_that_flattens_the_cell_ends_with_words) {
    // Found by the search for contradictions: a large stress along y shears and flattens a cell of four disks.
    Packing start =
        without_walls::free_grains({2.7876204452241971, 0.65472544046501935, 1.0015561869148328, 3.2929607891851669},
                                   {5.8328524909703203, 3.6381445016534553, 3.5319556976286353, 6.2488283970903336,
                                    8.9283998854660425, 1.3884984014368156, -0.24170659535067671, 4.5402521862358807,
                                    12.149213315945422, 6.0596347498486081, -2.7414239873924848});
    start.cell = {{true, true}, {true, true}, {true}, 2};
    PreparationOptions options{.stress = 0.50053308055745815, .ratio = 3.7831519571624725};
    PreparationReport report;
    fails(find_vertex(start, options, report), FailureKind::not_converged, {"too flat, or too tilted"});
    options.ratio = 1;
    BOOST_TEST(find_vertex(start, options, report).ok());
}

BOOST_AUTO_TEST_CASE(spheres_in_a_box_are_a_proved_equilibrium) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        const State state = prepared(spheres(20, seed));
        is_proved_vertex_of_spheres(state, 3 * 20 + 3);
        BOOST_TEST((state.packing.walls == Walls::box(3)));
        BOOST_TEST((state.load.stress == PerAxis<double>{1, 1, 1}));
        BOOST_TEST(state.load.reference_length[2] == state.packing.length(2));
    }
}

BOOST_AUTO_TEST_CASE(spheres_in_cells_are_proved_equilibria) {
    using enum PreparedCell;
    for (const auto& [cell, more] : {std::pair{rectangular, 0}, {tilted, 3}, {isotropic, -2}}) {
        const State state = prepared(spheres(16, 1, cell));
        is_proved_vertex_of_spheres(state, static_cast<std::size_t>(3 * 16 + more));
        BOOST_TEST(state.packing.cell.all());
        for (std::size_t b = 1; b < 3; ++b) {
            for (std::size_t a = 0; a < b; ++a) {
                BOOST_TEST((state.packing.lattice(a, b) != 0) == (cell == tilted));
            }
        }
        BOOST_TEST((state.load.shear == PerTilt<double>{}));
    }
}

// Equal spheres at a wall are at one height: contacts along it bear nothing across it, whatever the load.
BOOST_AUTO_TEST_CASE(equal_spheres_at_a_wall_are_prepared) {
    for (const RadiiLaw law : {RadiiLaw::bidisperse, RadiiLaw::equal}) {
        PreparationOptions options = spheres(30, 2);
        options.diameters.kind = law;
        options.jitter = law == RadiiLaw::equal ? 1e-3 : 0;
        is_proved_vertex_of_spheres(prepared(options), 3 * 30 + 3);
    }
}

BOOST_AUTO_TEST_CASE(the_unit_of_spheres_does_not_matter) {
    PreparationOptions options = spheres(12, 5, PreparedCell::tilted);
    scales_with_its_radii(prepared(options), options);
}

BOOST_AUTO_TEST_CASE(a_vertex_of_spheres_is_found_again_and_another_under_another_stress) {
    const State state = prepared(spheres(20, 4));
    const Packing soft = pressed_a_little(state.packing);
    PreparationOptions options = spheres(20, 4);
    BOOST_TEST(std::abs(vertex_near(soft, options).packing.length(2) - state.packing.length(2)) < 1e-11);
    options.ratio = 4;
    const State pressed = vertex_near(soft, options);
    BOOST_TEST((pressed.load.stress == PerAxis<double>{1, 1, 4}));
    BOOST_TEST(pressed.packing.length(2) < state.packing.length(2));
    BOOST_TEST((certify(pressed).verdict == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(four_dimensions_and_too_few_spheres_for_a_cell_are_refused) {
    PreparationReport report;
    PreparationOptions options = spheres(20, 1);
    options.dimension = 4;
    BOOST_CHECK_THROW((void)prepare(options, report), Error);
    BOOST_CHECK_THROW((void)prepare(spheres(1, 1, PreparedCell::rectangular), report), Error);
}
