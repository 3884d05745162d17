#pragma once
// Iterative refinement with residuals in MPFR: private to the room.

#include "verified/real.hpp"

#include <isostat/verified/inverse_bound.hpp>

#include <vector>

namespace isostat {

/// x with |x - exact|_2 <= bound, hence every component within `bound`. The bound is NaN or infinite when nothing is
/// known.
struct RefinedVector {
    std::vector<Real> value;
    Real bound;
    double residual = 0; ///< max |b - A x|, rounded up
};

/// H, the exact unit normals of the stored configuration, with entries to `bits` bits.
template <int Dim> class RefinedSystem {
  public:
    RefinedSystem(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                  const Factorisation& factorisation, const InverseBound& inverse, mpfr_prec_t bits);

    /// Solves H f = b (or H^T v = b) from the guess `start`: residuals with `bits` bits, corrections from the LU in
    /// double; ends when an iteration does not halve the bound. The bound is |H^-1|_2 |residual|_2, rounding of entries
    /// and residual included (statement V3 with the unit 2^-bits). \pre inverse proved. Cost per iteration: N_entries
    /// products of `bits` bits and a solve; an iteration gains -log2(cond 2^-53) bits.
    [[nodiscard]] RefinedVector solve(const std::vector<Real>& b, const std::vector<Real>& start,
                                      bool transposed = false) const;
    [[nodiscard]] mpfr_prec_t bits() const { return bits_; }

  private:
    const sparse::Matrix<double>* pattern_;
    const Factorisation* factorisation_;
    const InverseBound* inverse_;
    mpfr_prec_t bits_;
    std::vector<Real> entry_;
};

extern template class RefinedSystem<2>;

} // namespace isostat
