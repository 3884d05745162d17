// Preparations that nobody planned for: from the loose start to the proof, or to an honest end.
#include "extreme/catalogue.hpp"

using namespace isostat;

namespace {

PreparationOptions disks(int count, double smallest = 1, double largest = 2) {
    return {.disks = count, .diameters = {smallest, largest}};
}

} // namespace

BOOST_AUTO_TEST_CASE(size_ratios_up_to_ten_thousand) {
    for (const double ratio : {1.5, 10.0, 100.0, 1e3, 1e4}) {
        extreme::prepared("size ratio", fmt::format("diameters in [1, {:g}]", ratio), disks(60, 1, ratio));
        // Sizes of every decade: log-uniform, largest first as far as the order matters.
        PreparationOptions options;
        for (int i = 0; i < 40; ++i) {
            options.radii.push_back(std::pow(ratio, i / 39.0));
        }
        extreme::prepared("size ratio", fmt::format("log-spaced radii, ratio {:g}", ratio), options);
    }
}

BOOST_AUTO_TEST_CASE(nearly_crystalline_radii) {
    for (const double width :
         {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15}) {
        extreme::prepared("nearly equal radii", fmt::format("diameters in [1, 1 + {:.0e}]", width),
                          disks(40, 1, 1 + width));
    }
    extreme::prepared("equal radii", "40 random equal disks", disks(40, 1, 1));
    extreme::prepared("equal radii", "7 random equal disks", disks(7, 1, 1));
}

BOOST_AUTO_TEST_CASE(boxes_that_are_a_thousand_times_longer_than_wide) {
    for (const double aspect : {1e-3, 1e-2, 1e-1, 10.0, 100.0, 1000.0}) {
        PreparationOptions options = disks(60);
        options.aspect = aspect;
        const auto state = extreme::prepared("long box", fmt::format("loose box 1 : {:g}", aspect), options);
        if (state && aspect >= 100) {
            BOOST_TEST(state->packing.length(1) > 10 * state->packing.length(0));
        }
    }
}

BOOST_AUTO_TEST_CASE(one_huge_disk_among_small_ones) {
    for (const double huge : {10.0, 100.0, 1e3, 1e4}) {
        PreparationOptions options{.radii = {huge}};
        for (int i = 0; i < 40; ++i) {
            options.radii.push_back(0.5 + 0.5 * std::fmod(i * 0.618033988749895, 1.0));
        }
        const std::string name = fmt::format("radius {:g} among 40 of 0.5 to 1", huge);
        extreme::prepared("one huge disk", name, options);
    }
}

BOOST_AUTO_TEST_CASE(stiffness_of_the_dynamics_up_to_1e8) {
    for (const double softness : {1e-3, 1e-5, 1e-7, 1e-8}) {
        PreparationOptions options = disks(60);
        options.softness = softness;
        extreme::prepared("stiff dynamics", fmt::format("stiffness / pressure = {:.0e}", 1 / softness), options);
    }
}

BOOST_AUTO_TEST_CASE(numbers_of_disks) {
    for (const int count : {1, 2, 3, 4, 10, 100, 1000}) {
        extreme::prepared("number of disks", fmt::format("{}", count), disks(count));
    }
}

BOOST_AUTO_TEST_CASE(five_thousand_disks, *boost::unit_test::label("slow")) {
    extreme::prepared("number of disks", "5000", disks(5000));
}

// Too long for every run of the tests: `tests/extreme/run --long`.
BOOST_AUTO_TEST_CASE(twenty_thousand_disks, *boost::unit_test::disabled()) {
    extreme::prepared("number of disks", "20000", disks(20000));
}
