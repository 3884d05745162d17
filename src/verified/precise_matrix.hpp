#pragma once
// The contact matrix with entries in MPFR: private to the room.

#include "verified/real.hpp"

#include <isostat/rigidity/isostatic.hpp>

#include <vector>

namespace isostat {

/// H at the given coordinates, every entry within 5 units 2^-bits (relative) of the exact one; the pattern is that of
/// `structure.matrix()`.
template <int Dim>
sparse::Matrix<Real> precise_contact_matrix(const IsostaticStructure<Dim>& structure,
                                            const std::vector<Real>& coordinate, mpfr_prec_t bits);

extern template sparse::Matrix<Real> precise_contact_matrix<2>(const IsostaticStructure<2>&, const std::vector<Real>&,
                                                               mpfr_prec_t);

} // namespace isostat
