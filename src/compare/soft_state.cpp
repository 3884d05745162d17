#include "compare/soft_state.hpp"

#include "compare/backbone.hpp"

#include <isostat/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace isostat::compare {

SoftForces soft_grains(const StateFile& file, const std::string& source) {
    State state = file.state;
    const bool fixed =
        std::any_of(state.packing.fixed.begin(), state.packing.fixed.end(), [](auto f) { return f != 0; });
    const bool box = state.packing.walls == Walls::box() || state.packing.cell.all();
    if (!box || fixed || !state.load.disk_force.empty()) {
        throw Error(ErrorKind::bad_input, source +
                                              ": expected a box with two fixed and two movable walls or a periodic "
                                              "cell, no fixed disk and no force on a disk");
    }
    SoftForces out;
    std::map<Contact, double> forces;
    for (std::size_t l = 0; l < file.forces.size(); ++l) {
        forces.emplace(state.contacts[l], file.forces[l]);
    }
    std::sort(state.contacts.begin(), state.contacts.end());
    state.contacts = able_to_carry(state.packing, std::move(state.contacts));
    for (std::size_t l = 0; l < state.contacts.size() && !forces.empty(); ++l) {
        out.forces.push_back(forces.at(state.contacts[l]));
    }
    out.soft = {std::move(state.packing), std::move(state.contacts), std::move(state.load)};
    return out;
}

void add_law(SoftForces& grains, double stiffness) {
    grains.forces.resize(grains.soft.contacts.size(), NAN);
    for (std::size_t l = 0; l < grains.forces.size(); ++l) {
        if (std::isnan(grains.forces[l])) {
            grains.forces[l] = stiffness * std::max(0.0, -gap(grains.soft.packing, grains.soft.contacts[l]));
        }
    }
}

} // namespace isostat::compare
