#pragma once
/// \file
/// Contact forces with a proved error bound, in double or double-double.

#include "verified/inverse_bound.hpp"

#include <isostat/core/result.hpp>

#include <array>
#include <span>
#include <vector>

namespace isostat {

/// Solution of H f = F for the exact matrix H of the stored configuration: |f_l - (value_l + low_l)| <= bound for every
/// l. `low` is empty on the rung double_bound. With a bound of infinity (or NaN) nothing is known. On the rungs above
/// double-double (force_ladder.hpp) `value` + `low` is the rounded solution; `bound` includes this rounding.
struct ForceSolution {
    std::vector<double> value;
    std::vector<double> low;
    double bound = 0;
    double residual = 0; ///< max |F - H f| of the returned value, as computed
    Rung rung = Rung::double_bound;
    int bits = 53; ///< of the arithmetic: 53, 106, those of MPFR, or 0 for exact numbers; exact: bits of a double
};

/// LU solve, one step of refinement where it can help, and the bound |f - f~| <= |H^-1|_2 |F - H f~|_2 that includes
/// the rounding of the residual and of the entries of H (statement V3). \pre `inverse` proved; otherwise the bound is
/// infinite. Each component of `force` may be off by its own rounding (unit 2^-53). Cost: two solves. With `accuracy` >
/// 0 and reused factors the solve stops at that relative accuracy, estimated, without refinement: fewer passes, and the
/// larger bound of its residual. `guess`: empty, or the start of the iteration.
ForceSolution solve_forces(const IsostaticStructure& structure, const Factorisation& factorisation,
                           const InverseBound& inverse, const std::vector<double>& force,
                           std::span<const double> guess = {}, double accuracy = 0);

/// A component of a right-hand side that stands for minus the exact
/// product of doubles: of two in the plane, of three in space.
struct ExactProduct {
    int row = 0;
    double a = 0;
    double b = 0;
    double c = 1;
    std::array<double, 2> rest{}; ///< the exact factor is a + rest[0] + rest[1]
};

} // namespace isostat
