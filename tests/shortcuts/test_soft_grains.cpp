// The soft grains against closed forms, against energy, and against the rigid packing that they approximate.
#include "support/crafted.hpp"
#include "support/prepared.hpp"
#include "support/shortcuts/soft_grains.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/error.hpp>

#include <eigen3/Eigen/Dense>

using namespace isostat;
using namespace crafted;

namespace {

SoftGrainOptions at_ratio(double kappa) {
    return {.stiffness_ratio = kappa};
}

/// Largest |soft force - rigid force| / largest rigid force over the rigid contacts.
double force_error(const State& state, const std::vector<double>& rigid, double kappa) {
    SoftGrains soft(state.packing, state.load, at_ratio(kappa));
    BOOST_REQUIRE(soft.relax());
    const std::vector<SoftContact> found = soft.contacts();
    double worst = 0;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const auto same = std::find_if(found.begin(), found.end(),
                                       [&](const SoftContact& c) { return c.contact == state.contacts[l]; });
        worst = std::max(worst, std::abs((same == found.end() ? 0 : same->force) - rigid[l]));
    }
    return worst / *std::max_element(rigid.begin(), rigid.end());
}

} // namespace

BOOST_AUTO_TEST_SUITE(shortcuts)

BOOST_AUTO_TEST_CASE(one_disk_in_a_box_shrinks_by_two_overlaps_on_each_axis) {
    SoftGrains soft(one_disk(1, 3).packing, one_disk(1, 3).load, at_ratio(100)); // P = 2, K = 200
    BOOST_TEST(soft.stiffness() == 200.0);
    BOOST_REQUIRE(soft.relax());
    BOOST_TEST(soft.packing().length(0) == 2 - 2 * (1 / 200.0), boost::test_tools::tolerance(1e-5));
    BOOST_TEST(soft.packing().length(1) == 2 - 2 * (3 / 200.0), boost::test_tools::tolerance(1e-5));
    BOOST_TEST(soft.contacts().size() == 4U);
    for (const SoftContact& c : soft.contacts()) {
        BOOST_TEST(c.force == (c.contact.j == 0 ? 1.0 : 3.0), boost::test_tools::tolerance(1e-3));
    }
}

BOOST_AUTO_TEST_CASE(two_disks_approach_their_closed_form_as_the_inverse_of_the_stiffness) {
    // f(0-1) = F1 (R0 + R1) / (2 sqrt(R0 R1)): balance of disk 0 along x.
    const double r0 = 1;
    const double r1 = 2;
    const State state = two_disks(r0, r1, 1, 3); // at F2 = F1 the first order nearly cancels
    const double exact = (r0 + r1) / (2 * std::sqrt(r0 * r1));
    std::vector<double> error;
    for (const double kappa : {1e2, 1e3, 1e4}) {
        SoftGrainOptions options = at_ratio(kappa);
        options.tolerance = 1e-9;
        SoftGrains soft(state.packing, state.load, options);
        BOOST_REQUIRE(soft.relax());
        BOOST_TEST(soft.contacts().size() == 6U);
        for (const SoftContact& c : soft.contacts()) {
            if (c.contact == pair(0, 1)) {
                error.push_back(std::abs(c.force / exact - 1));
            }
        }
    }
    BOOST_REQUIRE(error.size() == 3U);
    BOOST_TEST(error[0] > 1e-4); // a wrong answer of its own kind
    BOOST_TEST(std::log10(error[0] / error[1]) == 1.0, boost::test_tools::tolerance(0.1));
    BOOST_TEST(std::log10(error[1] / error[2]) == 1.0, boost::test_tools::tolerance(0.1));
}

BOOST_AUTO_TEST_CASE(a_disk_that_touches_nothing_falls_as_drag_lets_it) {
    State state = one_disk(1, 1);
    state.packing.q = {50, 50, 100, 100};
    state.load.disk_force = {0.01, 0};
    SoftGrainOptions options = at_ratio(1e2);
    options.drag = 0.05;
    options.step_fraction = 0.3;
    SoftGrains soft(state.packing, state.load, options);
    const double dt = soft.time_step();
    soft.advance(200);
    const double t = 200 * dt;
    BOOST_REQUIRE(soft.packing().length(0) - soft.packing().q[0] > 2); // the walls come in: not yet there
    const double a = 0.01 / soft.stiffness();
    const double fallen = a / 0.05 * (t - (1 - std::exp(-0.05 * t)) / 0.05);
    BOOST_TEST(soft.packing().q[0] - 50 == fallen, boost::test_tools::tolerance(5e-3));
}

BOOST_AUTO_TEST_CASE(energy_only_decays) {
    State state = prepared(30, 3);
    for (std::size_t k = 0; k < state.packing.q.size(); ++k) { // squeezed, sheared, out of balance
        state.packing.q[k] *= k % 2 == 0 ? 0.99 : 1.005;
    }
    SoftGrainOptions options = at_ratio(1e3);
    options.step_fraction = 0.1;
    SoftGrains soft(state.packing, state.load, options);
    const double first = soft.energy();
    double before = first;
    int falls = 0;
    for (int k = 0; k < 400; ++k) {
        soft.advance(20);
        const double now = soft.energy();
        BOOST_TEST(now <= before + 1e-4 * std::abs(first));
        falls += now < before ? 1 : 0;
        before = now;
    }
    BOOST_TEST(before < 0.5 * first);
    BOOST_TEST(falls > 350);
}

BOOST_AUTO_TEST_CASE(the_time_step_is_below_the_true_highest_frequency) {
    const State state = prepared(30, 5);
    SoftGrains soft(state.packing, state.load, at_ratio(1e3));
    BOOST_REQUIRE(soft.relax());
    const std::size_t dofs = soft.packing().q.size();
    Eigen::MatrixXd springs = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(dofs), static_cast<Eigen::Index>(dofs));
    for (const SoftContact& c : soft.contacts()) {
        const auto g = gap_gradient(soft.packing(), c.contact);
        for (int a = 0; a < g.count; ++a) {
            for (int b = 0; b < g.count; ++b) {
                springs(g.coordinate[static_cast<std::size_t>(a)], g.coordinate[static_cast<std::size_t>(b)]) +=
                    g.value[static_cast<std::size_t>(a)] * g.value[static_cast<std::size_t>(b)];
            }
        }
    }
    for (Eigen::Index w = springs.rows() - 2; w < springs.rows(); ++w) { // walls are heavier
        springs.row(w) /= std::sqrt(std::sqrt(30.0));
        springs.col(w) /= std::sqrt(std::sqrt(30.0));
    }
    const double highest = std::sqrt(springs.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
    BOOST_TEST(soft.time_step() * highest <= 0.8);
    BOOST_TEST(soft.time_step() * highest >= 0.25); // and not wastefully so
}

BOOST_AUTO_TEST_CASE(forces_of_a_packing_converge_as_the_inverse_of_the_stiffness) {
    const State state = prepared(30, 1);
    const auto rigid = required(inspect_vertex(state));
    BOOST_REQUIRE(rigid.equilibrium);
    std::vector<double> error;
    for (const double kappa : {1e4, 1e5, 1e6}) {
        error.push_back(force_error(state, rigid.forces, kappa));
        BOOST_TEST_MESSAGE("kappa " << kappa << ": " << error.back());
    }
    BOOST_TEST(error[0] > 1e-4);
    BOOST_TEST(std::log10(error[0] / error[1]) == 1.0, boost::test_tools::tolerance(0.2));
    BOOST_TEST(std::log10(error[1] / error[2]) == 1.0, boost::test_tools::tolerance(0.1));
}

BOOST_AUTO_TEST_CASE(a_load_that_has_no_potential_or_no_stress_is_refused) {
    State state = one_disk(1, 1);
    state.load.kind = LoadKind::true_stress;
    BOOST_CHECK_THROW(SoftGrains(state.packing, state.load), Error);
    state.load.kind = LoadKind::nominal;
    state.load.stress = {0, 0};
    BOOST_CHECK_THROW(SoftGrains(state.packing, state.load), Error);
    state.load.stress = {1, 1};
    BOOST_CHECK_THROW(SoftGrains(state.packing, state.load, at_ratio(-1)), Error);
    BOOST_CHECK_NO_THROW(SoftGrains(state.packing, state.load));
}

BOOST_AUTO_TEST_SUITE_END()
