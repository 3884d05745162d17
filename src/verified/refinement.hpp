#pragma once
// Iterative refinement with residuals in MPFR: private to the room.

#include "verified/real.hpp"

#include <isostat/linear/factorisation.hpp>

#include <vector>

namespace isostat {

/// x with |x - exact|_2 <= bound, hence every component within `bound`. The bound is NaN or infinite when nothing is
/// known.
struct RefinedVector {
    std::vector<Real> value;
    Real bound;
    double residual = 0; ///< max |b - A x|, rounded up
};

/// H, the exact unit normals at some coordinates, with entries to `bits` bits.
template <int Dim> class RefinedSystem {
  public:
    /// `sigma_min` > 0: a proved lower bound of the smallest singular value of the matrix H* that is meant, with
    /// |H* - H|_2 <= uncertainty, H that of the coordinates.
    RefinedSystem(const IsostaticStructure<Dim>& structure, const std::vector<Real>& coordinate,
                  const Factorisation& factorisation, double sigma_min, Real uncertainty, mpfr_prec_t bits);

    /// Solves H f = b (or H^T v = b) from the guess `start`: residuals with `bits` bits, corrections from the LU in
    /// double; ends when an iteration does not halve the bound. The bound is |H^-1|_2 |residual|_2, rounding of entries
    /// and residual included (statement V3 with the unit 2^-bits). b is known to `b_error` (2-norm). Cost per
    /// iteration: N_entries products of `bits` bits and a solve; an iteration gains -log2(cond 2^-53) bits.
    [[nodiscard]] RefinedVector solve(const std::vector<Real>& b, const std::vector<Real>& start,
                                      bool transposed = false, const Real& b_error = Real()) const;
    [[nodiscard]] mpfr_prec_t bits() const { return bits_; }

  private:
    const Factorisation* factorisation_;
    double sigma_min_;
    Real uncertainty_;
    mpfr_prec_t bits_;
    sparse::Matrix<Real> matrix_;
};

extern template class RefinedSystem<2>;

} // namespace isostat
