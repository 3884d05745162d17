#pragma once
/// \file
/// Bounds for contact matrices with more columns than rows: h > 0.

#include "sparse/pattern.hpp"

#include <vector>

namespace isostat {

/// A lower bound of the smallest of the `h.rows` singular values of the exact matrix that `h` is rounded from
/// (statement V1, which needs no square matrix); 0: no bound was found, and nothing is known. Cost: a Cholesky
/// factorisation for every factor 2 that it is below 1.
double smallest_row_singular_value(const sparse::Matrix<double>& h, int dimension);

/// r = v - H z. Returns an upper bound of the exact |v - H z|_2, v known to 3u. `size`, `terms`: scratch, as long as v.
double residual_of_forces(const sparse::Matrix<double>& h, const std::vector<double>& v, const std::vector<double>& z,
                          std::vector<double>& r, std::vector<double>& size, std::vector<int>& terms);

} // namespace isostat
