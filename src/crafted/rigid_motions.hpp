#pragma once
// Common rigid motions of a packing.

#include <isostat/exact/number.hpp>
#include <isostat/packing/packing.hpp>

#include <functional>

namespace isostat::crafted {

/// Dimension of the common rigid motions of the grains that take part: those that no fixed grain and no wall prevents
/// and that move some grain. For spheres without walls 6, for collinear ones 5, for one 3. Along periodic axes a grain
/// is pinned. `at`: the exact value of a coordinate, unused where walls and periods prevent all motions. Cost O(1),
/// unless the grains are on one line.
int rigid_motions(const Packing& packing, const std::function<bool(int)>& takes_part,
                  const std::function<exact::Number(std::size_t)>& at);

} // namespace isostat::crafted
