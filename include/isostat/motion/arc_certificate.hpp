#pragma once
/// \file
/// What was proved of an arc at the level `arcs` (proofs/arcs.md).

#include <isostat/core/result.hpp>

#include <string>
#include <vector>

namespace isostat {

/// Data that help a checker and that it need not trust: the grains that move, and configurations along the way from the
/// start vertex to the end vertex, so close that one piece of the curve joins neighbours.
struct ArcWitness {
    struct Centre {
        int held = 0;          ///< coordinate that changes fast and monotonically on this piece
        std::vector<double> q; ///< the coordinates of the moving grains that are degrees of freedom, in their order
    };
    bool whole = true;       ///< every grain takes part
    std::vector<int> grains; ///< otherwise the grains that take part (walls: after the last disk)
    std::vector<Centre> centres;
    std::vector<double> end; ///< the end vertex, like `Centre::q`
};

/// What was proved of one arc, for the *true* vertices and radii (the stored radii, taken as exact):
/// - verdict proved: from the true start vertex the kept contacts define exactly one curve in the direction in which
///   the opened gap grows; it reaches the true end vertex; strictly between the two every other gap is positive, the
///   opened one included.
/// - verdict undecided: nothing is known, and nothing refuted;
///   `reason` names the pair and the place or the test that failed.
/// The power is judged apart. `power` proved: the power is positive all along the arc, except for two shares of the arc
/// (in the parameter of the first and of the last piece): `power_open_start` at the start of an arc at a limit load,
/// where it grows from 0, and `power_open_end` before a power turn, where it ends at 0 (at most 1e-2 each). Nothing is
/// claimed under `true_stress`.
struct ArcCertificate {
    Verdict verdict = Verdict::undecided;
    std::string reason;     ///< filled when undecided
    int pieces = 0;         ///< stretches of the curve that have their own tube
    int factorisations = 0; ///< fresh centres: rank proof, factorisation and bound of the inverse, each once
    int moving = 0;         ///< number of coordinates that take part
    bool turning = false;   ///< the gap of the opened contact is proved to fall at the end, after it grew
    double tube = 0;        ///< largest radius of a tube (2-norm over all coordinates)
    double tube_margin = 0; ///< smallest (1/4) / (beta^2 K rho) of Kantorovich's test
    double gap_margin = 0;  ///< smallest |gap or rate| / (uncertainty from the tube) over the stretches
    Verdict power = Verdict::undecided;
    double power_open_start = 0;
    double power_open_end = 0;
    std::string power_reason; ///< filled when the power is undecided
    ArcWitness witness;       ///< filled when proved
};

} // namespace isostat
