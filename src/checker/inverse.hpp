#pragma once
/// \file
/// What is proved of the derivative at the stored coordinates and of its inverse (proofs/checker.md, K2, K3, K15).

#include "checker/problem.hpp"
#include "checker/solver.hpp"

#include <isostat/checker/verify.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

/// An order of the degrees of freedom in which a Cholesky factor of A^T A fills little.
std::vector<int> order_of_normal(const Structure& structure);

/// A positive lower bound, as a length, of the smallest singular value of A; nothing when the factor is not accurate
/// enough, which proves nothing about the matrix. `order`: one in which factors are computed, for instance that of
/// nearly the same contacts. `enough`: a bound that does, in units of a power of two just above the entries of A; it
/// costs one sparse factorisation of A^T A where it holds. 0, or where it does not: two and more for nearly the largest
/// bound. \pre the problem is square.
std::optional<Rational> smallest_singular_value(const Problem& problem, const std::vector<int>& order = {},
                                                double enough = 0);

/// Bounds for a matrix R, which is not kept: row sums, column sums, and the size of E = I - R A. Lengths are real. With
/// a bound of the smallest singular value R is the inverse, and the sums follow from that bound (K15).
struct InverseBound {
    bool found = false;      ///< residual_row < 1: A is regular; otherwise nothing is known
    std::string arithmetic;  ///< the arithmetic that found the bound
    Rational singular_value; ///< lower bound of the singular values of A; 0: not known
    /// A(q) is regular when q is within less than this of the stored coordinates; nothing: everywhere.
    std::optional<Rational> regular_within;
    Rational residual_row;            ///< >= |E|_inf
    Rational residual_column;         ///< >= |E|_1
    Rational row_sum;                 ///< >= |R|_inf
    Rational quadratic_sum;           ///< as `row_sum`, over contacts of two disks only
    Rational column_sum_max;          ///< >= |R|_1
    std::vector<Rational> column_sum; ///< per contact l: >= sum_k |R_kl|; empty: `column_sum_max` is all that is known
};

/// `roughly`: a small bound of the singular value does, and costs less. \pre the problem is square.
InverseBound bound_inverse(const Problem& problem, const Solver& solver, CheckerArithmetic arithmetic,
                           bool roughly = false);

} // namespace isostat::checker
