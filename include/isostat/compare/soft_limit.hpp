#pragma once
/// \file
/// What finite stiffness does to an equilibrium: predictions in double precision, not proved.

#include <isostat/contact/state.hpp>

#include <optional>
#include <vector>

namespace isostat::compare {

/// Forces of grains of stiffness K (force = K overlap) in the contacts of a state: gaps = -f / K and H f = F at the
/// same place, by Newton's method on the gaps and a solve in turn.
struct SoftEquilibrium {
    Packing<2> packing;
    std::vector<double> forces; ///< one per contact
    std::vector<double> slopes; ///< per unit of the loaded stress, at this place
};

/// The state at the loaded stress `sigma` with stiffness K. \pre `contacts` is isostatic near `state`. Nothing when the
/// iteration does not settle at 1e-12 of the smallest radius. Double precision, no bound.
std::optional<SoftEquilibrium> soften(const State<2>& state, double sigma, double stiffness);

/// The interval of the loaded stress in which the rigid grains of a state are supported, and the end that is looked at.
struct ExactInterval {
    double low = 0, high = 0;
    int direction = +1; ///< +1: `high`, -1: `low`
    [[nodiscard]] double end() const { return direction > 0 ? high : low; }
};

/// Where the loaded stress takes away the first force of the soft grains, looked for from the middle of the exact
/// interval towards its end and beyond. \pre the interval is finite and positive, every contact of the state carries a
/// force (no rattlers). Nothing where the soft grains have a negative force in the middle already, where `soften` has
/// no answer, or where no force vanishes within twice the interval. Relative accuracy 1e-10.
struct SoftLimit {
    double stress = 0;
    Contact opens;
};
std::optional<SoftLimit> soft_limit(const State<2>& state, const ExactInterval& exact, double stiffness);

/// The stiffness at which the soft limit is within `error` (relative) of the exact one: the difference goes as 1 / K,
/// read off where it is small. Nothing as above.
std::optional<double> stiffness_needed(const State<2>& state, const ExactInterval& exact, double error = 1e-3);

} // namespace isostat::compare
