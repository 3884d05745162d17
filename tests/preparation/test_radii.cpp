// Laws of the radii: the shape of each, where it is cut, the same bits everywhere, laws without sense.

#include "support/bad_input.hpp"

#include <isostat/preparation/preparation.hpp>

namespace {

using namespace isostat;

constexpr int many = 20000;

DiameterLaw law_of(RadiiLaw kind) {
    DiameterLaw law{.kind = kind};
    return law;
}

/// Kolmogorov's distance between diameters and their distribution function; above 1.95 / sqrt(n) once in a thousand.
void follows(const DiameterLaw& law, const std::function<double(double)>& distribution) {
    std::vector<double> radii = draw_radii(law, many, 3);
    std::ranges::sort(radii);
    double distance = 0;
    for (int k = 0; k < many; ++k) {
        const double expected = distribution(2 * radii[static_cast<std::size_t>(k)]);
        distance = std::max({distance, std::abs(expected - static_cast<double>(k) / many),
                             std::abs(expected - static_cast<double>(k + 1) / many)});
    }
    BOOST_TEST(distance < 1.95 / std::sqrt(many));
    BOOST_TEST(2 * radii.front() >= law.smallest);
    BOOST_TEST(2 * radii.back() <= law.largest);
}

/// A distribution cut at the ends of the law.
std::function<double(double)> cut(const DiameterLaw& law, const std::function<double(double)>& whole) {
    return [=](double d) { return (whole(d) - whole(law.smallest)) / (whole(law.largest) - whole(law.smallest)); };
}

double normal(double z) {
    return std::erfc(-z / std::sqrt(2.0)) / 2;
}

} // namespace

BOOST_AUTO_TEST_CASE(radii_follow_their_law) {
    DiameterLaw law;
    follows(law, [](double d) { return d - 1; });
    for (const double deviation : {0.05, 0.2, 0.6}) {
        law = law_of(RadiiLaw::normal);
        law.deviation = deviation;
        law.smallest = 0.7;
        follows(law, cut(law, [&](double d) { return normal((d - 1) / deviation); }));
        law.kind = RadiiLaw::lognormal;
        follows(law, cut(law, [&](double d) { return normal(std::log(d) / deviation); }));
    }
    for (const double exponent : {-2.0, 0.0, 1.0, 1 + 0x1p-40, 3.0, 30.0}) {
        law = law_of(RadiiLaw::power);
        law.smallest = 0.5;
        law.largest = 4;
        law.exponent = exponent;
        const bool one = std::abs(exponent - 1) < 1e-9;
        follows(law, cut(law, [&](double d) { return one ? std::log(d) : std::pow(d, 1 - exponent); }));
    }
}

BOOST_AUTO_TEST_CASE(a_mixture_has_exact_shares) {
    DiameterLaw law = law_of(RadiiLaw::bidisperse);
    BOOST_TEST((draw_radii(law, 5, 1) == std::vector<double>{0.5, 0.5, 0.7, 0.7, 0.7}));
    law.fraction = 0.25;
    law.diameter = 2;
    law.ratio = 3;
    BOOST_TEST((draw_radii(law, 5, 9) == std::vector<double>{1, 1, 1, 1, 3}));
    BOOST_TEST((draw_radii(law_of(RadiiLaw::equal), 3, 1) == std::vector<double>{0.5, 0.5, 0.5}));
}

// From decimal arithmetic with 80 digits; every operation is rounded correctly, so no machine has another choice.
BOOST_AUTO_TEST_CASE(radii_have_the_same_bits_everywhere) {
    const auto third = [](RadiiLaw kind) { return draw_radii(law_of(kind), 3, 1)[2]; };
    BOOST_TEST(third(RadiiLaw::uniform) == 0x1.e3f789d9afdb6p-1);
    BOOST_TEST(third(RadiiLaw::lognormal) == 0x1.3a3f64cd7be4ep-1);
    BOOST_TEST(third(RadiiLaw::normal) == 0x1.347b22290a985p-1);
    BOOST_TEST(third(RadiiLaw::power) == 0x1.bc35746438a62p-1);
}

BOOST_AUTO_TEST_CASE(a_jitter_is_small_seeded_and_not_the_stream_of_the_radii) {
    const std::vector<double> radii(1000, 3.0);
    const std::vector<double> moved = with_jitter(radii, 1e-9, 1);
    BOOST_TEST((with_jitter(radii, 0, 1) == radii));
    BOOST_TEST((with_jitter(radii, 1e-9, 1) == moved));
    BOOST_TEST((with_jitter(radii, 1e-9, 2) != moved));
    const std::vector<double> uniform = draw_radii({}, 1000, 1);
    double low = 1, high = -1, common = 0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const double rho = (moved[i] / 3 - 1) / 1e-9;
        low = std::min(low, rho);
        high = std::max(high, rho);
        common += rho * (4 * uniform[i] - 3) / 1000; // both in [-1, 1): 1/3 were they the same
    }
    BOOST_TEST(low >= -1.000001);
    BOOST_TEST(low < -0.98);
    BOOST_TEST(high <= 1.000001);
    BOOST_TEST(high > 0.98);
    BOOST_TEST(std::abs(common) < 0.04);
    BOOST_TEST(moved[0] == 0x1.7ffffffe7df1fp+1); // as above, in decimal arithmetic
}

BOOST_AUTO_TEST_CASE(laws_without_sense_are_named) {
    const auto refused = [](RadiiLaw kind, const auto& change, const std::vector<std::string>& words) {
        DiameterLaw law = law_of(kind);
        change(law);
        expect_bad_input([&] { (void)draw_radii(law, 3, 1); }, words);
    };
    refused(RadiiLaw::uniform, [](auto& l) { l.smallest = 3; }, {"largest diameter is 2", "3"});
    refused(RadiiLaw::equal, [](auto& l) { l.diameter = 0; }, {"diameter is 0", "positive"});
    refused(RadiiLaw::bidisperse, [](auto& l) { l.ratio = -1; }, {"ratio is -1"});
    refused(RadiiLaw::bidisperse, [](auto& l) { l.fraction = 1.5; }, {"fraction is 1.5", "0 to 1"});
    refused(RadiiLaw::normal, [](auto& l) { l.deviation = 0; }, {"deviation is 0"});
    refused(RadiiLaw::normal, [](auto& l) { l.deviation = 1.01; },
            {"deviation is 1.01", "at most 1", "cut at 1 and 2"});
    refused(RadiiLaw::lognormal, [](auto& l) { l.deviation = 0.7; }, {"deviation is 0.7", "at most 0.693"});
    refused(RadiiLaw::lognormal, [](auto& l) { l.diameter = 0.9; }, {"diameter is 0.9", "from 1 to 2"});
    refused(RadiiLaw::power, [](auto& l) { l.exponent = HUGE_VAL; }, {"exponent is inf"});
    expect_bad_input([] { (void)draw_radii({}, 0, 1); }, {"number of disks is 0"});
}
