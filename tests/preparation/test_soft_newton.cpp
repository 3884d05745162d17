// Newton steps for soft disks, judged by the forces of the dynamics, which are other code.
#include "../../src/preparation/soft_newton.hpp"
#include "support/test.hpp"
#include "support/threads.hpp"

using namespace isostat;
namespace room = isostat::preparation;

namespace {

/// Overlapping disks on a shaken lattice in a box a little too small for it.
Packing pressed(int side, double squeeze) {
    Packing packing;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            const int k = i * side + j;
            packing.radius.push_back(0.6 + 0.1 * std::sin(12.9898 * k));
            packing.q.push_back((1.4 * i + 0.75 + 0.1 * std::sin(78.233 * k)) * squeeze);
            packing.q.push_back((1.4 * j + 0.75 + 0.1 * std::cos(37.719 * k)) * squeeze);
        }
    }
    packing.q.push_back(1.4 * side * squeeze);
    packing.q.push_back(1.4 * side * squeeze);
    return packing;
}

/// What the dynamics say of a packing, which they leave as it is.
room::SoftMeasures judged(Packing packing, double pressure) {
    room::SoftDynamics dynamics(packing, false, nullptr, [](double) {});
    return dynamics.relax(pressure, 1e-12, 0);
}

} // namespace

BOOST_AUTO_TEST_CASE(newton_steps_end_where_the_dynamics_find_every_force_balanced) {
    for (const double squeeze : {0.9, 0.95}) {
        Packing packing = pressed(14, squeeze);
        room::SoftNewton newton(packing, nullptr);
        double volume = 0;
        for (const double pressure : {1e-3, 1e-4, 1e-5}) {
            const room::SoftMeasures before = judged(packing, pressure);
            BOOST_TEST(std::max(before.residual, before.pressure_error) > 0.5);
            const room::SoftMeasures made = newton.relax(pressure, 1e-6, 3000, [](double) {});
            BOOST_TEST(made.converged);
            BOOST_TEST(made.steps > 2);
            const room::SoftMeasures after = judged(packing, pressure);
            BOOST_TEST(after.residual < 2e-6);
            BOOST_TEST(after.pressure_error < 2e-6);
            BOOST_TEST(after.contacts == made.contacts);
            BOOST_TEST(after.overlap == made.overlap, boost::test_tools::tolerance(1e-6));
            BOOST_TEST(packing.length(0) * packing.length(1) > volume); // as the pressure falls
            volume = packing.length(0) * packing.length(1);
        }
    }
}

BOOST_AUTO_TEST_CASE(newton_steps_have_the_same_bits_for_any_number_of_threads_and_stop_when_asked,
                     *boost::unit_test::label("threads")) {
    const auto relaxed = [](int threads) {
        const Threads scope(threads);
        Packing packing = pressed(30, 0.9);
        room::SoftNewton newton(packing, nullptr);
        (void)newton.relax(1e-3, 1e-6, 20, [](double) {});
        return packing.q;
    };
    const auto one = relaxed(1);
    BOOST_TEST((one == relaxed(2)));
    BOOST_TEST((one != pressed(30, 0.9).q));
    std::atomic<bool> stop{true};
    Packing packing = pressed(10, 0.9);
    room::SoftNewton newton(packing, &stop);
    const room::SoftMeasures made = newton.relax(1e-3, 1e-6, 20, [](double) {});
    BOOST_TEST(made.interrupted);
    BOOST_TEST(made.steps == 0);
    BOOST_TEST((packing.q == pressed(10, 0.9).q));
}
