#pragma once
// Common rigid motions of a packing.

#include <isostat/exact/number.hpp>
#include <isostat/packing/packing.hpp>

#include <functional>

namespace isostat::crafted {

/// Dimension of the common rigid motions of the grains that take part: those that neither a fixed grain nor a wall
/// takes away and that move some grain. Of spheres without walls 6, of collinear ones 5, of one 3. Along periodic axes
/// a grain is pinned. `at`: what stands at a coordinate, exactly. Where walls and periods leave nothing, `at` is not
/// asked. Cost O(1), unless the grains are on one line.
int rigid_motions(const Packing& packing, const std::function<bool(int)>& takes_part,
                  const std::function<exact::Number(std::size_t)>& at);

} // namespace isostat::crafted
