// The bounds of the inverse against a dense inverse in long double: never below it, and not much above.
#include "checker/inverse.hpp"
#include "checker/maker.hpp"
#include "checker/small_states.hpp"
#include "support/scratch.hpp"

#include <isostat/io/state_file.hpp>

#include <boost/test/unit_test.hpp>

using namespace isostat;

namespace {

/// The derivative at the stored coordinates, walls with their weight, in real lengths.
maker::Matrix derivative(const checker::Problem& problem) {
    maker::Matrix a = maker::Matrix::Zero(problem.contacts(), problem.dofs());
    for (int l = 0; l < problem.contacts(); ++l) {
        const checker::Row& row = problem.rows[static_cast<std::size_t>(l)];
        for (int k = 0; k < row.count; ++k) {
            const int dof = problem.dof_of[static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)])];
            if (dof >= 0) {
                a(l, dof) = problem.length(problem.entry(l, k, problem.stored)).get_d();
            }
        }
    }
    return a;
}

void check_bounds(const State<2>& state, CheckerArithmetic arithmetic) {
    const checker::Problem problem(state);
    const checker::Solver solver(problem);
    const checker::InverseBound bound = checker::bound_inverse(problem, solver, arithmetic);
    BOOST_REQUIRE(bound.found);
    const maker::Matrix inverse = derivative(problem).inverse();
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

} // namespace

BOOST_AUTO_TEST_SUITE(checker)

BOOST_AUTO_TEST_CASE(bounds_of_the_inverse_agree_with_a_dense_inverse) {
    for (const CheckerArithmetic arithmetic :
         {CheckerArithmetic::fixed64, CheckerArithmetic::gmp, CheckerArithmetic::rational}) {
        check_bounds(crafted::one_disk(1, 1), arithmetic);
        check_bounds(crafted::three_disks(1, 1.1, 1.3, 1, 1), arithmetic);
        check_bounds(small_states::with_a_rattler(), arithmetic);
        check_bounds(small_states::with_a_fixed_disk(), arithmetic);
        if (arithmetic != CheckerArithmetic::rational) {
            check_bounds(read_state<2>(scratch::data("vertex100.txt")).state, arithmetic);
        }
    }
}

// A factorisation of another matrix must be noticed by the residual, whatever it is.
BOOST_AUTO_TEST_CASE(a_wrong_factorisation_proves_nothing) {
    const isostat::checker::Problem problem(crafted::three_disks(1, 1.1, 1.3, 1, 1));
    const isostat::checker::Problem other(crafted::three_disks(1, 1.4, 2.3, 1, 1));
    const isostat::checker::Solver wrong(other);
    BOOST_TEST(!isostat::checker::bound_inverse(problem, wrong, CheckerArithmetic::fixed64).found);
}

BOOST_AUTO_TEST_CASE(ranges_contain_what_they_must) {
    using isostat::checker::Range;
    using isostat::checker::Rational;
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
    BOOST_TEST(isostat::checker::rounded_up(Rational(1, 3)) == std::nextafter(1.0 / 3, 1.0));
    BOOST_TEST(isostat::checker::rounded_down(Rational(1, 3)) == 1.0 / 3);
    BOOST_TEST(isostat::checker::rounded_up(Rational(-1, 3)) == -1.0 / 3);
    BOOST_TEST(isostat::checker::rounded_up(isostat::checker::power_of_two(-3000)) > 0);
    BOOST_TEST(isostat::checker::rounded_up(isostat::checker::power_of_two(3000)) ==
               std::numeric_limits<double>::infinity());
    BOOST_TEST(isostat::checker::rounded_down(isostat::checker::power_of_two(3000)) ==
               std::numeric_limits<double>::max());
}

BOOST_AUTO_TEST_SUITE_END()
