#pragma once
/// \file
/// The smallest singular value of the derivative at the stored coordinates, from an approximate Cholesky factor whose
/// residual is evaluated exactly (proofs/checker.md, K15).

#include "checker/problem.hpp"

#include <optional>
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

} // namespace isostat::checker
