#pragma once
/// \file
/// Every pair of disks closer than a given reach, by a grid of cells. Overlaps are allowed, so that soft packings have
/// complete lists too.

#include <isostat/contact/contact.hpp>
#include <isostat/packing/packing.hpp>

#include <limits>
#include <vector>

namespace isostat::preparation {

/// Pairs i < j, grouped by i: partners of i are `partner[start[i]] .. partner[start[i + 1] - 1]`, increasing.
struct PairList {
    std::vector<int> start;   ///< n + 1
    std::vector<int> partner; ///< one per pair
};

/// All pairs with gap < reach: complete for any positions and radii. `x` holds the coordinates of the disks first, as
/// `Packing::q` does. The answer does not depend on the grid, hence not on rounding of the cell numbers. Cost O(n) for
/// comparable radii. Throws `Error(bad_input)` when they are more than `most`.
void find_pairs(int dimension, const std::vector<double>& x, const std::vector<double>& radius, double reach,
                PairList& pairs, int most = std::numeric_limits<int>::max());

/// The same with the disks near walls: pairs and lower walls with gap < `reach`, upper walls with gap < `upper_reach`,
/// sorted. In a cell: pairs with the images of another disk too, those with gap < `reach` + `upper_reach`, as a period
/// moves as far as an upper wall.
std::vector<Contact> near_contacts(const Packing& packing, double reach, double upper_reach);

} // namespace isostat::preparation
