#pragma once
/// \file
/// Proof that an arc was followed without missing a contact: the level `arcs` (proofs/arcs.md).

#include "motion/arc.hpp"
#include "verified/configuration.hpp"

#include <isostat/motion/arc_certificate.hpp>

namespace isostat {

/// One end of an arc; all members belong to the same vertex.
struct ArcVertex {
    const Packing& packing;
    const IsostaticStructure& structure;
    const Factorisation& factorisation;
    const InverseBound& inverse;
    const VertexEnclosure& enclosure;
};

/// Caps of the proof; they change its cost and whether it succeeds, never what is proved.
struct ArcCertificateOptions {
    int max_pieces = 20000; ///< pieces of the curve; cost: then the arc is undecided
    // cost: then the arc is undecided
    double smallest_step = 1e-9; ///< shortest piece tried, in units of the smallest radius
};

/// Certifies the arc that opens `opened` at `start` (`direction` as for `follow_arc`) and ends at `end`, whose contacts
/// are those of `start` with `opened` replaced in its place. The proof does not depend on how the arc was found.
/// `candidates` is used while it is complete and made again when the motion leaves its reach; `cache` is that of the
/// arc before, or empty.
///
/// Method: pieces of the curve as polynomials (derivatives in the free parameter, one triangular solve
/// each), a tube around each by Newton-Kantorovich with sigma_min(centre) - |change of the derivative|,
/// neighbouring pieces joined by uniqueness, gaps bounded from below over stretches that are halved until
/// their sign or the sign of their rate is proved (A1 to A7). Pieces at the two ends use the bounds of
/// the vertices; a longer arc needs fresh centres: one rank proof, one factorisation, one bound of the
/// inverse each. Arcs of rattlers are certified in the few degrees of freedom of the rattlers.
ArcCertificate certify_arc(const ArcVertex& start, ContactId opened, int direction, const ArcVertex& end,
                           const PowerLoad& power, const CandidateList& candidates, InverseBoundCache& cache,
                           const ArcCertificateOptions& options = {});

} // namespace isostat
