#pragma once
/// \file
/// Proof that an arc was followed without missing a contact: the level `arcs` (proofs/arcs.md).

#include <isostat/motion/arc.hpp>
#include <isostat/verified/configuration.hpp>

#include <string>

namespace isostat {

/// One end of an arc with what is known of it; all of the same vertex.
template <int Dim> struct ArcVertex {
    const Packing<Dim>& packing;
    const IsostaticStructure<Dim>& structure;
    const Factorisation& factorisation;
    const InverseBound& inverse;
    const VertexEnclosure& enclosure;
};

/// Caps of the proof; they change its cost and whether it succeeds, never its validity.
struct ArcCertificateOptions {
    int max_pieces = 20000;      ///< pieces of the curve
    double smallest_step = 1e-9; ///< shortest piece tried, in units of the smallest radius
};

/// Where a checker should look: nothing in it is to be trusted. The grains that move, and configurations on the way
/// from the start vertex to the end vertex, so close that neighbours are joined by one piece of the curve.
struct ArcWitness {
    struct Centre {
        int held = 0;          ///< coordinate that moves fast and monotonely there
        std::vector<double> q; ///< the coordinates of the moving grains that are degrees of freedom, in their order
    };
    bool whole = true;       ///< every grain takes part
    std::vector<int> grains; ///< else: those that do (walls: after the last disk)
    std::vector<Centre> centres;
    std::vector<double> end; ///< the end vertex, like `Centre::q`
};

/// What was proved of one arc, for the *true* vertices and radii (the stored radii, taken as exact):
/// - verdict proved: from the true start vertex the kept contacts define exactly one curve in the direction in which
///   the opened gap grows; it reaches the true end vertex; strictly between the two every other gap is positive, the
///   opened one included.
/// - verdict undecided: nothing is known; `reason` names the pair and the place or the test that failed. It is not a
///   refutation.
/// The power is judged apart: `power` proved: it is positive all along the arc, but for the shares of the arc (in the
/// parameter of the first and of the last piece) `power_open_start` at the start of an arc at a limit load, where it
/// grows from 0, and `power_open_end` before a power turn, where it ends at 0 (at most 1e-2 each). Under
/// `true_stress` nothing is claimed.
struct ArcCertificate {
    Verdict verdict = Verdict::undecided;
    std::string reason;     ///< when undecided
    int pieces = 0;         ///< stretches of the curve with a tube of their own
    int factorisations = 0; ///< fresh centres: rank proof, factorisation and bound of the inverse, each once
    int moving = 0;         ///< coordinates that take part
    bool turning = false;   ///< the gap of the opened contact is proved to fall at the end: it grew, and turned back
    long gap_tests = 0;     ///< stretches on which a gap was bounded
    double tube = 0;        ///< largest radius of a tube (2-norm over all coordinates)
    double tube_margin = 0; ///< smallest (1/4) / (beta^2 K rho) of Kantorovich's test
    double gap_margin = 0;  ///< smallest |gap or rate| / (what the tube leaves open) over the stretches
    Verdict power = Verdict::undecided;
    double power_open_start = 0;
    double power_open_end = 0;
    std::string power_reason; ///< when the power is undecided
    ArcWitness witness;       ///< when proved
};

/// Certifies the arc that opens `opened` at `start` (`direction` as for `follow_arc`) and ends at `end`, whose contacts
/// are those of `start` with `opened` replaced in its place. It does not depend on how the arc was found.
/// `candidates` is used while it is complete and made again when the motion leaves its reach.
///
/// Method: pieces of the curve as polynomials (derivatives in the free parameter, one triangular solve each), a tube
/// around each by Newton-Kantorovich with sigma_min(centre) - |change of the derivative|, neighbouring pieces joined by
/// uniqueness, gaps bounded from below over stretches that are halved until their sign or the sign of their rate is
/// proved (A1 to A7). Pieces at the two ends use the bounds that the vertices have already; a longer arc needs fresh
/// centres: one rank proof, one factorisation, one bound of the inverse each. Arcs of rattlers are certified in their
/// own few degrees of freedom.
template <int Dim>
ArcCertificate certify_arc(const ArcVertex<Dim>& start, ContactId opened, int direction, const ArcVertex<Dim>& end,
                           const PowerLoad<Dim>& power, const CandidateList<Dim>& candidates,
                           const ArcCertificateOptions& options = {});

extern template ArcCertificate certify_arc<2>(const ArcVertex<2>&, ContactId, int, const ArcVertex<2>&,
                                              const PowerLoad<2>&, const CandidateList<2>&,
                                              const ArcCertificateOptions&);

} // namespace isostat
