#pragma once
/// \file
/// The regular triangulation of spheres, made by CGAL.

#include <isostat/packing/packing.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace isostat {

/// The edges (i, j), i < j, of a regular triangulation of the centres with weights fl(R^2), by exact predicates:
/// statements T5 and T6 say which pairs are edges. Empty where a sphere is hidden or equal to another. Centres in one
/// plane, or on one line, are triangulated in it. Cost: O(n log n) for packings. \pre `packing.dimension` is 3; squares
/// of lengths neither over- nor underflow
std::optional<std::vector<std::pair<int, int>>> regular_edges_in_space(const Packing& packing);

} // namespace isostat
