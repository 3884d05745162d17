#pragma once
// The contact matrix with entries in MPFR: private to the room.

#include "verified/real.hpp"

#include <isostat/rigidity/isostatic.hpp>

#include <vector>

namespace isostat {

/// H at the given coordinates in the pattern of `structure.matrix()`, every entry within 5 units 2^-bits (relative) of
/// the exact one. Components that are 0 in the stored configuration are not in the pattern: what they are at the
/// coordinates is left out.
template <int Dim>
std::vector<Real> precise_contact_matrix(const IsostaticStructure<Dim>& structure, const std::vector<Real>& coordinate,
                                         mpfr_prec_t bits);

extern template std::vector<Real> precise_contact_matrix<2>(const IsostaticStructure<2>&, const std::vector<Real>&,
                                                            mpfr_prec_t);

} // namespace isostat
