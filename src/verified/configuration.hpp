#pragma once
/// \file
/// The true vertex near a stored configuration, and the signs of the gaps there.

#include "verified/inverse_bound.hpp"
#include "verified/order.hpp"

#include <isostat/core/result.hpp>

#include <vector>

namespace isostat {

/// A true vertex (all gaps of the structure exactly 0) exists within `radius` (2-norm over all coordinates) of
/// stored q + correction and is unique there (Newton-Kantorovich, statement V4; quadratics of T9).
struct VertexEnclosure {
    Verdict verdict = Verdict::undecided; ///< proved, or undecided (then nothing is known)
    double radius = 0;
    std::vector<double> correction; ///< empty on the rung double_bound; else one per coordinate of q
    /// On the rung double_bound, if known: the Newton step, one entry per degree of freedom. The true vertex is within
    /// `step_radius` of stored q + step (V4 (e)).
    std::vector<double> step;
    double step_radius = 0;
    double max_gap = 0;   ///< largest |gap| of the contacts at the stored configuration, as computed
    double lipschitz = 0; ///< Lipschitz constant of the derivative of the constraints (V4 (a)), if computed; else 0
    Rung rung = Rung::double_bound;

    /// The true vertex is within this distance (2-norm, all coordinates) of the *stored* configuration, whereas
    /// `radius` is the distance from the corrected one.
    [[nodiscard]] double distance() const;
};

/// Rung double_bound: gaps in double, radius about 1e-15 sqrt(N) / sigma_min. Cost O(N).
VertexEnclosure enclose_vertex(const Packing& packing, const IsostaticStructure& structure,
                               const InverseBound& inverse);

/// The same with a much smaller radius: gaps with negligible rounding, and the Newton step itself instead of its worst
/// case (statement V4 (e)); the true vertex is then about as far as this step, some 1e-14 sqrt(N), for any sigma_min.
/// Cost: 2 or 3 passes and O(N). `factorisation` makes guesses and is not trusted.
VertexEnclosure enclose_vertex(const Packing& packing, const IsostaticStructure& structure,
                               const Factorisation& factorisation, const InverseBound& inverse);

/// Rung double_double: one or two corrections, gaps in double-double; radius about 1e-29 / sigma_min. Cost: two solves
/// and O(N).
VertexEnclosure enclose_vertex_double_double(const Packing& packing, const IsostaticStructure& structure,
                                             const Factorisation& factorisation, const InverseBound& inverse);

/// Gap at the true vertex, for any candidate.
Enclosure gap_at_vertex(const Packing& packing, const VertexEnclosure& vertex, const Contact& contact);

/// Signs of the gaps of candidates at the true vertex, beyond double-double: first the vertex in MPFR with first_bits
/// ... max_bits bits; then, when every kept gap is exactly 0 at the stored configuration (which is then the true
/// vertex), exact numbers. Sign 0: the candidate is proved to touch. One result per candidate. Cost: N gaps and a solve
/// per 30 bits or so, and a gap per rung for each candidate.
std::vector<Order> gap_signs_at_vertex(const Packing& packing, const IsostaticStructure& structure,
                                       const Factorisation& factorisation, const InverseBound& inverse,
                                       const std::vector<Contact>& candidates, const LadderOptions& options = {});

} // namespace isostat
