#pragma once
// Every pair of disks closer than a given reach, by a grid of cells.
// Overlaps are allowed, so that soft packings have complete lists too.

#include <limits>
#include <vector>

namespace isostat {

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

} // namespace isostat
