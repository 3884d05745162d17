#pragma once
/// \file
/// Packings made elsewhere: counts against the gap below which a pair is taken for a contact.

#include <isostat/contact/contact.hpp>
#include <isostat/core/verdict.hpp>
#include <isostat/packing/packing.hpp>

#include <vector>

namespace isostat::crafted {

/// Counts with every pair of gap <= `threshold` as a contact. Rattlers are left out, by the position of the normals
/// (`DiskHold`): N_f, N, h and k are those of the rest. The rank is that of the matrix of the *stored* coordinates:
/// exact when it is as high as the counts allow (`rank_exact`), else a lower bound.
struct PlateauStep {
    double threshold = 0;
    int candidate_count = 0; ///< pairs and walls at gap <= threshold
    int rattlers = 0;
    int dof_count = 0;     ///< N_f without the rattlers
    int contact_count = 0; ///< N without contacts that can carry no force
    int rank = 0;
    int hyperstaticity = 0; ///< N - rank
    int mechanisms = 0;     ///< N_f - rank, common rigid motions included
    int rigid_motions = 0;
    Verdict rank_exact = Verdict::undecided;
    /// h = 0 and no internal mechanism. `proved` or `refuted` (N and N_f alone already differ, or the rank is exact),
    /// else `undecided`.
    Verdict isostatic = Verdict::undecided;
};

/// Thresholds in [first, last) between two changes of the verdict: with every gap <= `first` the contacts are
/// isostatic, without the gap `first` they are not (or not proved), and with the gap `last` they are no more. Found at
/// the given thresholds and by bisection between them: a change and its reversal between two thresholds can be missed.
/// `last` is the largest threshold when the run reaches it.
struct PlateauRange {
    double first = 0;
    double last = 0;
};

struct Plateau {
    std::vector<PlateauStep> steps;   ///< one per threshold, increasing
    std::vector<PlateauRange> ranges; ///< maximal runs of proved steps, their ends refined by bisection over the gaps
    double deepest_overlap = 0;       ///< the smallest gap (negative: overlap)
};

/// \pre finite coordinates. \p thresholds in the unit of length, increasing, any sign (soft packings overlap). Gaps are
/// rounded doubles (`gap`): two candidates closer than that are not told apart. It says nothing of the true
/// configuration near the stored one. Cost: one sparse elimination in natural order per threshold and bisection point.
Plateau plateau(const Packing<2>& packing, const std::vector<double>& thresholds);

} // namespace isostat::crafted
