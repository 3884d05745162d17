#pragma once
// The contact matrix with entries in MPFR: private to the room.

#include "verified/real.hpp"

#include <isostat/rigidity/isostatic.hpp>

#include <vector>

namespace isostat {

/// H of the stored configuration in the pattern of `structure.matrix()`, every entry within 5 units 2^-bits (relative)
/// of the exact one.
template <int Dim>
std::vector<Real> precise_contact_matrix(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                                         mpfr_prec_t bits);

extern template std::vector<Real> precise_contact_matrix<2>(const Packing<2>&, const IsostaticStructure<2>&,
                                                            mpfr_prec_t);

} // namespace isostat
