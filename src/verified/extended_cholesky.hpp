#pragma once
/// \file
/// The shifted Cholesky test in double-double: private to the room.

#include "sparse/pattern.hpp"

namespace isostat {

/// Factorises H H^T - shift I (Eigen's simplicial Cholesky over libqd's double-double).
/// Returns a proved lower bound of lambda_min(H H^T): shift minus the bound of the backward
/// error (statement V1 with the unit of double-double), or 0 when a pivot was not positive.
/// The entries of `h` are taken as exact. Cost: about 30 times that of the double version.
double shifted_cholesky_double_double(const sparse::Matrix<double>& h, double shift);

} // namespace isostat
