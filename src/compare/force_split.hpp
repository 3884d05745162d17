#pragma once
/// \file
/// The error of the forces of soft grains, in parts.

#include <isostat/compare/snap.hpp>

#include <limits>
#include <vector>

namespace isostat::compare {

/// Over the mean force; NaN: not known.
struct ForceSplit {
    /// Largest |f_file - f(H(q_soft))|, the exact solve at the soft place: grains that are not at rest, other loads. In
    /// an isotropic cell the latter are taken times the factor that makes the mean forces equal.
    double rest = std::numeric_limits<double>::quiet_NaN();
    /// Largest |f(H(q_soft)) - f(H(q*))|: what the overlaps change.
    double stiffness = std::numeric_limits<double>::quiet_NaN();
    Contact worst; ///< where `rest` is
};

/// \p forces: those of the file, one per contact of `soft`; NaN: not said. \p mean: the mean force. \pre `snap` is of
/// `soft`, h = k = 0. Upper bounds, both solves proved to their bound.
ForceSplit split_forces(const SoftState& soft, const std::vector<double>& forces, double mean, const Snap& snap);

/// Mean of the forces that are said and positive; 0: there is none.
double mean_force(const std::vector<double>& forces);

} // namespace isostat::compare
