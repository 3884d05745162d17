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

/// Of some matrix R, kept nowhere: row sums, column sums, and the size of E = I - R A. Lengths are real, not in units.
/// With a bound of the smallest singular value R is the inverse itself, and the sums follow from that (K15).
struct InverseBound {
    bool found = false;      ///< residual_row < 1: A is regular; otherwise nothing is known
    std::string arithmetic;  ///< which integers
    Rational singular_value; ///< A has none below; 0: not known
    /// A(q) is regular when q is less than this from the stored coordinates; nothing: everywhere.
    std::optional<Rational> regular_within;
    Rational residual_row;            ///< >= |E|_inf
    Rational residual_column;         ///< >= |E|_1
    Rational row_sum;                 ///< >= |R|_inf
    Rational quadratic_sum;           ///< the same over contacts of two disks only
    Rational column_sum_max;          ///< >= |R|_1
    std::vector<Rational> column_sum; ///< per contact l: >= sum_k |R_kl|
};

/// \pre the problem is square.
InverseBound bound_inverse(const Problem& problem, const Solver& solver, CheckerArithmetic arithmetic);

} // namespace isostat::checker
