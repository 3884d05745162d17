#include "certificate/averages.hpp"
#include "support/spheres.hpp"
#include "support/test.hpp"

#include <isostat/certificate/certify.hpp>

using namespace isostat;

namespace {

/// The stress of the contacts is that on walls and cell, and the distribution is one.
void check_averages(const State& state, const std::string& name) {
    const Certification truth = certify(state);
    BOOST_TEST_REQUIRE(truth.finite.size() == state.contacts.size());
    const ForceAverages mean = isostat::force_averages(state, truth);
    double volume = 1;
    for (int a = 0; a < state.packing.dimension; ++a) {
        volume *= state.packing.length(a);
    }
    double pressure = 0;
    for (const isostat::WallForce& wall : state.load.wall_forces(state.packing)) {
        const auto a = static_cast<std::size_t>(wall.axis);
        const double stress =
            wall.stress * wall.length * wall.other * state.packing.length(wall.axis) / volume; // of the volume now
        BOOST_TEST(std::abs(mean.stress[a][a] - stress) < 1e-12 * std::abs(stress), name << ", axis " << a);
        pressure += stress / state.packing.dimension;
    }
    BOOST_TEST(std::abs(mean.pressure - pressure) < 1e-12 * pressure, name);
    double trace = 0;
    for (std::size_t a = 0; a < state.packing.axes(); ++a) {
        trace += mean.fabric[a][a];
    }
    BOOST_TEST(std::abs(trace - 1) < 1e-12, name); // unit normals
    double share = 0;
    double first_moment = 0; // the bins are a quarter wide
    for (const auto& [centre, density] : isostat::force_distribution(state, truth)) {
        share += 0.25 * density;
        first_moment += 0.25 * density * centre;
    }
    BOOST_TEST(std::abs(share - 1) < 1e-12, name);
    BOOST_TEST(std::abs(first_moment - 1) < 0.125, name); // f / <f> has the mean 1
}

} // namespace

BOOST_AUTO_TEST_CASE(the_stress_of_the_contacts_is_that_on_the_walls) {
    for (const char* name : {"box_uniform_30_1", "slab_uniform_30_1", "ortho_uniform_30_1"}) {
        const State spheres = isostat::test::state_of_spheres(isostat::test::read_spheres(name));
        check_averages(spheres, name);
        State other = spheres; // not isotropic
        other.load.stress[2] *= 1.002;
        check_averages(other, std::string(name) + " under another stress");
    }
}

/// Two spheres in a box (tests/data/spheres): N = 9, all carry.
BOOST_AUTO_TEST_CASE(coordination_counts_pairs_twice_and_rattlers_once) {
    const State two = isostat::test::state_of_spheres(isostat::test::read_spheres("closed_two"));
    const isostat::Coordination all = isostat::coordination(two, certify(two), 0);
    BOOST_TEST(all.all == 5); // (2 * 1 + 8) / 2
    BOOST_TEST(all.carrying == 5);
    const State rattler = isostat::test::state_of_spheres(isostat::test::read_spheres("closed_rattler"));
    const isostat::Coordination some = isostat::coordination(rattler, certify(rattler), 1);
    BOOST_TEST(some.all == 4.5);
    BOOST_TEST(some.carrying == 6);
}
