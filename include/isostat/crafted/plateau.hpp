#pragma once
/// \file
/// Packings of other programs: counts as functions of the gap below which a pair is taken for a contact.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>
#include <isostat/rigidity/counting.hpp>

#include <optional>
#include <vector>

namespace isostat::crafted {

/// N_f + h = N + k for one contact list. `rank` is that of the matrix of the *stored* coordinates, mod 2^61 - 1: a
/// proved lower bound (T4), and the rank itself when it is as high as the counts allow (`rank_exact`); else h and k are
/// proved upper bounds, too large with a chance of about N / 2^61.
struct PlateauCounts {
    int dof_count = 0;      ///< N_f
    int contact_count = 0;  ///< N
    int rank = 0;           ///< of H
    int hyperstaticity = 0; ///< h = N - rank
    int mechanisms = 0;     ///< k = N_f - rank, common rigid motions included
    int rigid_motions = 0;  ///< rigid motions of the whole packing: 3 for a free cluster, 0 in a box
    int turns = 0;          ///< of rotational rattlers: bodies of which one member (in space one or two) has contacts
    Verdict rank_exact = Verdict::undecided;
    /// h = 0 and no internal mechanism but `turns`. `proved` or `refuted` (N and N_f alone already differ, or the rank
    /// is exact), else `undecided`.
    Verdict isostatic = Verdict::undecided;
};

/// Counts with every pair of gap <= `threshold` as a contact: once with all disks, and once for the backbone, that is
/// without the disks and the contacts that can carry no force >= 0 by the position of the normals around the disks
/// (`DiskHold`; contacts are not counted, no forces, no load). Of clumps the counts are those of rigid bodies: 3
/// degrees of freedom in the plane, and a body carries where forces >= 0 and their torques balance (in space only the
/// forces are asked). A rotational rattler turns about what it is held by, which changes no gap: N = N_f - turns is
/// isostatic.
struct PlateauStep {
    double threshold = 0;
    int candidate_count = 0; ///< pairs and walls at gap <= threshold
    int rattlers = 0;        ///< disks, or bodies, that are not in the backbone
    PlateauCounts backbone;
    PlateauCounts all;
};

/// Thresholds t with first <= t < last; both ends are exact: the smallest doubles that are not below the gap of the
/// contact that makes the range begin, and of the one that ends it.
struct PlateauRange {
    double first = 0;
    double last = 0;    ///< the largest requested threshold when the range is `open`
    bool open = false;  ///< the range goes on beyond the largest threshold
    int contacts = 0;   ///< N of the backbone at `first`
    int rattlers = 0;   ///< at `first`
    int candidates = 0; ///< at `first`
    bool told = false;  ///< some threshold in it gives this list for all gaps within `rounding` of these
};

/// The widest range with a backbone in which N - N_f does not change. Gaps on its two sides differ by the largest
/// factor, so its counts belong to the packing, while the order of gaps that are equal but for their digits is noise.
struct PlateauHeadline {
    PlateauRange range;
    PlateauCounts counts; ///< counts of the largest list in the range
};

struct Plateau {
    std::vector<PlateauStep> steps; ///< one per requested threshold, increasing
    /// Where the backbone is isostatic, proved at *every* threshold up to the largest one, not only at those of
    /// `steps`: h only grows with the contacts, so one rank at the largest list with h = 0 proves all smaller ones, and
    /// there k = N_f - N is a count.
    std::vector<PlateauRange> ranges;
    std::optional<PlateauHeadline> widest; ///< absent: no threshold has a backbone
    double rounding = 0;                   ///< bound of the error of the gaps, as given, or that of doubles
    /// Width on a logarithmic scale above `rounding`, on both sides of 0.
    [[nodiscard]] double width(const PlateauRange& range) const;
    /// Ranges where counting would say isostatic (N = N_f without the rigid motions) and the rank does not: a special
    /// position. Not proved (a rank mod p that is too low has a chance of about N / 2^61).
    std::vector<PlateauRange> special;
    /// The same as `ranges` for all disks: at most one.
    std::vector<PlateauRange> ranges_all;
    double no_self_stress_below = 0;  ///< proved: h = 0 in the backbone at every threshold < this
    bool no_self_stress_open = false; ///< h = 0 up to the largest threshold
    double deepest_overlap = 0;       ///< the smallest gap, rounded up (negative: overlap); infinity without candidates
    int candidates = 0;               ///< pairs and walls at gap <= the largest threshold
    int changes = 0;                  ///< number of different gaps among them, at which the contact list changes
    int ranks_computed = 0;           ///< eliminations; the other ranks follow because h and the rank are monotonic
};

/// Largest mean number, per disk, of pairs at gaps up to the largest threshold; more are refused.
inline constexpr int most_pairs_per_disk = 50;

/// \pre finite coordinates. \p thresholds in the unit of length, increasing, any sign (soft packings overlap). Gaps are
/// compared exactly, with each other and with the thresholds, as the real numbers that the stored doubles define. The
/// counts are not those of a true configuration nearby. Throws `Error(bad_input)` for lengths beyond 1e+-100, for
/// bodies that are bounded by arcs, have a fixed member or dependent bars, when two disks have the same centre, and for
/// more pairs than `most_pairs_per_disk`. Cost at n = 10^4 (10^5): sorting and rattlers of all thresholds together 0.1
/// s (1.5 s), each rank 0.03 s (0.7 s). Periodic axes: contacts with images, and pairs with several. Where all axes are
/// periodic the cell may strain as `strain` says: `isotropic` is for a packing jammed at fixed shape, whose one
/// self-stress a pressure balances (h = 0 here is h = 1 in a fixed cell with the same contacts). Throws when a disk
/// comes near its own image.
Plateau plateau(const Packing& packing, const std::vector<double>& thresholds, Strain strain = Strain::isotropic);

/// The same for every gap in [first, last] at which the contact list changes, thinned to about `rows` thresholds (0:
/// all are kept): half of them evenly over the changes at gaps > 0, from the last overlap on, half evenly over the
/// decades, and the thresholds next to the ends of the ranges. `first` and `last` are always kept. Ranges lie in
/// [first, last]. \p rounding: bound of the error of a gap; at least the bound for doubles is taken.
Plateau plateau(const Packing& packing, double first, double last, int rows, Strain strain = Strain::isotropic,
                double rounding = 0);

/// The contacts that `PlateauStep::backbone` counts at a threshold, sorted.
std::vector<Contact> backbone_at(const Packing& packing, double threshold);

} // namespace isostat::crafted
