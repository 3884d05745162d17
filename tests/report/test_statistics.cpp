#include "report/sphere_page.hpp"
#include "report/statistics.hpp"
#include "support/test.hpp"

using namespace isostat;

namespace {

EquilibriumRow row(int number, int previous, int segment, double ratio, double strain, int arcs) {
    EquilibriumRow r;
    r.number = number;
    r.previous = previous;
    r.segment = segment;
    r.ratio = ratio;
    r.strain2 = strain;
    r.arcs = arcs;
    return r;
}

/// Up twice, then back to 1 (one rearrangement and a stop inside an interval), then a branch down from 1.
const std::vector<EquilibriumRow> rows{row(0, -1, 0, 1.0, 0.0, 0),    row(1, 0, 0, 1.25, 0.5, 1),
                                       row(2, 1, 0, 1.75, 0.625, 3),  row(3, 2, 1, 1.5, 0.375, 2),
                                       row(4, 3, 1, 1.0, 0.375, 0),   row(5, 1, 2, 1.125, 0.25, 4),
                                       row(6, 5, 2, 1.0625, 0.125, 1)};

} // namespace

BOOST_AUTO_TEST_CASE(a_triaxial_test_has_logarithmic_strains_and_q_over_p) {
    Load load;
    load.dimension = 3;
    load.stress = {1, 1, 1};
    load.reference_length = {2, 2, 4};
    const auto of = [&](int number, double stress, std::vector<double> length) {
        EquilibriumRow r = row(number, number - 1, 0, 0, 0, 1);
        r.stress = stress;
        r.length = std::move(length);
        return r;
    };
    const std::vector<EquilibriumRow> two{of(0, 0, {2, 2, 4}), of(1, 0.25, {3, 2, 2})};
    load.follow({-1, -1, 2});
    std::vector<TriaxialPoint> points = triaxial_points(two, load);
    BOOST_TEST(points[1].p == 1);
    BOOST_TEST(points[1].q == 0.75);
    BOOST_TEST(points[1].axial == std::log(2.0));
    BOOST_TEST(points[1].volumetric == std::log(4.0 / 3), boost::test_tools::tolerance(1e-15));
    load.follow({1, 0, 0}); // one axis: its stress is what the rows have
    points = triaxial_points(two, load);
    BOOST_TEST(points[1].q == 1 - (0.25 + 1) / 2);
    const Chart chart = triaxial_chart(points, {"up"}, false);
    BOOST_TEST((chart.data.find("# up\n# number axial_strain volumetric_strain p q q/p sin_phi\n0 0 0 ") == 0),
               chart.data);
    const std::string page =
        sphere_page("a & @TABLE@", json::Json::array(), {true, points, two, {"<up>"}, load_words(load)});
    BOOST_TEST((page.find("<title>&lt;up&gt;</title>") != std::string::npos));
    BOOST_TEST((page.find("a &amp; @TABLE@") != std::string::npos));
}

BOOST_AUTO_TEST_CASE(stress_increments_are_between_two_rearrangements_of_one_segment) {
    const Increments increments = stress_increments(rows);
    BOOST_TEST((increments.loading == std::vector<double>{0.5}));
    BOOST_TEST((increments.unloading == std::vector<double>{0.0625}));
}

BOOST_AUTO_TEST_CASE(strain_increments_are_those_of_every_rearrangement) {
    const Increments increments = strain_increments(rows);
    BOOST_TEST((increments.loading == std::vector<double>{0.5, 0.125}));
    BOOST_TEST((increments.unloading == std::vector<double>{0.25, 0.25, 0.125}));
}

BOOST_AUTO_TEST_CASE(the_path_to_an_equilibrium_leaves_branches_out) {
    const auto numbers = [](int to) {
        std::vector<int> list;
        for (const EquilibriumRow& r : path_to(rows, to)) {
            list.push_back(r.number);
        }
        return list;
    };
    BOOST_TEST((numbers(4) == std::vector<int>{0, 1, 2, 3, 4}));
    BOOST_TEST((numbers(6) == std::vector<int>{0, 1, 5, 6}));
    BOOST_TEST((numbers(9).empty()));
}

BOOST_AUTO_TEST_CASE(the_complementary_distribution_counts_ties_once) {
    using Points = std::vector<std::pair<double, double>>;
    BOOST_TEST((complementary_distribution({3, 1, 2, 2}) == Points{{1, 1}, {2, 0.75}, {3, 0.25}}));
    BOOST_TEST((complementary_distribution({}) == Points{}));
}

BOOST_AUTO_TEST_CASE(a_histogram_integrates_to_the_share_inside) {
    const std::vector<double> values{0, 0.1, 0.5, 0.9, 1.0, 7};
    double sum = 0;
    for (const auto& [centre, density] : histogram(values, 0, 1, 4)) {
        sum += density * 0.25;
    }
    BOOST_TEST(sum == 5.0 / 6, boost::test_tools::tolerance(1e-15));
    BOOST_TEST(histogram(values, 0, 1, 4).front().first == 0.125);
    BOOST_TEST(histogram(values, 0, 1, 4).back().second == 2 / (6 * 0.25), boost::test_tools::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(a_histogram_whose_bins_have_no_width_keeps_its_values) {
    constexpr double tiny = 5e-324, huge = 1.7e308;
    for (const auto& [low, high] : {std::pair{0.0, tiny}, {tiny, tiny}, {-huge, huge}, {0.0, HUGE_VAL}}) {
        BOOST_TEST(histogram({low, high}, low, high, 4).size() == 4U);
    }
}
