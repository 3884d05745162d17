// Estimates against published or closed-form values, and intervals against the share of cases that they must cover.
#include "oracle/random.hpp"
#include "paper/inference.hpp"
#include "support/test.hpp"

using namespace isostat;
using boost::test_tools::tolerance;

namespace {

constexpr double level = 0.95;

bool covers(const Estimate& e, double truth) {
    return e.low <= truth && truth <= e.high;
}

/// x with density ~ x^-a on [low, high], by inversion.
double draw_power_law(oracle::Random& random, double a, double low, double high) {
    const double p = random.real();
    if (a == 1) {
        return low * std::pow(high / low, p);
    }
    const double b = 1 - a;
    return std::pow(std::pow(low, b) + p * (std::pow(high, b) - std::pow(low, b)), 1 / b);
}

} // namespace

BOOST_AUTO_TEST_CASE(means_have_the_interval_of_student) {
    const Estimate e = mean_with_t(std::vector<double>{1, 2, 3, 4}, level);
    BOOST_TEST(e.value == 2.5);
    BOOST_TEST(e.high - e.value == 3.182446305 * std::sqrt(5.0 / 3 / 4), tolerance(1e-8)); // t of 3 degrees, tables
    BOOST_TEST(e.value - e.low == e.high - e.value, tolerance(1e-14));
    BOOST_TEST(std::isnan(mean_with_t(std::vector<double>{1}, level).low));
    BOOST_TEST(std::isnan(mean_with_t(std::vector<double>{}, level).value));
}

BOOST_AUTO_TEST_CASE(rates_and_proportions_have_the_exact_intervals) {
    const Estimate ten = poisson_rate(10, 2, level); // Garwood 1936: 4.795 to 18.39 for a count of 10
    BOOST_TEST(ten.value == 5.0);
    BOOST_TEST(ten.low == 4.79539 / 2, tolerance(1e-5));
    BOOST_TEST(ten.high == 18.39036 / 2, tolerance(1e-5));
    BOOST_TEST(poisson_rate(0, 1, level).low == 0.0);
    BOOST_TEST(poisson_rate(0, 1, level).high == -std::log(0.025), tolerance(1e-12));
    const Estimate none = proportion(0, 20, level); // 1 - 0.025^(1/20)
    BOOST_TEST(none.low == 0.0);
    BOOST_TEST(none.high == 1 - std::pow(0.025, 0.05), tolerance(1e-10));
    BOOST_TEST(proportion(20, 20, level).low == std::pow(0.025, 0.05), tolerance(1e-10));
}

BOOST_AUTO_TEST_CASE(the_exponent_of_a_truncated_power_law_comes_back) {
    oracle::Random random(5);
    for (const double a : {0.5, 1.0, 1.46, 2.5}) {
        std::vector<double> values;
        for (int i = 0; i < 20000; ++i) {
            values.push_back(draw_power_law(random, a, 1e-6, 1e-2));
        }
        const double found = truncated_power_law(values, 1e-6, 1e-2);
        BOOST_TEST(std::abs(found - a) < 0.04, "found " << found << " for " << a); // about four standard errors
        BOOST_TEST(power_law_distance(values, 1e-6, 1e-2, found) < 0.015);
        BOOST_TEST(power_law_distance(values, 1e-6, 1e-2, a + 0.3) > 0.05);
        values.push_back(1); // outside
        BOOST_TEST(truncated_power_law(values, 1e-6, 1e-2) == found);
    }
    // Closed form for an infinite range (Hill): 1 + n / sum log(x / low).
    const std::vector<double> few{2, 4, 8, 3};
    const double hill = 1 + 4 / (std::log(2.0) + std::log(4.0) + std::log(8.0) + std::log(3.0));
    BOOST_TEST(truncated_power_law(few, 1, 1e300) == hill, tolerance(1e-6));
    BOOST_TEST(std::isnan(truncated_power_law(std::vector<double>{2, 2}, 1, 3)));
    BOOST_TEST(std::isnan(truncated_power_law(std::vector<double>{5, 6}, 1, 3)));
}

BOOST_AUTO_TEST_CASE(exponential_values_pass_and_others_do_not) {
    oracle::Random random(9);
    std::vector<double> exponential, uniform;
    for (int i = 0; i < 300; ++i) {
        exponential.push_back(-3 * std::log1p(-random.real()));
        uniform.push_back(random.real());
    }
    BOOST_TEST(exponential_p_value(exponential, 500, 1) > 0.02);
    BOOST_TEST(exponential_p_value(uniform, 500, 1) == 0.0);
    BOOST_TEST(exponential_p_value(exponential, 500, 1) == exponential_p_value(exponential, 500, 1));
    // One value, mean 1: the distance is 1 - 1/e at it, or 1/e after it.
    BOOST_TEST(exponential_distance(std::vector<double>{7}) == 1 - std::exp(-1.0), tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(a_line_is_found_with_its_weights) {
    const std::vector<double> x{0, 1, 2};
    const Line exact = fit_line(x, std::vector<double>{1, 3, 5}, std::vector<double>{1, 7, 2});
    BOOST_TEST(exact.slope == 2.0, tolerance(1e-14));
    BOOST_TEST(exact.intercept == 1.0, tolerance(1e-14));
    const Line two = fit_line(x, std::vector<double>{1, 3, 99}, std::vector<double>{1, 1, 0});
    BOOST_TEST(two.slope == 2.0, tolerance(1e-14));
    BOOST_TEST(
        std::isnan(fit_line(std::vector<double>{1, 1}, std::vector<double>{1, 2}, std::vector<double>{1, 1}).slope));
}

BOOST_AUTO_TEST_CASE(bootstrap_intervals_cover_about_as_often_as_they_say) {
    // Samples of three values that are equal to each other: only the sample counts.
    oracle::Random random(3);
    int covered = 0;
    constexpr int trials = 300;
    constexpr std::size_t samples = 25;
    for (int t = 0; t < trials; ++t) {
        std::vector<double> value(samples);
        std::ranges::generate(value, [&] { return random.real() + random.real() + random.real(); });
        const auto mean = [&](const std::vector<std::vector<std::size_t>>& chosen) {
            double sum = 0;
            for (const std::size_t s : chosen[0]) {
                sum += 3 * value[s];
            }
            return sum / (3.0 * static_cast<double>(chosen[0].size()));
        };
        const Estimate e = bootstrap({samples}, mean, 400, 17, level);
        covered += covers(e, 1.5) ? 1 : 0;
        BOOST_TEST(covers(e, e.value));
    }
    BOOST_TEST(covered > 0.88 * trials);
    BOOST_TEST(covered < 0.99 * trials);
}

BOOST_AUTO_TEST_CASE(bootstrap_draws_within_the_groups_and_repeats_itself) {
    const auto statistic = [](const std::vector<std::vector<std::size_t>>& chosen) {
        BOOST_TEST(chosen.size() == 2U);
        BOOST_TEST(chosen[0].size() == 3U);
        BOOST_TEST(chosen[1].size() == 8U);
        double sum = 0;
        for (std::size_t g = 0; g < 2; ++g) {
            for (const std::size_t s : chosen[g]) {
                BOOST_REQUIRE(s < chosen[g].size());
                sum += static_cast<double>((g + 1) * s);
            }
        }
        return sum;
    };
    const Estimate a = bootstrap({3, 8}, statistic, 100, 4, level);
    const Estimate b = bootstrap({3, 8}, statistic, 100, 4, level);
    BOOST_TEST(a.value == 3 + 56.0);
    BOOST_TEST(a.low == b.low);
    BOOST_TEST(a.high == b.high);
    BOOST_TEST(a.low < a.value);
    BOOST_TEST(a.value < a.high);
    BOOST_TEST(std::isnan(bootstrap(
                              {3, 1}, [](auto&) { return 1.0; }, 10, 4, level)
                              .low)); // one sample says nothing
    BOOST_TEST(std::isnan(bootstrap(
                              {3}, [](auto&) { return std::nan(""); }, 10, 4, level)
                              .low));
}
