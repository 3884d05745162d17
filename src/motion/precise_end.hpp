#pragma once
// The end of an arc where the contacts are nearly singular: private to the rooms motion and trajectory.

#include "rigidity/isostatic.hpp"

#include <optional>
#include <vector>

namespace isostat {

/// An arc that was followed in double to an end where the contacts are nearly singular.
struct RoughEnd {
    const IsostaticStructure& structure; ///< structure at the start
    ContactId opened;
    Contact closed;
    const Packing& end;
    const std::vector<double>& tangent; ///< tangent at the end, on coordinates, forwards
    double displacement;                ///< largest displacement of a coordinate along the arc
};

/// The coordinates nearest to the vertex with the contact that closed, by Newton's method with gaps in double-double
/// and fresh factors at each step. In double a gap that closes at a rate of 1e-8 is 0, up to rounding, on a stretch of
/// 1e-8 or more, and the matrix changes along this stretch. Where the gap nearly grazes, two places have gap 0: the
/// iteration begins a little before the end, so that it finds the first. Nothing: no convergence. The result is a
/// guess; the caller has to prove what it needs. Cost: some 20 factorisations.
std::optional<Packing> precise_end(const RoughEnd& rough);

} // namespace isostat
