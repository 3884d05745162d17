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

/// Mean of the given positive forces; 0: there is none.
double mean_force(const std::vector<double>& forces);

} // namespace isostat::compare
