#pragma once
// Every pair of grains that is nearly in contact: from a grid of cells, which allows overlaps, so that soft packings
// have complete lists too.

#include <isostat/contact/state.hpp>

#include <limits>
#include <vector>

namespace isostat {

/// Every pair of grains with gap < reach (of the real numbers; rounding may add a few pairs beyond), for any packing,
/// sorted; members of one body are no pair, except through images. A function of the packing and the reach alone, and
/// complete without any hypothesis. In a cell: every pair of a grain and an image, each once, found among finitely many
/// images. Throws `Error(bad_input)` when there are more than `most_per_disk` for each disk.
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
