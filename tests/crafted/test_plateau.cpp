// Counts of foreign packings against the gap threshold.

#include <isostat/crafted/inspection.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/preparation/preparation.hpp>

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <random>

namespace {

using namespace isostat::crafted;
using isostat::Packing;
using isostat::Verdict;

std::vector<double> decades(int from, int to) {
    std::vector<double> out;
    for (int e = 2 * from; e <= 2 * to; ++e) {
        out.push_back(std::pow(10.0, e / 2.0));
    }
    return out;
}

void shake(Packing<2>& packing, double size, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    for (double& x : packing.q) {
        x += size * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
    }
}

Packing<2> example(const std::string& name) {
    return approximate(read_packing(std::string(ISOSTAT_EXAMPLES) + "/packings/" + name).packing);
}

} // namespace

BOOST_AUTO_TEST_SUITE(crafted_plateau)

BOOST_AUTO_TEST_CASE(noise_moves_the_lower_end_of_the_plateau) {
    for (const double noise : {1e-9, 1e-6, 1e-3}) {
        Packing<2> packing = example("three_disks_and_a_rattler.toml");
        shake(packing, noise, 7);
        const Plateau answer = plateau(packing, decades(-12, -1));
        BOOST_REQUIRE_EQUAL(answer.ranges.size(), 1u);
        // Gaps of the eight contacts are within a few times the noise; the next gaps are of the order of the disks.
        BOOST_TEST(answer.ranges[0].first < 6 * noise);
        BOOST_TEST(answer.ranges[0].first > noise / 100);
        // The small disk on the floor is sqrt(1.64) - 1.2 away from both base disks: counted as contacts, these hold
        // it.
        BOOST_TEST(std::abs(answer.ranges[0].last - (std::sqrt(1.64) - 1.2)) < 6 * noise);
        BOOST_TEST(std::abs(answer.deepest_overlap) < 6 * noise);
        BOOST_TEST(answer.steps.back().backbone.hyperstaticity == 1);
        const PlateauStep& last = answer.steps[answer.steps.size() - 2];
        BOOST_TEST(last.rattlers == 1);
        BOOST_TEST(last.backbone.dof_count == 8);
        BOOST_TEST(last.backbone.contact_count == 8);
        BOOST_TEST(last.backbone.hyperstaticity == 0);
        BOOST_TEST(last.backbone.mechanisms == 0);
        BOOST_TEST((last.backbone.isostatic == Verdict::proved));
        BOOST_TEST((answer.steps.front().backbone.isostatic == Verdict::refuted));
    }
}

BOOST_AUTO_TEST_CASE(an_end_of_the_plateau_is_the_gap_that_closes_it) {
    // The top disk is given 1e-3 of room to each of two fixed stops: at a threshold above it h = 1, then 2.
    Packing<2> packing = example("three_disks.toml");
    const double root = std::sqrt(3.0);
    for (const double side : {-1.0, 1.0}) {
        packing.radius.push_back(0.25);
        packing.q.insert(packing.q.end() - 2, {2 + side * (1.25 + 1e-3), 1 + root});
    }
    packing.fixed = {0, 0, 0, 1, 1};
    shake(packing, 1e-7, 3);
    const Plateau answer = plateau(packing, decades(-9, -2));
    BOOST_REQUIRE_EQUAL(answer.ranges.size(), 1u);
    BOOST_TEST(answer.ranges[0].first < 1e-6);
    BOOST_TEST(std::abs(answer.ranges[0].last - 1e-3) < 1e-6);
    BOOST_TEST(answer.steps.back().backbone.hyperstaticity == 2);
    BOOST_TEST((answer.steps.back().backbone.isostatic == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(a_lattice_has_no_plateau) {
    Packing<2> packing = example("triangular_patch_3x3.toml");
    shake(packing, 1e-8, 5);
    const Plateau answer = plateau(packing, {1e-6, 1e-5, 1e-4, 1e-3});
    BOOST_TEST(answer.ranges.empty());
    for (const PlateauStep& step : answer.steps) {
        BOOST_TEST(step.backbone.hyperstaticity == 5);
        BOOST_TEST(step.backbone.mechanisms == 0);
    }
}

BOOST_AUTO_TEST_CASE(counts_agree_with_the_exact_inspection_of_the_examples) {
    for (const char* name : {"two_disks.toml", "three_disks.toml", "square_lattice_4.toml", "apollonian.toml",
                             "triangular_patch_2x3.toml"}) {
        const ExactPacking exact = read_packing(std::string(ISOSTAT_EXAMPLES) + "/packings/" + name).packing;
        const auto inspection = inspect(exact);
        BOOST_REQUIRE(inspection.ok());
        const Plateau answer = plateau(approximate(exact), {1e-12});
        BOOST_TEST_CONTEXT(name) {
            BOOST_TEST(answer.steps[0].backbone.rank == inspection.value().rank);
            BOOST_TEST(answer.steps[0].backbone.hyperstaticity == inspection.value().hyperstaticity);
            BOOST_TEST(answer.steps[0].backbone.mechanisms == inspection.value().mechanisms);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_prepared_packing_with_noise_is_isostatic_over_decades) {
    isostat::PreparationOptions options;
    options.disks = 100;
    options.seed = 4;
    isostat::PreparationReport<2> report;
    const auto state = isostat::prepare<2>(options, report);
    BOOST_REQUIRE(state.ok());
    Packing<2> packing = state.value().packing;
    shake(packing, 1e-9, 9);
    const Plateau answer = plateau(packing, decades(-11, -1));
    BOOST_REQUIRE(!answer.ranges.empty());
    BOOST_TEST_MESSAGE("isostatic from " << answer.ranges[0].first << " to " << answer.ranges[0].last);
    BOOST_TEST(answer.ranges[0].first < 1e-8);
    BOOST_TEST(answer.ranges[0].last > 1e-6);
    for (const PlateauStep& step : answer.steps) {
        if (step.backbone.isostatic == Verdict::proved) {
            BOOST_TEST(step.rattlers == report.rattlers);
            BOOST_TEST(step.backbone.contact_count == 2 * (100 - report.rattlers) + 2);
        }
    }
}

BOOST_AUTO_TEST_SUITE_END()
