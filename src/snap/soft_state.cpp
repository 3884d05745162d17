#include "core/refuse.hpp"
#include "packing/words.hpp"
#include "snap/backbone.hpp"
#include "snap/soft_list.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace isostat::compare {

namespace {

/// Whether each axis has a movable wall or a period.
bool gives_way(const Packing& packing) {
    bool all = true;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        const bool walls = packing.walls.lower[a] == WallKind::fixed && packing.walls.upper[a] == WallKind::movable;
        all = all && (walls || packing.cell.periodic[a]);
    }
    return all;
}

/// R_i R_j / (R_i + R_j); for a grain at a wall R_i.
double radius_of(const Packing& packing, const Contact& c) {
    const double one = packing.radius[static_cast<std::size_t>(c.i)];
    const double other = c.of_disks() ? packing.radius[static_cast<std::size_t>(c.j)] : 0;
    return c.of_disks() ? one * other / (one + other) : one;
}

} // namespace

double ContactLaw::force(const Packing& packing, const Contact& contact) const {
    const double overlap = std::max(0.0, -gap(packing, contact));
    return stiffness * overlap * (kind == ForceLaw::hertz ? std::sqrt(overlap * radius_of(packing, contact)) : 1);
}

double ContactLaw::rounding(const Packing& packing, const Contact& contact, double of_gap) const {
    const double overlap = std::max(0.0, -gap(packing, contact)) + of_gap;
    const double steeper = kind == ForceLaw::hertz ? 1.5 * std::sqrt(overlap * radius_of(packing, contact)) : 1;
    return stiffness * of_gap * steeper;
}

SoftForces soft_grains(const StateFile& file, const std::string& source) {
    State state = file.state;
    const bool fixed = std::ranges::any_of(state.packing.fixed, [](auto f) { return f != 0; });
    if (!gives_way(state.packing) || fixed || !state.load.disk_force.empty()) {
        refuse(source,
               "expected a fixed lower and a movable upper wall along each axis that is not periodic, no fixed {} and "
               "no force on a {}",
               grain_word(state.packing.dimension), grain_word(state.packing.dimension));
    }
    SoftForces out;
    std::map<Contact, double> forces;
    for (std::size_t l = 0; l < file.forces.size(); ++l) {
        forces.emplace(state.contacts[l], file.forces[l]);
    }
    std::ranges::sort(state.contacts);
    state.contacts = able_to_carry(state.packing, std::move(state.contacts));
    for (std::size_t l = 0; l < state.contacts.size() && !forces.empty(); ++l) {
        out.forces.push_back(forces.at(state.contacts[l]));
    }
    out.soft = {std::move(state.packing), std::move(state.contacts), std::move(state.load)};
    return out;
}

void add_law(SoftForces& grains, const ContactLaw& law) {
    grains.forces.resize(grains.soft.contacts.size(), NAN);
    for (std::size_t l = 0; l < grains.forces.size(); ++l) {
        if (std::isnan(grains.forces[l])) {
            grains.forces[l] = law.force(grains.soft.packing, grains.soft.contacts[l]);
        }
    }
}

} // namespace isostat::compare
