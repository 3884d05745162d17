#pragma once
/// \file
/// The error of the forces of soft grains that close more contacts than rigid ones.

#include <isostat/snap/snap.hpp>

#include <limits>
#include <vector>

namespace isostat::compare {

/// Over the mean force; NaN: not known. The forces of a list with h > 0 balance for any amount of its self-stresses, so
/// there is no exact force on it. What is well defined:
struct SurplusSplit {
    /// Largest |f_file - g|, g the forces that balance at the soft place and are nearest to those of the file (sum of
    /// squares), but for rounding: the file's part along the self-stresses is kept. Upper bound.
    double rest = std::numeric_limits<double>::quiet_NaN();
    /// Largest |g - f*|, f* the forces of the vertex downhill, 0 where one of the lists lacks a contact. Upper bound,
    /// against that vertex: that it is the only one near is not proved.
    double downhill = std::numeric_limits<double>::quiet_NaN();
    /// Largest component of the part of g - f* along the self-stresses, in doubles: what the surplus contacts carry.
    /// The remainder of `downhill` is due to the overlaps.
    double self_stress = std::numeric_limits<double>::quiet_NaN();
};

/// \p forces: those of the file, one per contact of `soft`. \p downhill: null, or the vertex that `exchange` found,
/// proved. Nothing is known when a force is not said, or when no isostatic part of the list is proved. \pre `snap` is
/// of `soft`, k = 0.
SurplusSplit split_surplus(const SoftState& soft, const std::vector<double>& forces, double mean, const Snap& snap,
                           const Exchanged* downhill);

} // namespace isostat::compare
