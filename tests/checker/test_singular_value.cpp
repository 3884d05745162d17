// The bound of the smallest singular value: never above a dense one, not far below it, none for singular matrices.
#include "checker/dense.hpp"
#include "checker/inverse.hpp"
#include "checker/maker.hpp"
#include "checker/normal_factor.hpp"
#include "checker/small_states.hpp"
#include "checker/vertex.hpp"
#include "support/scratch.hpp"
#include "support/spheres.hpp"
#include "support/units.hpp"

#include <isostat/checker/verify.hpp>

#include <Eigen/SVD>

using namespace isostat;
using checker::Problem;
using checker::smallest_singular_value;
using checker::Solver;

namespace {

void agrees_with_a_dense_one(const State& state) {
    const Problem problem(state);
    const Eigen::MatrixXd a = dense::derivative(problem).cast<double>();
    const double sigma = Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner>(a).singularValues().minCoeff();
    const double error = 1e-13 * a.norm();
    const auto bound = smallest_singular_value(problem);
    BOOST_REQUIRE(bound.has_value());
    BOOST_TEST(bound->get_d() <= sigma + error);
    BOOST_TEST(bound->get_d() >= 0.8 * sigma);

    // A bound that does is none above the truth, and any order of elimination serves.
    std::vector<int> backwards(static_cast<std::size_t>(problem.dofs()));
    std::iota(backwards.rbegin(), backwards.rend(), 0);
    for (int exponent = 1; exponent < 30; ++exponent) {
        const auto rough = required(smallest_singular_value(problem, backwards, std::ldexp(1.0, -exponent)));
        BOOST_TEST(rough.get_d() <= sigma + error, "2^-" << exponent);
    }

    // What follows from it, against the inverse itself.
    const checker::InverseBound sums =
        checker::bound_inverse(problem, Solver(problem), CheckerArithmetic::singular_value);
    BOOST_REQUIRE(sums.found);
    const Eigen::MatrixXd sizes = a.inverse().cwiseAbs();
    BOOST_TEST(sums.row_sum.get_d() >= sizes.rowwise().sum().maxCoeff());
    BOOST_TEST(sums.column_sum_max.get_d() >= sizes.colwise().sum().maxCoeff());
    for (std::size_t l = 0; l < sums.column_sum.size(); ++l) {
        BOOST_TEST(sums.column_sum[l].get_d() >= sizes.col(static_cast<Eigen::Index>(l)).sum());
    }
}

State sample(const char* name) {
    return read_state(scratch::data(name)).state;
}

Verdict about_vertex(const Certificate& certificate, CheckerArithmetic arithmetic) {
    return verify(certificate, arithmetic).checks.at(1).verdict;
}

} // namespace

BOOST_AUTO_TEST_CASE(the_singular_value_agrees_with_a_dense_one, *boost::unit_test::label("slow")) {
    for (const State& state : {crafted::one_disk(1, 1), crafted::three_disks(1, 1.1, 1.3, 1, 1),
                               small_states::with_a_rattler(), small_states::with_a_fixed_disk(),
                               small_states::in_a_corner(), sample("vertex100.txt"), sample("vertex400.txt")}) {
        agrees_with_a_dense_one(state);
    }
    for (const char* name : {"closed_tetra", "box_uniform_30_1", "tri_uniform_30_1"}) { // rows of 6 and of 12 entries
        agrees_with_a_dense_one(test::state_of_spheres(test::read_spheres(name)));
    }
}

// The rows are (2, h) and (-2, h): singular values sqrt(8) and sqrt(2) h.
BOOST_AUTO_TEST_CASE(a_singular_value_that_approaches_zero_is_never_overstated) {
    for (int exponent = 1; exponent < 60; ++exponent) {
        const double h = std::ldexp(1.0, -exponent);
        const auto bound = smallest_singular_value(Problem(small_states::between_two(h)));
        BOOST_TEST((bound || exponent > 20), "2^-" << exponent);
        if (bound) {
            BOOST_TEST(bound->get_d() <= std::sqrt(2.0) * h, "2^-" << exponent);
            BOOST_TEST((bound->get_d() >= std::sqrt(2.0) * h / 2 || exponent > 20), "2^-" << exponent);
        }
    }
    BOOST_TEST(!smallest_singular_value(Problem(small_states::between_two(0))).has_value());
}

// One contact twice: the rounding of an approximate factor must not make a regular matrix of it.
BOOST_AUTO_TEST_CASE(a_singular_matrix_of_a_large_state_has_no_bound) {
    State state = sample("vertex400.txt");
    const auto is_pair = [](const Contact& c) { return c.kind == ContactKind::disk_disk; };
    const auto first = std::ranges::find_if(state.contacts, is_pair);
    for (int other = 1; other < 200; ++other) {
        State singular = state;
        singular.contacts[static_cast<std::size_t>(first - state.contacts.begin() + other)] = *first;
        const Problem problem(singular);
        BOOST_TEST(!smallest_singular_value(problem).has_value(), other);
    }
}

// K15 counts sums of at most 2^16 products of an upper wall: beyond, 128 bits are not known to hold them.
BOOST_AUTO_TEST_CASE(a_wall_with_more_than_2_to_the_16_contacts_has_no_singular_value) {
    for (const int disks : {0x10000 - 1, 0x10000, 0x10000 + 1}) {
        State state = crafted::one_disk(1, 1);
        state.packing.walls.upper[0] = WallKind::absent;
        state.packing.radius.assign(static_cast<std::size_t>(disks), 1);
        state.packing.q.clear();
        state.contacts = {crafted::bottom(0)};
        for (int i = 0; i < disks; ++i) { // in a column of the plane, where they overlap: the matrix does not mind
            state.packing.q.insert(state.packing.q.end(), {1, 1});
            state.contacts.insert(state.contacts.end(), {crafted::left(i), crafted::top(i)});
        }
        state.packing.q.insert(state.packing.q.end(), {0, 2});
        BOOST_TEST(smallest_singular_value(Problem(state)).has_value() == (disks <= 0x10000), disks);
    }
}

namespace {

/// A diagonal of numbers from 1/2 to 1 and two more entries in every row; `singular`: the last row is the first one.
checker::SparseRows<double> random_rows(std::mt19937& random, int n, bool singular) {
    std::uniform_real_distribution<double> number(0.5, 1);
    checker::SparseRows<double> a;
    for (int l = 0; l < n; ++l) {
        const bool repeated = singular && l + 1 == n;
        for (int k = 0; k < 3; ++k) {
            const int column = k == 0 ? l : (l + (k == 1 ? 1 : 7 + l % 5)) % n;
            a.column.push_back(repeated ? a.column[static_cast<std::size_t>(k)] : column);
            a.value.push_back(repeated ? a.value[static_cast<std::size_t>(k)] : (k == 0 ? 1 : -0.4) * number(random));
        }
        a.first.push_back(a.column.size());
    }
    return a;
}

std::vector<int> mixed_order(std::mt19937& random, int n) {
    std::vector<int> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    std::ranges::shuffle(order, random);
    return order;
}

} // namespace

// K30: rounding lets a factor exist where none does; what it is off by is then no less than the shift.
BOOST_AUTO_TEST_CASE(a_singular_matrix_gets_no_bound_from_doubles) {
    std::mt19937 random(1);
    int passed = 0;
    for (int sample = 0; sample < 60; ++sample) {
        const int n = 30 + sample;
        const auto factor =
            checker::normal_factor(2 + sample % 2, random_rows(random, n, true), mixed_order(random, n));
        for (int exponent = 30; exponent < 80; ++exponent) {
            const double shift = std::ldexp(1.0, -exponent);
            if (factor->compute(shift)) {
                ++passed;
                BOOST_TEST(factor->residual(shift) >= shift, "2^-" << exponent);
            }
        }
    }
    BOOST_TEST(passed > 0);
}

BOOST_AUTO_TEST_CASE(factors_of_the_normal_matrix_solve) {
    std::mt19937 random(2);
    for (const int n : {20, 31, 64}) {
        for (const int dimension : {2, 3}) {
            const checker::SparseRows<double> a = random_rows(random, n, false);
            const auto size = static_cast<Eigen::Index>(a.first.size() - 1);
            const auto factor = checker::normal_factor(dimension, a, mixed_order(random, static_cast<int>(size)));
            Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
            for (Eigen::Index l = 0; l < size; ++l) {
                for (std::size_t p = a.first[static_cast<std::size_t>(l)]; p < a.first[static_cast<std::size_t>(l) + 1];
                     ++p) {
                    dense(l, a.column[p]) += a.value[p];
                }
            }
            BOOST_REQUIRE(factor->compute(0));
            const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(size, -1, 2);
            BOOST_TEST((dense * factor->solve(b) - b).norm() < 1e-10);
            BOOST_TEST((dense.transpose() * factor->solve_transposed(b, 2) - b).norm() < 1e-12);
        }
    }
}

BOOST_AUTO_TEST_CASE(lengths_scale) {
    for (const int exponent : {-900, -60, 60, 900}) {
        State state = small_states::with_a_rattler();
        const checker::Rational one = smallest_singular_value(Problem(state)).value();
        units::stretch(state.packing, std::ldexp(1.0, exponent));
        const checker::Rational scaled = smallest_singular_value(Problem(state)).value();
        BOOST_TEST((scaled == one * checker::power_of_two(exponent)), exponent);
    }
}

// No way of bounding the inverse shows the widest uniqueness everywhere; `automatic` is not weaker than either.
BOOST_AUTO_TEST_CASE(a_claim_beyond_the_singular_value_is_decided_row_by_row) {
    int by_rows = 0, by_singular_value = 0;
    for (const State& state :
         {crafted::one_disk(1, 1), crafted::three_disks(1, 1.1, 1.3, 1, 1), small_states::with_a_rattler(),
          small_states::in_a_corner(), crafted::two_disks(1, 2, 1, 1), crafted::two_disks(1, 40, 1, 1),
          crafted::two_disks(1, 1.01, 1, 1), sample("vertex100.txt")}) {
        Certificate certificate = maker::certificate(state);
        const Problem problem(state);
        const Solver solver(problem);
        const auto unique = [&](CheckerArithmetic arithmetic) {
            const checker::InverseBound bound = checker::bound_inverse(problem, solver, arithmetic);
            return bound.found ? checker::largest_unique_distance(bound, checker::find_vertex(problem, solver, bound))
                               : 0.0;
        };
        const double wide = unique(CheckerArithmetic::singular_value);
        const double narrow = unique(CheckerArithmetic::fixed64);
        if (std::isinf(wide)) {
            continue;
        }
        by_rows += narrow > wide ? 1 : 0;
        by_singular_value += wide > narrow ? 1 : 0;
        certificate.claims.vertex->unique_radius = 0.5 * (wide + narrow);
        const bool rows_win = narrow > wide;
        BOOST_TEST((about_vertex(certificate, CheckerArithmetic::singular_value) == Verdict::proved) == !rows_win);
        BOOST_TEST((about_vertex(certificate, CheckerArithmetic::rows) == Verdict::proved) == rows_win);
        BOOST_TEST((about_vertex(certificate, CheckerArithmetic::automatic) == Verdict::proved));
        certificate.claims.vertex->unique_radius = 1.1 * std::max(wide, narrow);
        BOOST_TEST((about_vertex(certificate, CheckerArithmetic::automatic) == Verdict::undecided));
    }
    BOOST_TEST(by_rows > 0);
    BOOST_TEST(by_singular_value > 0);
}
