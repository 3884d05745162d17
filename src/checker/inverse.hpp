#pragma once
/// \file
/// What is proved of the inverse of the derivative at the stored coordinates (proofs/checker.md, K2, K3, K15).

#include "checker/problem.hpp"
#include "checker/solver.hpp"

#include <isostat/checker/verify.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

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
