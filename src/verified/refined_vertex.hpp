#pragma once
// The true vertex to any number of bits: private to the room.

#include "verified/real.hpp"

#include <isostat/verified/configuration.hpp>

#include <vector>

namespace isostat {

/// A true vertex lies within `radius` (2-norm) of `coordinate`; `shift` is the distance of `coordinate` from the stored
/// configuration, from above.
struct RefinedVertex {
    Verdict verdict = Verdict::undecided;
    std::vector<Real> coordinate; ///< one per coordinate of q
    Real radius;
    double shift = 0;
};

/// Newton's method with the LU in double and gaps in MPFR with `bits` bits from `start`, until an iteration does not
/// halve the radius; Newton-Kantorovich with the rounding of the gaps included (statement V4 with the unit 2^-bits).
/// \pre inverse proved. Cost per iteration: one solve and N gaps.
template <int Dim>
RefinedVertex refine_vertex(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                            const Factorisation& factorisation, const InverseBound& inverse,
                            const std::vector<Real>& start, mpfr_prec_t bits);

/// The coordinates of q plus a correction (may be empty), exactly.
std::vector<Real> exact_coordinates(const std::vector<double>& q, const std::vector<double>& correction);

/// Gap of a contact at given coordinates, within (|gap| + D) 2^(4 - bits) of the exact one.
template <int Dim>
Real precise_gap(const Packing<Dim>& packing, const std::vector<Real>& coordinate, const Contact& contact,
                 mpfr_prec_t bits);

extern template RefinedVertex refine_vertex<2>(const Packing<2>&, const IsostaticStructure<2>&, const Factorisation&,
                                               const InverseBound&, const std::vector<Real>&, mpfr_prec_t);
extern template Real precise_gap<2>(const Packing<2>&, const std::vector<Real>&, const Contact&, mpfr_prec_t);

} // namespace isostat
