// Spheres from random starts: proved vertices in boxes and in cells of three kinds.

#include "oracle/pairs.hpp"
#include "preparation/soft.hpp"
#include "support/prepared.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/error.hpp>

namespace {

using namespace isostat;

PreparationOptions spheres(int count, std::uint64_t seed, PreparedCell cell = PreparedCell::none) {
    return {.dimension = 3, .disks = count, .seed = seed, .cell = cell};
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
        const bool closed = std::binary_search(state.contacts.begin(), state.contacts.end(), pair);
        BOOST_TEST((gap(packing, pair) <= rounding) == closed, to_string(pair));
        BOOST_TEST(gap(packing, pair) > -rounding, to_string(pair));
    }
    BOOST_TEST((certify(state).verdict == Verdict::proved));
}

} // namespace

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
    const State one = prepared(options);
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

BOOST_AUTO_TEST_CASE(a_vertex_of_spheres_is_found_again_and_another_under_another_stress) {
    const State state = prepared(spheres(20, 4));
    Packing soft = state.packing;
    for (double& x : soft.q) {
        x *= 1 - 1e-6;
    }
    PreparationOptions options = spheres(20, 4);
    const State again = vertex_near(soft, options);
    BOOST_TEST(std::abs(again.packing.length(2) - state.packing.length(2)) < 1e-11);
    options.ratio = 4;
    const State pressed = vertex_near(soft, options);
    BOOST_TEST((pressed.load.stress == PerAxis<double>{1, 1, 4}));
    BOOST_TEST(pressed.packing.length(2) < state.packing.length(2));
    BOOST_TEST((certify(pressed).verdict == Verdict::proved));
}

// A simple cubic lattice under the pressure of its overlaps: every sphere is balanced, every contact there, through
// the sides, edges and corners of the cell too.
BOOST_AUTO_TEST_CASE(soft_spheres_feel_their_images) {
    constexpr int side = 4;
    Packing packing;
    packing.dimension = packing.cell.dimension = 3;
    packing.walls = Walls::none();
    packing.cell.repeat();
    packing.cell.move(true, false);
    for (int k = 0; k < side * side * side; ++k) {
        packing.radius.push_back(1);
        packing.q.insert(packing.q.end(), {1.99 * (k % side) + 0.3, 1.99 * (k / side % side) - 0.7,
                                           1.99 * (k / (side * side)) + 5}); // some beyond the cell
    }
    packing.q.insert(packing.q.end(), {side * 1.99, side * 1.99, side * 1.99, 0, 0, 0});
    isostat::preparation::SoftDynamics dynamics(packing, false, nullptr, [](double) {});
    const auto measures = dynamics.relax(0.01 / (1.99 * 1.99), 1e-6, 0);
    BOOST_TEST(measures.contacts == 3 * side * side * side);
    BOOST_TEST(measures.residual < 1e-9);
    BOOST_TEST(measures.pressure_error < 1e-9);
    BOOST_TEST(std::abs(measures.overlap - 0.005) < 1e-12);
}

BOOST_AUTO_TEST_CASE(four_dimensions_and_too_few_spheres_for_a_cell_are_refused) {
    PreparationReport report;
    PreparationOptions options = spheres(20, 1);
    options.dimension = 4;
    BOOST_CHECK_THROW((void)prepare(options, report), Error);
    BOOST_CHECK_THROW((void)prepare(spheres(1, 1, PreparedCell::rectangular), report), Error);
}
