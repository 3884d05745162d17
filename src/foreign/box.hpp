#pragma once
// Walls and cells around the grains of a raw packing.

#include "foreign/source.hpp"

namespace isostat::foreign {

/// What the file and the user say of bounds and of periodic axes, settled in `raw`. A stated box that is the cell is
/// taken out of `options`. Throws where they contradict each other, and for boundaries that are not taken.
void settle_bounds(Raw& raw, std::size_t axes, const std::string& source, ForeignOptions& options);

/// Adds the walls, or the cell with the grains in it. By how much that rounds a coordinate. \pre settled
double add_box(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options);

} // namespace isostat::foreign
