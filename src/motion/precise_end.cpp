#include "core/dot.hpp"
#include "linear/factorisation.hpp"
#include "motion/arc.hpp"
#include "verified/corrected_configuration.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

/// The start of the iteration: before the end found in double, on the curve up to (1e-6)^2.
Packing a_little_before(const RoughEnd& rough) {
    // guess: where the iteration begins
    constexpr double back = 1e-6; // of a radius: a hundred times the stretch on which a gap is 0 to rounding
    Packing at = rough.end;
    const double speed = largest(rough.tangent);
    const double way = std::min(back * at.min_radius(), 0.5 * rough.displacement); // guess: where the iteration begins
    for (std::size_t k = 0; k < rough.tangent.size() && speed > 0; ++k) {
        at.q[k] -= way / speed * rough.tangent[k];
    }
    return at;
}

/// The step that closes the gaps of `at` + `correction`; empty: the contacts are singular, structurally or in double.
std::vector<double> newton_step(const RoughEnd& rough, const Packing& at, const std::vector<dd_real>& correction) {
    Packing rounded = at;
    for (std::size_t k = 0; k < correction.size(); ++k) {
        rounded.q[k] += correction[k].x[0];
    }
    auto contacts = IsostaticStructure::exchange(rough.structure, rounded, rough.opened, rough.closed);
    if (!contacts) {
        return {};
    }
    const auto there = IsostaticStructure::without_proof(std::move(*contacts));
    const CorrectedConfiguration<dd_real> place(Arithmetic<dd_real>(), at, correction);
    std::vector<double> step;
    for (const Contact& contact : there.contacts()) {
        step.push_back(place.gap_function(contact).x[0]);
    }
    Factorisation(there).solve_velocities(step); // approach velocities equal to the gaps close them
    const auto finite = [](double x) { return std::isfinite(x); };
    return std::all_of(step.begin(), step.end(), finite) ? step : std::vector<double>(); // maxima do not see a NaN
}

} // namespace

std::optional<Packing> precise_end(const RoughEnd& rough) {
    constexpr int max_steps = 60; // cost: then there is no such end
    // guess: when Newton's method has converged
    constexpr double converged = 1e-22; // of a radius: coordinates are rounded to doubles afterwards
    Packing at = a_little_before(rough);
    std::vector<dd_real> correction(at.q.size(), dd_real(0.0));
    for (int k = 0; k < max_steps; ++k) {
        const std::vector<double> step = newton_step(rough, at, correction);
        const double size = step.empty() ? roundoff::infinity : largest(step);
        if (!(size <= 0.01 * at.min_radius())) { // guess: a longer step says that there is no end near
            return std::nullopt;
        }
        rough.structure.dofs().move(correction, step);
        if (size <= converged * at.min_radius()) {
            for (std::size_t c = 0; c < correction.size(); ++c) {
                at.q[c] = (dd_real(at.q[c]) + correction[c]).x[0];
            }
            snap_to_grid(at);
            return at;
        }
    }
    return std::nullopt;
}

} // namespace isostat
