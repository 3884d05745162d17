#include "core/dot.hpp"
#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"
#include "statics/quotient.hpp"

#include <isostat/snap/snap.hpp>

#include <algorithm>
#include <cmath>

namespace isostat::compare {

namespace {

constexpr int most_turns = 40;
constexpr double settled = 1e-12; ///< in smallest radii
constexpr double same_stress = 1e-10;

/// Soft grains in Newton's iteration towards gaps = -f / K: the forces at the current positions, and one step.
class SoftGrains {
  public:
    SoftGrains(const State& state, double stiffness)
        : contacts_(state.contacts), load_(state.load), stiffness_(stiffness), dofs_(state.packing),
          packing(state.packing) {}

    /// Computes forces and their slopes at the current positions under the loaded stress `sigma`. False: the matrix is
    /// singular, or the grains are so soft that a step left the range of double.
    bool solve(double sigma) {
        if (!std::ranges::all_of(packing.q, [](double x) { return std::isfinite(x); })) {
            return false;
        }
        const auto structure = IsostaticStructure::prove(packing, contacts_);
        if (!structure.ok()) {
            return false;
        }
        factors_.emplace(structure.value());
        load_.set_loaded_stress(sigma);
        forces = on_dofs(load_.external_force(packing), dofs_);
        slopes = on_dofs(load_.unit_force(packing), dofs_);
        factors_->solve_forces(forces);
        factors_->solve_forces(slopes);
        return true;
    }
    /// Takes the step towards the gaps that belong to `forces`; true when no coordinate moved.
    bool move() {
        std::vector<double> step(contacts_.size());
        for (std::size_t l = 0; l < step.size(); ++l) {
            step[l] = gap(packing, contacts_[l]) + forces[l] / stiffness_; // the approach that the step must make
        }
        factors_->solve_velocities(step);
        dofs_.move(packing.q, step);
        return largest(step) <= settled * packing.min_radius();
    }

  private:
    const std::vector<Contact>& contacts_;
    Load load_;
    double stiffness_;
    DofMap dofs_;
    std::optional<Factorisation> factors_;

  public:
    Packing packing;
    std::vector<double> forces, slopes;
};

/// The first force to vanish from `middle` ahead, with forces linear in the stress at fixed positions. Empty: a force
/// is not positive in the middle, or no force vanishes.
std::optional<Vanishing> first_ahead(const SoftGrains& grains, double sigma, double middle, int direction) {
    std::vector<double> force = grains.forces;
    for (std::size_t l = 0; l < force.size(); ++l) {
        force[l] += (middle - sigma) * grains.slopes[l];
    }
    if (!std::ranges::all_of(force, [](double f) { return f > 0; })) {
        return std::nullopt;
    }
    return first_to_vanish(
        force.size(), [&](std::size_t l) { return force[l]; },
        [&](std::size_t l) { return direction * grains.slopes[l]; });
}

} // namespace

std::optional<SoftEquilibrium> soften(const State& state, double sigma, double stiffness) {
    SoftGrains grains(state, stiffness);
    for (int turn = 0; turn < most_turns; ++turn) {
        if (!grains.solve(sigma)) {
            return std::nullopt;
        }
        if (grains.move()) {
            return SoftEquilibrium{std::move(grains.packing), std::move(grains.forces), std::move(grains.slopes)};
        }
    }
    return std::nullopt;
}

std::optional<SoftLimit> soft_limit(const State& state, const ExactInterval& exact, double stiffness) {
    const double middle = 0.5 * (exact.low + exact.high), half = std::abs(exact.end() - middle);
    SoftGrains grains(state, stiffness);
    double sigma = middle; // positions and stress change together: one solve per turn
    for (int turn = 0; turn < most_turns; ++turn) {
        if (!grains.solve(sigma)) {
            return std::nullopt;
        }
        const auto next = first_ahead(grains, sigma, middle, exact.direction);
        if (!next || next->distance > 2 * half) {
            return std::nullopt;
        }
        const double stress = middle + exact.direction * next->distance;
        for (std::size_t l = 0; l < grains.forces.size(); ++l) {
            grains.forces[l] += (stress - sigma) * grains.slopes[l];
        }
        const bool same = std::abs(stress - sigma) <= same_stress * stress;
        sigma = stress;
        if (grains.move() && same) {
            return SoftLimit{sigma, state.contacts[next->index]};
        }
    }
    return std::nullopt;
}

std::optional<double> stiffness_needed(const State& state, const ExactInterval& exact, double error) {
    const double stress = state.load.stress[0];
    constexpr double stiff = 1e8; // in sigma_1: far inside the range where the difference is proportional to 1 / K
    const auto limit = soft_limit(state, exact, stiff * stress);
    return limit ? std::optional(stiff * stress * std::abs(limit->stress - exact.end()) / (error * exact.end()))
                 : std::nullopt;
}

} // namespace isostat::compare
