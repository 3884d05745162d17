// The bounds of the inverse against a dense inverse in long double: never below it, and not much above.
#include "checker/dense.hpp"
#include "checker/first_order.hpp"
#include "checker/forces.hpp"
#include "checker/inverse.hpp"
#include "checker/maker.hpp"
#include "checker/replay.hpp"
#include "checker/small_states.hpp"
#include "checker/vertex.hpp"
#include "oracle/pairs.hpp"
#include "support/scale.hpp"
#include "support/scratch.hpp"

using namespace isostat;

namespace {

void check_bounds(const State& state, CheckerArithmetic arithmetic) {
    const checker::Problem problem(state);
    const checker::Solver solver(problem);
    const checker::InverseBound bound = checker::bound_inverse(problem, solver, arithmetic);
    BOOST_REQUIRE(bound.found);
    const maker::Matrix inverse = dense::derivative(problem).inverse();
    const maker::Matrix sizes = inverse.cwiseAbs();
    const auto near = [](const checker::Rational& upper, maker::Real value) {
        // R is the inverse to a relative 1e-9 here, and the oracle to 1e-12.
        return upper.get_d() >= static_cast<double>(value) * (1 - 1e-9) &&
               upper.get_d() <= static_cast<double>(value) * (1 + 1e-9);
    };
    BOOST_TEST(near(bound.row_sum, sizes.rowwise().sum().maxCoeff()));
    BOOST_TEST(near(bound.column_sum_max, sizes.colwise().sum().maxCoeff()));
    maker::Real quadratic = 0;
    for (Eigen::Index k = 0; k < sizes.rows(); ++k) {
        maker::Real sum = 0;
        for (Eigen::Index l = 0; l < sizes.cols(); ++l) {
            sum += problem.rows[static_cast<std::size_t>(l)].quadratic ? sizes(k, l) : 0;
        }
        quadratic = std::max(quadratic, sum);
    }
    BOOST_TEST((near(bound.quadratic_sum, quadratic) || quadratic == 0));
    for (int l = 0; l < problem.contacts(); ++l) {
        BOOST_TEST(near(bound.column_sum[static_cast<std::size_t>(l)], sizes.col(l).sum()));
    }
    BOOST_TEST(bound.residual_row < 1e-9);
    BOOST_TEST(bound.residual_column < 1e-9);
}

void check_sharper(const State& state) {
    checker::Place place;
    BOOST_REQUIRE(!checker::make_place(state, place));
    const checker::Rational radius = place.evidence->vertex.radius;
    const std::vector<checker::Range> forces = place.evidence->forces;
    BOOST_TEST(radius > 0);
    BOOST_REQUIRE(!checker::sharpen(place, checker::usual_digits + 240));
    BOOST_TEST((place.evidence->vertex.radius < radius * checker::power_of_two(-200)));
    for (std::size_t l = 0; l < forces.size(); ++l) {
        const checker::Range& now = place.evidence->forces[l];
        BOOST_TEST((now.upper - now.lower <= (forces[l].upper - forces[l].lower) * checker::power_of_two(-200)));
        BOOST_TEST((now.lower <= forces[l].upper && now.upper >= forces[l].lower)); // of the same number
    }
}

} // namespace

BOOST_AUTO_TEST_CASE(more_digits_narrow_the_vertex_and_its_forces) {
    check_sharper(crafted::three_disks(1, 1.1, 1.3, 1, 1));
}

BOOST_AUTO_TEST_CASE(bounds_of_the_inverse_agree_with_a_dense_inverse) {
    for (const CheckerArithmetic arithmetic :
         {CheckerArithmetic::fixed64, CheckerArithmetic::gmp, CheckerArithmetic::rational}) {
        check_bounds(crafted::one_disk(1, 1), arithmetic);
        check_bounds(crafted::three_disks(1, 1.1, 1.3, 1, 1), arithmetic);
        check_bounds(small_states::with_a_rattler(), arithmetic);
        check_bounds(small_states::with_a_fixed_disk(), arithmetic);
        if (arithmetic != CheckerArithmetic::rational) {
            check_bounds(read_state(scratch::data("vertex100.txt")).state, arithmetic);
        }
    }
}

// A factorisation of another matrix must be noticed by the residual, whatever it is.
BOOST_AUTO_TEST_CASE(a_wrong_factorisation_proves_nothing) {
    const checker::Problem problem(crafted::three_disks(1, 1.1, 1.3, 1, 1));
    const checker::Problem other(crafted::three_disks(1, 1.4, 2.3, 1, 1));
    const checker::Solver wrong(other);
    BOOST_TEST(!checker::bound_inverse(problem, wrong, CheckerArithmetic::fixed64).found);
}

// K4 at the stored place itself: a useless factorisation does not lead to a better one. Rational numbers throughout.
BOOST_AUTO_TEST_CASE(a_vertex_is_found_where_K4_has_its_condition_and_nowhere_else) {
    using checker::Rational;
    const double h = 0x1p-5;
    for (const double target : {0.1, 0.5, 0.9, 0.99, 1.01, 1.1, 1.5, 1.9, 2.5}) { // of 2 kappa eta
        State state = small_states::between_two(h);
        const double row_sum = 1 / (h * 0.8); // about what K15 gives
        const double off = target / (16 * row_sum * row_sum);
        const double x = std::sqrt(4 - h * h + 2 * off);
        state.packing.q[0] = 2 - x;
        state.packing.q[2] = 2 + x;
        const checker::Problem problem(state);
        const checker::InverseBound inverse =
            checker::bound_inverse(problem, checker::Solver(problem), CheckerArithmetic::singular_value);
        BOOST_REQUIRE(inverse.found);
        Rational largest = 0;
        for (const std::size_t k : {0U, 2U}) {
            const Rational dx = Rational(state.packing.q[4]) - Rational(state.packing.q[k]);
            const Rational dy = Rational(state.packing.q[5]) - Rational(state.packing.q[k + 1]);
            largest = std::max<Rational>(largest, abs((dx * dx + dy * dy - 4) / 2));
        }
        const Rational kappa = 8 * inverse.quadratic_sum;
        const Rational eta = inverse.row_sum * largest;
        const checker::Problem flat(small_states::between_two(h / 64));
        const checker::TrueVertex vertex = checker::find_vertex(problem, checker::Solver(flat), inverse);
        BOOST_TEST(vertex.found == (2 * kappa * eta < 1), target);
        if (vertex.found) {
            BOOST_TEST((vertex.radius >= 2 * eta && vertex.radius <= 2 * eta * Rational(1.001)));
            BOOST_TEST((vertex.moved_most >= vertex.radius));
        }
    }
}

// The vertex may be anywhere in its enclosure, so a motion holds that of every point of it (K12); and not a hundred
// times more.
BOOST_AUTO_TEST_CASE(motions_hold_at_every_point_of_the_enclosure) {
    const State state = crafted::three_disks(1, 1.1, 1.3, 1, 1.5);
    checker::Evidence wide(state, CheckerArithmetic::fixed64);
    checker::Evidence point(state, CheckerArithmetic::fixed64);
    BOOST_REQUIRE(wide.vertex.found);
    const checker::Rational radius = checker::power_of_two(-12);
    wide.vertex.radius = radius;
    wide.vertex.moved_most += radius;
    wide.vertex.row_residual += wide.problem.row_curvature() * wide.inverse.quadratic_sum * radius;
    const std::vector<checker::Integer> middle = point.vertex.middle;
    checker::Rational farthest = 0; // of the way to an end
    std::mt19937_64 random(2);
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const checker::Velocities::Solution enclosed = checker::Velocities(wide).opening(l, 1);
        for (int sample = 0; sample < testing::scaled(20); ++sample) {
            std::vector<checker::Integer> q = middle;
            for (const int k : point.problem.coordinate_of) {
                const int sign = random() % 2 == 0 ? 1 : -1;
                q[static_cast<std::size_t>(k)] += sign * checker::floor_of(radius, -point.problem.fine);
            }
            point.vertex.middle = std::move(q);
            point.vertex.row_residual = wide.vertex.row_residual;
            const checker::Velocities::Solution there = checker::Velocities(point).opening(l, 1);
            for (std::size_t c = 0; c < middle.size(); ++c) {
                const checker::Rational way = abs(there.middle[c] - enclosed.middle[c]) + there.radius;
                BOOST_REQUIRE((way <= enclosed.radius));
                farthest = std::max<checker::Rational>(farthest, way / enclosed.radius);
            }
        }
    }
    BOOST_TEST(farthest.get_d() > 0.01);
}

// One disk between four walls: the two contacts along x are alone with x and the right wall, unless that is loaded.
BOOST_AUTO_TEST_CASE(forces_vanish_by_counting_only_without_load) {
    using namespace checker;
    const Problem problem(crafted::one_disk(1, 1)); // contacts left, right, bottom, top; coordinates x, y, Lx, Ly
    Forces load(4);
    BOOST_TEST(vanish_structurally(problem, {0, 1}, load)); // the left wall follows from x and the right one
    BOOST_TEST(vanish_structurally(problem, {0}, load));    // by the left wall, which has no degree of freedom
    BOOST_TEST(vanish_structurally(problem, {0, 1, 2}, load));
    BOOST_TEST(!vary_together(problem, {0, 1}, load));
    load.set(3, Range(Rational(-1)));
    BOOST_TEST(vanish_structurally(problem, {0, 1}, load));
    BOOST_TEST(!vanish_structurally(problem, {0, 1, 2}, load));
    load.set(3, Range(Rational(0)));
    load.set(2, Range(Rational(-1)));
    BOOST_TEST(!vanish_structurally(problem, {0, 1}, load));
    BOOST_TEST(vary_together(problem, {0, 1}, load));
    BOOST_TEST(vanish_structurally(problem, {2, 3}, load));
    load.set(2, Range(Rational(0), Rational(1))); // may be loaded
    BOOST_TEST(!vanish_structurally(problem, {0, 1}, load));
}

// Brute force over all pairs, for configurations that need not be anything: the sweep must list the smallest gap.
BOOST_AUTO_TEST_CASE(the_sweep_finds_the_smallest_gap) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(0.5, 40);
    for (int trial = 0; trial < testing::scaled(2000); ++trial) {
        State state = small_states::with_a_rattler();
        const auto disks = static_cast<std::size_t>(2 + trial % 7);
        state.contacts.clear();
        state.packing.radius.assign(disks, 0.4);
        state.packing.radius[0] = 3;
        state.packing.radius[1] = 2.9;
        state.packing.q.resize(2 * disks + 2);
        std::ranges::generate(state.packing.q, [&] { return place(random); });
        state.packing.length(0) = 100;
        state.packing.length(1) = 100;
        const std::vector<Contact> pairs = oracle::all_pairs(state.packing);
        state.contacts = {pairs[random() % pairs.size()], pairs[random() % pairs.size()]};
        small_states::lists_the_smallest_gap(state, pairs);
    }
}

BOOST_AUTO_TEST_CASE(ranges_contain_what_they_must) {
    using checker::Range;
    using checker::Rational;
    const Range a(Rational(-1, 3), Rational(1, 2));
    const Range b(Rational(-5, 7), Rational(-2, 7));
    for (const Rational& x : {a.lower, Rational(0), a.upper}) {
        for (const Rational& y : {b.lower, Rational(-1, 2), b.upper}) {
            const auto inside = [](const Range& range, const Rational& value) {
                return range.lower <= value && value <= range.upper;
            };
            BOOST_TEST(inside(a + b, x + y));
            BOOST_TEST(inside(a - b, x - y));
            BOOST_TEST(inside(a * b, x * y));
            BOOST_TEST(inside(a / b, x / y));
        }
    }
    BOOST_TEST(checker::rounded_up(Rational(1, 3)) == std::nextafter(1.0 / 3, 1.0));
    BOOST_TEST(checker::rounded_down(Rational(1, 3)) == 1.0 / 3);
    BOOST_TEST(checker::rounded_up(Rational(-1, 3)) == -1.0 / 3);
    BOOST_TEST(checker::rounded_up(checker::power_of_two(-3000)) > 0);
    BOOST_TEST(checker::rounded_up(checker::power_of_two(3000)) == std::numeric_limits<double>::infinity());
    BOOST_TEST(checker::rounded_down(checker::power_of_two(3000)) == std::numeric_limits<double>::max());
}
