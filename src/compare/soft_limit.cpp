#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/compare/snap.hpp>

#include <algorithm>
#include <cmath>

namespace isostat::compare {

namespace {

constexpr int most_turns = 40;
constexpr double settled = 1e-12; ///< of the smallest radius
constexpr double same_stress = 1e-10;

} // namespace

std::optional<SoftEquilibrium> soften(const State<2>& state, double sigma, double stiffness) {
    SoftEquilibrium out{state.packing, {}, {}};
    Load<2> load = state.load;
    load.stress[static_cast<std::size_t>(load.loaded_axis)] = sigma;
    for (int turn = 0; turn < most_turns; ++turn) {
        const auto structure = IsostaticStructure<2>::prove(out.packing, state.contacts);
        if (!structure.ok()) {
            return std::nullopt;
        }
        const Factorisation factorisation(structure.value());
        const DofMap<2>& dofs = structure.value().dofs();
        out.forces = on_dofs(load.external_force(out.packing), dofs);
        factorisation.solve_forces(out.forces);
        std::vector<double> step(state.contacts.size());
        for (std::size_t l = 0; l < step.size(); ++l) {
            step[l] = gap(out.packing, state.contacts[l]) + out.forces[l] / stiffness; // approach by that
        }
        factorisation.solve_velocities(step);
        double largest = 0;
        for (std::size_t mu = 0; mu < step.size(); ++mu) {
            out.packing.q[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)))] += step[mu];
            largest = std::max(largest, std::abs(step[mu]));
        }
        if (largest <= settled * out.packing.min_radius()) {
            out.slopes = on_dofs(load.unit_force(out.packing), dofs);
            factorisation.solve_forces(out.slopes);
            return out;
        }
    }
    return std::nullopt;
}

namespace {

/// The smallest force at a stress, and where.
struct Weakest {
    double stress = 0, force = 0;
    Contact contact;
};

std::optional<Weakest> weakest(const State<2>& state, double stress, double stiffness) {
    const auto soft = soften(state, stress, stiffness);
    if (!soft) {
        return std::nullopt;
    }
    const auto least = std::min_element(soft->forces.begin(), soft->forces.end());
    return Weakest{stress, *least, state.contacts[static_cast<std::size_t>(least - soft->forces.begin())]};
}

} // namespace

std::optional<SoftLimit> soft_limit(const State<2>& state, const ExactInterval& exact, double stiffness) {
    const double middle = 0.5 * (exact.low + exact.high);
    auto inside = weakest(state, middle, stiffness);
    auto outside = weakest(state, exact.end(), stiffness);
    if (inside && outside && outside->force > 0) { // softer grains hold longer
        inside = outside;
        outside = weakest(state, exact.end() + (exact.end() - middle), stiffness);
    }
    if (!inside || !outside || !(inside->force > 0) || outside->force > 0) {
        return std::nullopt;
    }
    double halved = 1; // Illinois: of the side that stays
    int stayed = 0;
    for (int turn = 0; turn < most_turns; ++turn) {
        const double a = inside->force * (stayed > 0 ? halved : 1), b = outside->force * (stayed < 0 ? halved : 1);
        const double stress = inside->stress + (outside->stress - inside->stress) * a / (a - b);
        const auto next = weakest(state, stress, stiffness);
        if (!next) {
            return std::nullopt;
        }
        const bool in = next->force > 0;
        halved = stayed == (in ? -1 : 1) ? 0.5 * halved : 0.5;
        stayed = in ? -1 : 1;
        (in ? inside : outside) = next;
        if (std::abs(outside->stress - inside->stress) <= same_stress * stress ||
            std::abs(next->force) <= same_stress * std::abs(inside->force - outside->force)) {
            return SoftLimit{next->stress, next->contact};
        }
    }
    return std::nullopt;
}

std::optional<double> stiffness_needed(const State<2>& state, const ExactInterval& exact, double error) {
    const double stress = state.load.stress[0];
    constexpr double stiff = 1e8; // in sigma_1: far inside the range where the difference goes as 1 / K
    const auto limit = soft_limit(state, exact, stiff * stress);
    return limit ? std::optional(stiff * stress * std::abs(limit->stress - exact.end()) / (error * exact.end()))
                 : std::nullopt;
}

} // namespace isostat::compare
