#pragma once
// Every pair of disks that is nearly in contact: from the regular triangulation where statements T5 and T6 apply, from
// a grid of cells otherwise, which allows overlaps, so that soft packings have complete lists too.

#include "contact/regular_triangulation.hpp"

#include <isostat/contact/state.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// Sorted pairs, and the triangulation with these edges (null: the grid found the pairs).
struct NearPairs {
    std::vector<Contact> pairs;
    std::shared_ptr<const RegularTriangulation> triangulation;
};

/// Every pair of disks with gap < reach (of the real numbers; rounding may add a few pairs
/// beyond), for any packing; members of one body are no pair, except through images. The pairs
/// are a function of the packing and the reach alone: neither the method nor `from`, an optional
/// triangulation of the same disks elsewhere that is carried to these places, changes them. In a
/// cell: every pair of a disk and an image, each once; found among finitely many images, without
/// a triangulation that could be carried. \pre reach > 0; the grid finds pairs beyond 0.82 R_min
NearPairs near_pairs(const Packing& packing, double reach,
                     const std::shared_ptr<const RegularTriangulation>& from = nullptr);

/// The pairs of `near_pairs` among the edges of the triangulation. Empty when an edge overlaps by more than about 5e-4
/// R_min^2 / R, because the completeness theorem does not apply then.
std::optional<std::vector<Contact>> near_edges(const Packing& packing, double reach,
                                               const RegularTriangulation& triangulation);

/// As `near_edges`, for spheres, with a triangulation made for this call. Empty also where a sphere is hidden.
std::optional<std::vector<Contact>> near_edges_in_space(const Packing& packing, double reach);

/// The same pairs from the grid: complete without any hypothesis. Throws `Error(bad_input)` when there are more than
/// `most_per_disk` for each disk.
std::vector<Contact> pairs_within(const Packing& packing, double reach,
                                  int most_per_disk = std::numeric_limits<int>::max());

/// Leaves out pairs of members of one body (a member and an image of another one are a pair), and of bodies bounded by
/// arcs all members but the nearest two (`ArcBodies::is_nearest`).
void without_hidden_pairs(std::vector<Contact>& pairs, const Packing& packing);

/// Pairs i < j, grouped by i: partners of i are `partner[start[i]] .. partner[start[i + 1] - 1]`, increasing.
struct PairList {
    std::vector<int> start;   ///< n + 1
    std::vector<int> partner; ///< one per pair
};

/// All pairs with gap < reach, and perhaps a few beyond by rounding: complete for any finite positions and radii
/// (proofs/contact_candidates.md). `x` holds the coordinates of the disks first, as `Packing::q` does. Cost O(n) for
/// comparable radii, O(n^1.5) for any. Throws `Error(bad_input)` when there are more than `most` pairs.
void find_pairs(int dimension, const std::vector<double>& x, const std::vector<double>& radius, double reach,
                PairList& pairs, int most = std::numeric_limits<int>::max());

/// Whether no square of a relevant length under- or overflows.
bool lengths_are_plain(const std::vector<double>& x, const std::vector<double>& radius);

/// The disks and walls near each other, of soft packings too: pairs of disks and lower walls with gap < `reach`, upper
/// walls with gap < `upper_reach`, sorted. In a cell also pairs with images of another disk, those with gap < `reach` +
/// `upper_reach`, because a period moves as far as an upper wall.
std::vector<Contact> near_contacts(const Packing& packing, double reach, double upper_reach);

} // namespace isostat
