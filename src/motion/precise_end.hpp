#pragma once
// The end of an arc where the contacts are nearly singular: private to the rooms motion and trajectory.

#include "rigidity/isostatic.hpp"

#include <optional>
#include <vector>

namespace isostat {

/// An arc that was followed in double, and what is nearly singular there.
struct RoughEnd {
    const IsostaticStructure& structure; ///< at the start
    ContactId opened;
    Contact closed;
    const Packing& end;
    const std::vector<double>& tangent; ///< there, on coordinates, forwards
    double displacement;                ///< of the arc, largest of a coordinate
};

/// The coordinates nearest to the vertex with the contact that closed, by Newton's method with gaps in double-double
/// and fresh factors at each step. In double a gap that closes at a rate of 1e-8 is 0, to rounding, on a stretch of
/// 1e-8 and more, on which the matrix is another one. Where the gap nearly grazes there are two places: the iteration
/// begins a little before the end, from where it finds the first. Nothing: it did not converge. A guess: what is proved
/// of it is for the caller. Cost: some 20 factorisations.
std::optional<Packing> precise_end(const RoughEnd& rough);

} // namespace isostat
