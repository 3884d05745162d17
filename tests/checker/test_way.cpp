// Tubes, gaps and power along a curve that is known: a disk that rolls on a fixed one.
#include "checker/gap_course.hpp"
#include "checker/power_course.hpp"
#include "checker/tube.hpp"
#include "support/crafted.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <random>

using namespace isostat;
using namespace isostat::checker;

namespace {

/// Disk 0 (radius 1) at an angle above the fixed disk 1 (radius 1, at 10, 10), and disk 2 fixed somewhere.
Moving rolling(double angle, double x, double y) {
    Moving moving;
    moving.state = crafted::in_box({{1, 10 + 2 * std::cos(angle), 10 + 2 * std::sin(angle)}, {1, 10, 10}, {0.5, x, y}},
                                   30, 30, 1, 1, {});
    moving.state.packing.walls = Walls<2>::none();
    moving.state.packing.fixed = {0, 1, 1};
    moving.kept = {crafted::pair(0, 1)};
    moving.coordinates = {0, 1};
    moving.moves.assign(8, false);
    moving.moves[0] = moving.moves[1] = true;
    moving.loose.assign(8, false);
    return moving;
}

} // namespace

BOOST_AUTO_TEST_SUITE(checker)

BOOST_AUTO_TEST_CASE(bounds_hold_the_exact_results_of_random_operations) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-3, 3);
    for (int k = 0; k < 2000; ++k) {
        const double a = number(random);
        const double b = number(random);
        const double c = number(random);
        const Bounds found = Bounds(a) * b - Bounds(c) * c + Bounds(a) * 3.0;
        const Rational exact = Rational(a) * Rational(b) - Rational(c) * Rational(c) + 3 * Rational(a);
        BOOST_TEST((Rational(found.lower) <= exact && exact <= Rational(found.upper)));
    }
    BOOST_TEST(!(Bounds(1e308) * 1e308).negative());
    BOOST_TEST(std::isinf((Bounds(0, std::numeric_limits<double>::infinity()) * Bounds(-1, 0)).size()));
}

BOOST_AUTO_TEST_CASE(a_tube_holds_the_circle_on_which_a_disk_rolls) {
    for (const double angle : {0.3, 1.2, 2.0, 4.0}) {
        const Moving moving = rolling(angle, 25, 25);
        const bool x_is_fast = std::abs(std::sin(angle)) > std::abs(std::cos(angle));
        for (const int direction : {1, -1}) {
            auto tube = Tube::make(moving, moving.state.packing.q, x_is_fast ? 0 : 1, direction);
            BOOST_REQUIRE(tube);
            BOOST_REQUIRE(tube->prove());
            BOOST_TEST(tube->reach() > 0.05);
            BOOST_TEST(tube->radius() < 1e-12);
            for (double s = -tube->reach(); s < tube->reach(); s += tube->reach() / 16) {
                double error = 0;
                const std::vector<double> p = tube->point(s, error);
                // The point of the circle with the same coordinate in the row.
                const std::size_t row = x_is_fast ? 0 : 1;
                const std::size_t other = 1 - row;
                const double off = p[row] - 10;
                const double side = tube->centre()[other] > 10 ? 1 : -1;
                const double exact = 10 + side * std::sqrt(4 - off * off);
                BOOST_TEST(std::abs(exact - p[other]) <= tube->radius() + error + 1e-14);
                const double slope = -side * off / std::sqrt(4 - off * off) * direction;
                const Bounds found = tube->slope(static_cast<int>(other), s);
                BOOST_TEST((found.lower - 1e-14 <= slope && slope <= found.upper + 1e-14));
            }
        }
    }
}

// On the way from 1.2 to 1.2 + reach, disk 2 stands on the circle of radius 2 + 1/2 +- d around the way: touched or
// not.
BOOST_AUTO_TEST_CASE(a_gap_that_closes_on_the_way_is_seen_and_one_that_does_not_is_proved) {
    const double start = 1.2;
    const double there = 1.19; // disk 0 passes below disk 2 at this angle
    for (const double off : {-1e-3, -1e-6, -1e-9, 1e-9, 1e-6, 1e-3}) {
        const double distance = 2 + 1.5 + off;
        const Moving moving = rolling(start, 10 + distance * std::cos(there), 10 + distance * std::sin(there));
        auto tube = Tube::make(moving, moving.state.packing.q, 0, 1);
        BOOST_REQUIRE(tube);
        BOOST_REQUIRE(tube->prove());
        const double end = 2 * std::cos(there - 0.01) - 2 * std::cos(start);
        BOOST_REQUIRE(end < tube->reach());
        GapCourses gaps(moving, {crafted::pair(0, 1)}, {ContactKind::held, 0, 0});
        BOOST_TEST(gaps.look(*tube, 0, end) == (off > 0), off);
    }
}

BOOST_AUTO_TEST_CASE(the_power_is_positive_until_the_load_stands_on_the_curve) {
    const double start = 0.6;
    const Moving moving = rolling(start, 25, 25);
    Pushing load;
    load.fixed.assign(8, Bounds(0));
    const double turn = 0.58; // the load points away from disk 1 at this angle
    load.fixed[0] = std::cos(turn);
    load.fixed[1] = std::sin(turn);
    auto tube = Tube::make(moving, moving.state.packing.q, 1, -1);
    BOOST_REQUIRE(tube);
    BOOST_REQUIRE(tube->prove());
    const double s = 2 * (std::sin(start) - std::sin(turn));
    BOOST_REQUIRE(s * 1.01 < tube->reach());
    BOOST_TEST(power_is_positive(load, moving, *tube, 0, s * 0.999));
    BOOST_TEST(!power_is_positive(load, moving, *tube, 0, s * 1.001));
}

BOOST_AUTO_TEST_SUITE_END()
