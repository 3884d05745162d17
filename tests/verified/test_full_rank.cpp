// Bounds for contact matrices with more columns than rows.

#include "core/roundoff.hpp"
#include "support/test.hpp"
#include "verified/inverse_bound.hpp"

#include <Eigen/Dense>

namespace {

isostat::sparse::Matrix<double> compressed(const Eigen::MatrixXd& dense) {
    isostat::sparse::Matrix<double> out;
    out.rows = static_cast<int>(dense.rows());
    out.cols = static_cast<int>(dense.cols());
    out.start.push_back(0);
    for (Eigen::Index j = 0; j < dense.cols(); ++j) {
        for (Eigen::Index i = 0; i < dense.rows(); ++i) {
            out.row.push_back(static_cast<int>(i));
            out.value.push_back(dense(i, j));
        }
        out.start.push_back(static_cast<int>(out.row.size()));
    }
    return out;
}

} // namespace

BOOST_AUTO_TEST_CASE(the_smallest_singular_value_of_independent_rows_is_bounded_from_below_and_not_by_much) {
    std::mt19937_64 random(3);
    for (const auto& [rows, columns] : {std::pair{1, 1}, {3, 5}, {8, 8}, {7, 30}, {20, 23}}) {
        for (const double shrink : {1.0, 1e-2, 1e-4}) { // of one row
            Eigen::MatrixXd h(rows, columns);
            for (double& entry : h.reshaped()) {
                entry = static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5;
            }
            h.row(0) *= shrink;
            const double truth = h.jacobiSvd().singularValues().tail(1)[0];
            const double bound = isostat::smallest_row_singular_value(compressed(h), 2);
            BOOST_TEST(bound <= std::min(truth, 1.0) * (1 + 1e-12));
            BOOST_TEST(bound >= 0.4 * std::min(truth, 1.0));
        }
    }
}

BOOST_AUTO_TEST_CASE(rows_that_depend_on_each_other_have_no_bound) {
    Eigen::MatrixXd h = Eigen::MatrixXd::Ones(3, 6);
    h(0, 0) = 2;
    BOOST_TEST(isostat::smallest_row_singular_value(compressed(h), 2) == 0);
    BOOST_TEST(isostat::smallest_row_singular_value(compressed(h.leftCols(2)), 2) == 0); // and more rows than columns
}

BOOST_AUTO_TEST_CASE(the_residual_of_forces_is_bounded_in_every_unit_of_force) {
    std::mt19937_64 random(5);
    constexpr int n = 6;
    const auto number = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53 - 0.5; };
    Eigen::MatrixXd h(n, n);
    for (double& entry : h.reshaped()) {
        entry = number();
    }
    Eigen::VectorXd z(n);
    for (double& entry : z) {
        entry = number();
    }
    const Eigen::VectorXd v = h * z;
    const Eigen::Matrix<long double, n, 1> rest = v.cast<long double>() - h.cast<long double>() * z.cast<long double>();
    BOOST_TEST_REQUIRE(rest.norm() > 0);
    const auto bound = [&](double unit) {
        std::vector<double> load(v.begin(), v.end()), force(z.begin(), z.end()), r(n), size(n);
        for (std::vector<double>* numbers : {&load, &force}) {
            for (double& entry : *numbers) {
                entry *= unit;
            }
        }
        std::vector<int> terms(n);
        return isostat::residual_of_forces(compressed(h), load, force, r, size, terms) / unit;
    };
    BOOST_TEST(bound(1) >= static_cast<double>(rest.norm()));
    BOOST_TEST(bound(1) < 1e-13);
    for (const double unit : {0x1p-300, 0x1p-500, 0x1p-700, 0x1p-900}) { // squares vanish from 1e-162 on
        BOOST_TEST(std::abs(bound(unit) / bound(1) - 1) < 1e-8, unit);
    }
    BOOST_TEST(bound(0x1p-1040) >= static_cast<double>(rest.norm())); // where products underflow
}
