#pragma once
/// \file
/// Complete lists of contact candidates and the certificate of non-overlap (proofs/contact_candidates.md); how far the
/// grains of a periodic cell have moved since a list was found.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace isostat {

class RegularTriangulation;

/// Of the smallest radius: how far candidates are listed, and the most that statement T6 allows.
inline constexpr double candidate_fraction = 0.8;          // cost: below the 0.82 of contact_candidates.md
inline constexpr double largest_candidate_fraction = 0.82; // contact_candidates.md Rounded weights

/// Every pair that can come into contact before the displacements exceed the list's reach.
struct CandidateList {
    std::vector<Contact> contacts; ///< sorted; all with gap < reach, and perhaps a few beyond by rounding
    double reach = 0; ///< delta: complete as long as twice the largest displacement since `reference` < delta
    std::vector<double> reference; ///< q at which the list was made
    /// Whose edges the disk pairs are; null when they were found by the grid. Shared by copies, never changed.
    std::shared_ptr<const RegularTriangulation> triangulation;

    /// True when the list is still complete at `packing`: 2 max_i |x_i - x_i^ref| < reach, (Lx, Ly) counted as one
    /// more point, roundings included. One-sided: false only means that the list must be rebuilt (also for NaN, or
    /// another number of disks). Cost O(n).
    /// With `radius` > 0: complete in every configuration within that distance (2-norm) of `packing`. In a cell
    /// displacements are those from the affine motion of the cell (proofs/cells.md, C8).
    [[nodiscard]] bool covers(const Packing& packing, double radius = 0) const;
    /// In a box: the largest displacement since `reference`, in units of the reach. \pre as many coordinates
    [[nodiscard]] double moved_in_box(const Packing& packing) const;
};

/// Whether the two grains of a pair can move relative to each other at all: not two fixed disks, nor a fixed disk and a
/// wall that is not movable, nor a disk and its own image where the periods between them do not move.
bool can_move(const Packing& packing, const Contact& pair);

/// A pair of grains that cannot move relative to each other and that overlaps, exactly: such a packing is in no
/// equilibrium *without overlap*, whatever else is proved of it (proofs/definition.md). Cost: none without fixed disks,
/// else that of a search for candidates.
std::optional<Contact> fixed_overlap(const Packing& packing);

/// Candidates with gap < fraction * R_min, \pre 0 < fraction <= 0.82, every coordinate and radius finite. Pairs
/// that cannot move relative to each other (two fixed disks, a fixed disk and a wall that is not movable) are left
/// out. The list is complete without further condition:
/// - when the regular triangulation with weights R^2 shows that no two disks overlap by more than about 5e-4
///   R_min^2 / R, its edges are complete (statements T5 and T6 with rounded weights, proofs/contact_candidates.md).
///   It is made by CGAL, O(n log n), or carried along from an earlier list: `from`, a triangulation of the same disks
///   at other places, is flipped until exact predicates prove every edge regular, O(n);
/// - otherwise (deeper overlaps, size ratios above 1e5, lengths beyond 1e+-100) a grid finds them; O(n) where
///   the radii are comparable, else O(n^1.5) at most.
/// In a cell: pairs with all images (proofs/cells.md, C3), nothing carried along. Walls by a scan. `contacts` depends
/// on the packing and the fraction alone, not on `from` nor on what found them.
CandidateList find_candidates(const Packing& packing, double fraction,
                              const std::shared_ptr<const RegularTriangulation>& from = nullptr);

/// Result of `certify_admissible`.
struct Admissibility {
    Verdict verdict = Verdict::undecided; ///< proved: no overlap by more than `allowance`; refuted: `worst` does
    double worst_gap = 0;                 ///< rounded; the smallest gap met; infinity when no pair is near
    Contact worst;                        ///< where (not set when no pair is near)
};

/// Whether no pair of grains (all pairs, fixed disks and walls included) overlaps by more than `allowance`, a
/// length >= 0. The candidates are complete (as for `find_candidates`), and the sign of gap + allowance is decided
/// for each of them over the reals that the stored doubles are: double with an error bound, double-double with an
/// error bound, rationals. So the verdict is `proved` or `refuted`, never `undecided`; exact tangency is
/// admissible. \pre every coordinate and radius finite. It speaks of the stored packing, not of a true one near it.
/// Cost: as `find_candidates`.
/// `known`: a list to use when it was made at this very configuration (and no disk is fixed: it leaves out pairs that
/// cannot move), so that the search is saved; else its triangulation is carried here.
Admissibility certify_admissible(const Packing& packing, double allowance, const CandidateList* known = nullptr);

/// Does not count the affine part of the motion, nor the common motion along periodic axes (proofs/cells.md, C8).
struct CellDrift {
    /// The list is complete while this is below half its
    /// reach. Infinity: the list was found for other grains.
    double used = 0;
    /// Largest growth of `used` per length that bounds the displacement of
    /// every grain and wall and the change of the cell (Frobenius norm).
    double rate = 1;
};

/// \pre there are periodic axes. Cost: O(n).
CellDrift cell_drift(const CandidateList& list, const Packing& packing);

/// Largest growth of `used` along a displacement of all coordinates:
/// a norm of the displacement. \pre `list` is of these grains
double drift_along(const CandidateList& list, const Packing& packing, const std::vector<double>& displacement);

} // namespace isostat
