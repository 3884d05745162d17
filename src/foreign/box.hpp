#pragma once
// Walls and cells around the grains of a raw packing.

#include "foreign/source.hpp"

namespace isostat::foreign {

/// Combines in `raw` the statements of file and user on bounds and periodic axes. A stated box that is the cell is
/// removed from `options`. Throws where the statements contradict each other, and for unsupported boundaries.
void settle_bounds(Raw& raw, std::size_t axes, const std::string& source, ForeignOptions& options);

/// Adds the walls, or the cell with the grains in it. Returns the largest rounding of a coordinate. \pre settled
double add_box(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options);

} // namespace isostat::foreign
