// Tubes against a curve that is known: the centre of a unit disk on a fixed one moves on the circle of radius 2.
#include "motion/curve_piece.hpp"

#include <isostat/verified/inverse_bound.hpp>

#include <boost/test/unit_test.hpp>

#include <cmath>

using namespace isostat;

namespace {

/// Disk 1 free at `angle` on disk 0, which is fixed; `axis` of disk 1 in the free row.
struct OnCircle {
    Packing<2> packing;
    std::optional<IsostaticStructure<2>> structure;
    std::optional<Factorisation> factorisation;
    std::optional<KeptCurve<2>> curve;
    double sigma = 0;

    OnCircle(double angle, int axis) {
        packing.walls = Walls<2>::none();
        packing.radius = {1, 1};
        packing.q = {0, 0, 2 * std::cos(angle), 2 * std::sin(angle), 0, 0};
        packing.fixed = {1, 0};
        snap_to_grid(packing);
        const std::vector<Contact> contacts{{ContactKind::disk_disk, 0, 1}, {ContactKind::held, 2 + axis, 0}};
        auto proved = IsostaticStructure<2>::prove(packing, contacts);
        BOOST_REQUIRE(proved.ok());
        structure.emplace(std::move(proved.value()));
        factorisation.emplace(*structure);
        InverseBoundCache cache;
        sigma = bound_inverse(*structure, *factorisation, cache).sigma_min;
        curve.emplace(packing, contacts, 1, 0.0);
    }
    CurvePiece<2> piece() { return {*curve, packing, *structure, *factorisation, sigma, 1}; }
};

} // namespace

BOOST_AUTO_TEST_SUITE(motion)

BOOST_AUTO_TEST_CASE(the_true_curve_lies_in_the_tube_and_its_tangent_within_the_bound) {
    for (const double angle : {0.3, 0.8, 1.2, 2.5}) {
        OnCircle on(angle, 0);
        CurvePiece<2> piece = on.piece();
        const double h = 0.5 * piece.natural_reach();
        BOOST_TEST_REQUIRE(piece.prove(h));
        BOOST_TEST(piece.radius() < 1e-13);
        BOOST_TEST(piece.unique() > 1e3 * piece.radius());
        for (int k = -10; k <= 10; ++k) {
            const double s = 0.1 * k * h;
            const auto p = piece.point(s);
            const auto v = piece.slope(s);
            // x = that of p, on the circle about disk 0.
            const long double x = p[2];
            const long double y = std::sqrt(4 - x * x);
            const double rounding = 1e-15;
            BOOST_TEST(std::abs(static_cast<double>(y - p[3])) <= piece.radius() + rounding);
            BOOST_TEST(std::abs(static_cast<double>(-x / y * v[2] - v[3])) <= piece.slope_error() + rounding);
        }
    }
}

BOOST_AUTO_TEST_CASE(no_tube_is_proved_across_a_point_where_the_row_turns) {
    // x = 2 cos(angle) has its largest value at angle 0; s runs like the faster coordinate y, 0.1 away from there.
    OnCircle on(0.05, 0);
    CurvePiece<2> piece = on.piece();
    const double ahead = on.packing.q[3];
    BOOST_TEST(piece.natural_reach() < ahead);
    for (const double share : {1.001, 1.5, 4.0}) {
        BOOST_TEST(!piece.prove(share * ahead));
    }
    BOOST_TEST(piece.prove(0.2 * piece.natural_reach()));
    OnCircle other(0.05, 1); // y does not turn there
    CurvePiece<2> upward = other.piece();
    BOOST_TEST(upward.prove(0.12));
    BOOST_TEST(upward.slope(-0.12)[2] * upward.slope(0.12)[2] < 0); // x does
}

BOOST_AUTO_TEST_CASE(points_are_located_on_their_own_curve_only) {
    OnCircle on(0.8, 0);
    CurvePiece<2> piece = on.piece();
    BOOST_TEST_REQUIRE(piece.prove(0.5 * piece.natural_reach()));
    const double s = 0.3 * piece.reach();
    std::vector<double> x = piece.point(s);
    x[3] = std::sqrt(4 - x[2] * x[2]);
    const auto place = piece.locate(x, 1e-15);
    BOOST_TEST_REQUIRE(place.has_value());
    BOOST_TEST(std::abs(place->s - s) <= place->slack);
    BOOST_TEST(place->slack < 1e-12);
    x[3] = -x[3]; // on the circle, at the same x, on the other side
    BOOST_TEST(!piece.locate(x, 1e-15).has_value());
    x[3] = -x[3];
    BOOST_TEST(!piece.locate(x, 1.0).has_value()); // nobody knows where
    x = piece.point(piece.reach() * 1.01);
    BOOST_TEST(!piece.locate(x, 1e-15).has_value()); // beyond what was proved
}

BOOST_AUTO_TEST_CASE(a_bound_of_the_inverse_that_is_not_there_proves_no_tube) {
    OnCircle on(0.8, 0);
    on.sigma = 0;
    BOOST_TEST(!on.piece().prove(1e-6));
}

BOOST_AUTO_TEST_SUITE_END()
