#pragma once
/// \file
/// The error of the forces of soft grains that close more contacts than rigid grains do.

#include <isostat/snap/snap.hpp>

#include <limits>
#include <vector>

namespace isostat::compare {

/// Errors over the mean force; NaN: not known. The forces of a list with h > 0 balance for any amount of its
/// self-stresses, so the list has no exact forces. These quantities are well defined:
struct SurplusSplit {
    /// Largest |f_file - g|, g the forces that balance at the soft place and are nearest to those of the file (sum of
    /// squares), up to rounding: the part of the file along the self-stresses is kept. Upper bound.
    double rest = std::numeric_limits<double>::quiet_NaN();
    /// Largest |g - f*|, f* the forces of the vertex downhill, with 0 for contacts that one list lacks. Upper bound for
    /// that vertex, which is not proved to be the only one near.
    double downhill = std::numeric_limits<double>::quiet_NaN();
    /// Largest component of the part of g - f* along the self-stresses, in doubles: the load on the surplus contacts.
    /// The remainder of `downhill` is due to the overlaps.
    double self_stress = std::numeric_limits<double>::quiet_NaN();
};

/// \p forces: those of the file, one per contact of `soft`. \p downhill: null, or the
/// proved vertex that `exchange` found. Nothing is known when a force is not given,
/// or when no isostatic part of the list is proved. \pre `snap` is of `soft`, k = 0.
SurplusSplit split_surplus(const SoftState& soft, const std::vector<double>& forces, double mean, const Snap& snap,
                           const Exchanged* downhill);

} // namespace isostat::compare
