#include "motion/acceleration.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>

using namespace isostat;

BOOST_AUTO_TEST_SUITE(motion)

namespace {

/// Iterations until x <- x + y(x), y = A (1 - x) with eigenvalues of 1 - A as given, is at its fixed point.
int iterations(const std::vector<double>& rates, bool accelerated) {
    std::vector<double> x(rates.size(), 0.0);
    std::vector<double> y(rates.size());
    Acceleration acceleration;
    for (int k = 1; k < 1000; ++k) {
        double size = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            y[i] = (1 - rates[i]) * (1 - x[i]) + 0.01 * (1 - x[i]) * (1 - x[i]); // not quite linear
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

BOOST_AUTO_TEST_CASE(changes_that_repeat_each_other_do_no_harm) {
    BOOST_TEST(iterations(std::vector<double>(5, 0.3), true) < 12); // all changes are parallel
    BOOST_TEST(iterations(std::vector<double>(1, 0.0), true) < 12);
}

BOOST_AUTO_TEST_SUITE_END()
