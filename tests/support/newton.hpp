#pragma once
// Newton's method in double, for packings that tests make.

#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"
#include "support/test.hpp"

namespace crafted {

/// One step towards the place where these contacts have these gaps.
inline void step_to_gaps(isostat::Packing& packing, const std::vector<isostat::Contact>& contacts,
                         const std::vector<double>& gaps) {
    const auto structure = required(isostat::IsostaticStructure::prove(packing, contacts));
    std::vector<double> step;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        step.push_back(isostat::gap(packing, contacts[l]) - gaps[l]);
    }
    isostat::Factorisation(structure).solve_velocities(step);
    structure.dofs().move(packing.q, step);
}

} // namespace crafted
