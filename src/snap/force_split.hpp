#pragma once
/// \file
/// The error of the forces of soft grains, in parts.

#include <isostat/snap/snap.hpp>

#include <limits>
#include <string>
#include <vector>

namespace isostat::compare {

/// Factor of forces over exact ones by least squares, and the largest difference left, in mean forces. Rounded.
struct Units {
    double factor = std::numeric_limits<double>::quiet_NaN();
    double left = std::numeric_limits<double>::quiet_NaN();
    /// Words on forces that differ by more than `agreement`: other units, or no forces.
    [[nodiscard]] std::string words(double agreement) const;
};
/// Forces that are NaN are left out.
Units units_of(const std::vector<double>& forces, const std::vector<double>& exact, double mean);

/// Errors over the mean force; NaN: not known.
struct ForceSplit {
    /// Largest |f_file - f(H(q_soft))|, the exact solve at the soft place: grains that are not at rest, other loads. In
    /// an isotropic cell the exact forces are scaled to the same mean force.
    double rest = std::numeric_limits<double>::quiet_NaN();
    /// Largest |f(H(q_soft)) - f(H(q*))|: the effect of the overlaps.
    double stiffness = std::numeric_limits<double>::quiet_NaN();
    Contact worst; ///< contact with the error `rest`
    Units units;   ///< compares the forces of the file with those of `rest`
};

/// \p forces: those of the file, one per contact of `soft`; NaN: not given. \p mean: the mean force. \pre `snap` is of
/// `soft`, h = k = 0. Upper bounds, both solves with proved bounds.
ForceSplit split_forces(const SoftState& soft, const std::vector<double>& forces, double mean, const Snap& snap);

/// The same for soft grains that close more contacts than rigid grains do: errors over the mean force; NaN: not known.
/// The forces of a list with h > 0 balance for any amount of its
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

/// Mean of the given positive forces; 0: there is none.
double mean_force(const std::vector<double>& forces);

} // namespace isostat::compare
