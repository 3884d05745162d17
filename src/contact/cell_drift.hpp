#pragma once
// How far the grains have moved since a list of candidates was found, in a periodic cell: private to the library.

#include "contact/candidates.hpp"

namespace isostat {

/// Does not count the affine part of the motion, nor the common motion along periodic axes (proofs/cells.md, C8).
struct CellDrift {
    /// The list is complete while this is below half its
    /// reach. Infinity: the list was found for other grains.
    double used = 0;
    /// Largest growth of `used` per length that bounds the displacement of
    /// every grain and wall and the change of the cell (Frobenius norm).
    double rate = 1;
};

/// \pre there are periodic axes. Cost: O(n).
CellDrift cell_drift(const CandidateList& list, const Packing& packing);

/// Largest growth of `used` along a displacement of all coordinates:
/// a norm of the displacement. \pre `list` is of these grains
double drift_along(const CandidateList& list, const Packing& packing, const std::vector<double>& displacement);

} // namespace isostat
