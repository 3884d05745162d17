#pragma once
/// \file
/// The smallest singular value of the derivative at the stored coordinates, from an approximate Cholesky factor whose
/// residual is evaluated exactly (proofs/checker.md, K15).

#include "checker/problem.hpp"

#include <optional>

namespace isostat::checker {

/// A positive lower bound, as a length, of the smallest singular value of A; nothing when the factor is not accurate
/// enough, which proves nothing about the matrix. Cost: three sparse Cholesky factorisations of A^T A; memory O(entries
/// of one). \pre the problem is square.
std::optional<Rational> smallest_singular_value(const Problem& problem);

} // namespace isostat::checker
