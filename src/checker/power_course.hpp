#pragma once
/// \file
/// The sign of the power of the load along a tube (proofs/checker.md, K20).

#include "checker/tube.hpp"

#include <vector>

namespace isostat::checker {

/// The load along the arc.
struct Pushing {
    std::vector<Bounds> fixed; ///< per coordinate
    /// True stresses: the force on the upper wall of an axis also has minus this times the lengths of the other axes.
    PerAxis<double> pressure{};
};

/// Whether F . q' is positive for all s in [from, to].
bool power_is_positive(const Pushing& load, const Moving& moving, const Tube& tube, double from, double to);

} // namespace isostat::checker
