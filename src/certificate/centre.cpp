#include "certificate/centre.hpp"

#include "core/roundoff.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using roundoff::u;

} // namespace

Centre::Centre(Packing p, IsostaticStructure s)
    : packing(std::move(p)), structure(std::move(s)), factorisation(structure) {
    InverseBoundCache cache;
    inverse = bound_inverse(structure, factorisation, cache);
    for (const Contact& contact : structure.contacts()) {
        const double h = std::abs(gap(packing, contact));
        const double length = target(packing, contact);
        largest_gap = std::max(largest_gap, (h + 8 * u * (h + length)) * (1 + 4 * u));
        relative_gap = std::max(relative_gap, h / length);
    }
    neighbourhood = Neighbourhood::of(packing, structure.contacts(), inverse);
}

Result<std::unique_ptr<Centre>> Centre::make(Packing packing, std::vector<Contact> contacts) {
    auto proved = IsostaticStructure::prove(packing, std::move(contacts));
    if (!proved.ok()) {
        return proved.failure();
    }
    return std::unique_ptr<Centre>(new Centre(std::move(packing), std::move(proved.value())));
}

std::unique_ptr<Centre> Centre::downhill(const Centre& start) {
    constexpr int max_iterations = 12; // quadratic convergence: six from a tenth of a radius
    const double reach = 0.1 * start.packing.min_radius();
    const Centre* here = &start;
    std::unique_ptr<Centre> next;
    for (int k = 0; k < max_iterations; ++k) {
        std::vector<double> step;
        for (const Contact& contact : here->structure.contacts()) {
            step.push_back(gap(here->packing, contact));
        }
        here->factorisation.solve_velocities(step); // approach velocities equal to the gaps close them
        Packing moved = here->packing;
        for (std::size_t mu = 0; mu < step.size(); ++mu) {
            const auto at = static_cast<std::size_t>(here->structure.dofs().coordinate_of(static_cast<int>(mu)));
            moved.q[at] += step[mu];
            if (!(std::abs(moved.q[at] - start.packing.q[at]) <= reach)) {
                return nullptr;
            }
        }
        auto made = make(std::move(moved), start.structure.contacts());
        if (!made.ok()) {
            return nullptr;
        }
        const bool better = made.value()->relative_gap < 0.5 * here->relative_gap;
        if (k > 0 && !better) {
            return here->relative_gap < 1e-3 ? std::move(next) : nullptr; // at the rounding of the gaps, or lost
        }
        next = std::move(made.value());
        here = next.get();
    }
    return next;
}

} // namespace isostat
