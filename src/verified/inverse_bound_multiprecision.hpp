#pragma once
/// \file
/// A proved bound of the inverse where double precision gives no bound: small structures, any condition number.

#include "verified/inverse_bound.hpp"

namespace isostat {

/// As `bound_inverse`, for sigma_min down to the range of double (about 1e-300): R ~ H^-1 row by row from sparse LU
/// factors in MPFR with 128, 256, ... `max_bits` bits, then |H^-1|_2 <= sqrt(|R|_1 |R|_inf) / (1 - |R H - I|) with the
/// rounding of the entries and products included (statement V2 with the unit 2^-bits). `undecided` when N_f exceeds
/// `size_limit`, or at the cap. Cost: N_f solves with `bits` bits; N_f = 200, sigma_min = 1e-40: about 0.1 s.
InverseBound bound_inverse_multiprecision(const Packing& packing, const IsostaticStructure& structure,
                                          int size_limit = 400, int max_bits = 4096);

} // namespace isostat
