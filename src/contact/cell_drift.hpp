#pragma once
// How far a list of candidates has come from where it was found, in a periodic cell: private to the library.

#include "contact/candidates.hpp"

namespace isostat {

/// The affine part of the motion is taken out, and what all grains share along periodic axes (proofs/cells.md, C8).
struct CellDrift {
    /// The list is complete while this is below half its reach. Infinity: the list was found for
    /// other grains.
    double used = 0;
    /// What `used` grows by at most, per length that bounds the displacement of every grain and wall and the change of
    /// the cell (Frobenius norm).
    double rate = 1;
};

/// \pre there are periodic axes. Cost: O(n).
CellDrift cell_drift(const CandidateList& list, const Packing& packing);

/// What `used` grows by at most along a displacement of all coordinates: it is a norm of that. \pre `list` is of these
/// grains
double drift_along(const CandidateList& list, const Packing& packing, const std::vector<double>& displacement);

} // namespace isostat
