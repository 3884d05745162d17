#pragma once
// The same packing with radii that are really changed by a little: what a rule for ties is compared with.

#include "statics/perturbed.hpp"
#include "support/crafted.hpp"
#include "support/newton.hpp"

namespace crafted {

/// The contacts that a run under `choose` starts from.
inline std::vector<Contact> starting_contacts(const State& state, const std::vector<double>& rho) {
    if (static_cast<int>(state.contacts.size()) == isostat::DofMap(state.packing).dof_count()) {
        return state.contacts;
    }
    return required(isostat::first_order_backbone(state.packing, state.load, state.contacts, rho));
}

/// The packing with radii R + eps rho and the same contacts closed, by Newton's method.
inline State really_perturbed(State state, const std::vector<double>& rho, double eps) {
    state.contacts = starting_contacts(state, rho);
    for (std::size_t i = 0; i < rho.size(); ++i) {
        state.packing.radius[i] += eps * rho[i];
    }
    for (int step = 0; step < 12; ++step) {
        step_to_gaps(state.packing, state.contacts, std::vector<double>(state.contacts.size(), 0));
        isostat::snap_to_grid(state.packing);
    }
    return state;
}

} // namespace crafted
