#include "motion/chord.hpp"
#include "support/test.hpp"

using namespace isostat;

namespace {

/// Iterations until x <- x + y(x), y = A (1 - x) with eigenvalues of 1 - A as given, is at its fixed point.
int iterations(const std::vector<double>& rates, bool accelerated, double curvature = 0.01) {
    std::vector<double> x(rates.size(), 0.0);
    std::vector<double> y(rates.size());
    Acceleration acceleration;
    for (int k = 1; k < 1000; ++k) {
        double size = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            y[i] = (1 - rates[i]) * (1 - x[i]) + curvature * (1 - x[i]) * (1 - x[i]);
            size = std::max(size, std::abs(y[i]));
        }
        if (size < 1e-13) {
            return k;
        }
        if (accelerated) {
            acceleration.improve(y);
        }
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] += y[i];
        }
    }
    return 1000;
}

} // namespace

BOOST_AUTO_TEST_CASE(few_slow_directions_cost_few_iterations_when_accelerated) {
    std::vector<double> rates(200, 0.01);
    rates[17] = 0.5;
    rates[90] = -0.4;
    const int plain = iterations(rates, false);
    const int accelerated = iterations(rates, true);
    BOOST_TEST(plain > 25);
    BOOST_TEST(accelerated < plain / 2);
}

// Each change removes one of the rates, as each direction of a Krylov method does.
BOOST_AUTO_TEST_CASE(a_linear_iteration_with_three_rates_ends_after_three_changes) {
    for (const double slow : {0.3, 0.6, 0.9}) {
        std::vector<double> rates(30, 0.01);
        rates[3] = slow;
        rates[20] = -0.7 * slow;
        BOOST_TEST(iterations(rates, true, 0) <= 6, "rate " << slow << ": " << iterations(rates, true, 0));
    }
}

BOOST_AUTO_TEST_CASE(changes_that_repeat_each_other_do_no_harm) {
    for (std::size_t n = 1; n <= 7; ++n) {
        for (int percent = 0; percent < 60; ++percent) { // all changes are parallel
            const double rate = 0.01 * percent;
            const int count = iterations(std::vector<double>(n, rate), true);
            BOOST_TEST(count < 12, n << " numbers, rate " << rate << ": " << count);
        }
    }
}
