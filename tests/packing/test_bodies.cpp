// Rigid bodies of several disks: what bars connect, and the area of a union.
#include "packing/bodies.hpp"
#include "support/test.hpp"

#include <isostat/core/error.hpp>

using isostat::Bodies;
using isostat::Error;
using isostat::Packing;

namespace {

constexpr double pi = std::numbers::pi;

/// Rows x, y, radius in a box of side 100.
Packing bodies_of(const std::vector<std::array<double, 3>>& rows, std::vector<isostat::Bar> bars) {
    Packing p;
    for (const auto& [x, y, r] : rows) {
        p.radius.push_back(r);
        p.q.insert(p.q.end(), {x, y});
    }
    p.q.insert(p.q.end(), {100.0, 100.0});
    p.bars = std::move(bars);
    return p;
}

double area_of(const Packing& p) {
    return p.solid_fraction() * 1e4;
}

/// What two circles of one radius have in common, of centres d apart.
double lens(double r, double d) {
    return 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d);
}

} // namespace

BOOST_AUTO_TEST_CASE(what_bars_connect_is_one_body) {
    const Packing p = bodies_of({{10, 10, 1}, {20, 10, 1}, {30, 10, 1}, {40, 10, 1}, {50, 10, 1}},
                                {{0, 3, 30}, {1, 2, 10}, {2, 4, 20}, {1, 4, 30}});
    const Bodies bodies(p);
    BOOST_TEST(bodies.count() == 2);
    BOOST_TEST(bodies.of(3) == 0);
    BOOST_TEST(bodies.of(4) == 1);
    BOOST_TEST(bodies.members()[1] == (std::vector<int>{1, 2, 4}), boost::test_tools::per_element());
    BOOST_TEST(Bodies(bodies_of({{1, 1, 1}, {3, 1, 1}}, {})).count() == 2);
}

BOOST_AUTO_TEST_CASE(a_union_counts_once_what_members_share) {
    BOOST_TEST(std::abs(area_of(bodies_of({{10, 10, 1}, {11, 10, 1}}, {{0, 1, 1}})) - (2 * pi - lens(1, 1))) < 1e-9);
    BOOST_TEST(std::abs(area_of(bodies_of({{10, 10, 2}, {10.5, 10, 1}}, {{0, 1, 0.5}})) - 4 * pi) < 1e-9); // inside
    BOOST_TEST(std::abs(area_of(bodies_of({{10, 10, 2}, {14, 10, 1}}, {{0, 1, 4}})) - 5 * pi) < 1e-9);     // apart
    const Packing same = bodies_of({{10, 10, 2}, {10, 10, 2}}, {{0, 1, 1}}); // on each other
    BOOST_TEST(std::abs(area_of(same) - 4 * pi) < 1e-9);
}

BOOST_AUTO_TEST_CASE(two_spheres_count_once_what_they_share) {
    Packing p;
    p.dimension = p.cell.dimension = 3;
    p.walls = isostat::Walls::box(3);
    p.radius = {1, 1};
    p.q = {10, 10, 10, 11, 10, 10, 100, 100, 100};
    p.bars = {{0, 1, 1}};
    // A lens of two caps of height 1/2: 2 pi (1/4) (3 - 1/2) / 3.
    BOOST_TEST(std::abs(p.solid_fraction() * 1e6 - (8 * pi / 3 - 5 * pi / 12)) < 1e-9);
    p.q[3] = 10; // on each other
    BOOST_TEST(std::abs(p.solid_fraction() * 1e6 - 4 * pi / 3) < 1e-9);
    p.q[3] = 13;
    BOOST_TEST(std::abs(p.solid_fraction() * 1e6 - 8 * pi / 3) < 1e-9);
}

BOOST_AUTO_TEST_CASE(the_area_of_a_union_is_that_of_points_on_a_grid) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int sample = 0; sample < 20; ++sample) {
        std::vector<std::array<double, 3>> rows;
        for (int k = 0; k < 4; ++k) {
            rows.push_back({10 + 2 * uniform(random), 10 + 2 * uniform(random), 0.3 + uniform(random)});
        }
        constexpr double step = 0.005;
        int inside = 0;
        for (double x = 8; x < 14; x += step) {
            for (double y = 8; y < 14; y += step) {
                inside += std::any_of(rows.begin(), rows.end(),
                                      [&](const auto& d) { return std::hypot(d[0] - x, d[1] - y) < d[2]; })
                              ? 1
                              : 0;
            }
        }
        const Packing p = bodies_of(rows, {{0, 1, 1}, {0, 2, 1}, {1, 2, 1}, {1, 3, 1}, {2, 3, 1}});
        BOOST_TEST(std::abs(area_of(p) - inside * step * step) < 0.03);
    }
}

BOOST_AUTO_TEST_CASE(bars_that_make_no_rigid_body_are_refused) {
    const std::vector<std::array<double, 3>> three{{10, 10, 1}, {12, 10, 1}, {11, 12, 1}};
    const auto refused = [&](const std::vector<isostat::Bar>& bars) {
        BOOST_CHECK_THROW(isostat::validate(bodies_of(three, bars), "bars"), Error);
    };
    refused({{0, 1, 2}, {1, 2, 2}});                       // a bar is missing
    refused({{0, 1, 2}, {0, 1, 2}, {0, 2, 2}, {1, 2, 2}}); // twice
    refused({{1, 0, 2}});
    refused({{0, 0, 2}});
    refused({{0, 3, 2}});
    refused({{0, 1, 0}});
    refused({{0, 1, std::nan("")}});
    refused({{1, 2, 2}, {0, 1, 2}, {0, 2, 2}}); // not in order
    BOOST_CHECK_NO_THROW(isostat::validate(bodies_of(three, {{0, 1, 2}, {0, 2, 2}, {1, 2, 2}}), "bars"));
    BOOST_CHECK_NO_THROW(isostat::validate(bodies_of(three, {{0, 1, 2}}), "bars"));
    BOOST_CHECK_THROW(isostat::require_single_grains(bodies_of(three, {{0, 1, 2}}), "file", "this"), Error);
}
