#include "checker/recorded_arc.hpp"

#include "checker/replay.hpp"

#include <algorithm>
#include <cmath>

namespace isostat::checker {

namespace {

std::vector<double> load_at(const Load& load, const Packing& packing, bool rattles) {
    std::vector<double> pushing = rattles ? load.infinitesimal : load.external_force(packing);
    pushing.resize(packing.q.size(), 0.0);
    return pushing;
}

/// The multiplier of a contact in double.
double multiplier(const State& state, const Solver& solver, std::size_t contact, bool rattles, double& largest) {
    const Structure structure(state.packing, state.contacts);
    const std::vector<double> load = load_at(state.load, state.packing, rattles);
    Eigen::MatrixXd b(static_cast<Eigen::Index>(structure.coordinate_of.size()), 1);
    for (std::size_t j = 0; j < structure.coordinate_of.size(); ++j) {
        b(static_cast<Eigen::Index>(j), 0) = -load[static_cast<std::size_t>(structure.coordinate_of[j])];
    }
    const Eigen::MatrixXd forces = solver.solve_transposed(b, 2); // a multiplier may be 0
    largest = forces.lpNorm<Eigen::Infinity>();
    return forces(static_cast<Eigen::Index>(contact), 0);
}

} // namespace

bool exchanges_list(const TieRecord& tie) {
    return tie.what == "second order" || tie.what == "end";
}

std::optional<std::vector<Contact>> list_that_opens(const State& state, const EventRecord& event) {
    std::vector<Contact> list = state.contacts;
    for (const TieRecord& tie : event.ties) {
        if (!exchanges_list(tie)) {
            continue;
        }
        const std::optional<Contact> enters = contact_named(tie.contact, state.packing);
        const std::optional<Contact> leaves = contact_named(tie.against, state.packing);
        const auto at = leaves ? std::find(list.begin(), list.end(), *leaves) : list.end();
        if (!enters || enters->kind == ContactKind::held || at == list.end() || tie.against == event.opened ||
            leaves->kind == ContactKind::held || std::find(list.begin(), list.end(), *enters) != list.end()) {
            return {};
        }
        *at = *enters;
    }
    return list;
}

std::optional<std::vector<Contact>> list_before(std::vector<Contact> list, const std::vector<const EventRecord*>& arcs,
                                                const Packing& packing) {
    const auto put_back = [&](const std::string& entered, const std::string& left) {
        const std::optional<Contact> in = contact_named(entered, packing);
        const std::optional<Contact> out = contact_named(left, packing);
        const auto at = in && out ? std::find(list.begin(), list.end(), *in) : list.end();
        if (at == list.end()) {
            return false;
        }
        *at = *out;
        return true;
    };
    bool all = true;
    for (auto arc = arcs.rbegin(); all && arc != arcs.rend(); ++arc) {
        const std::vector<TieRecord>& ties = (*arc)->ties;
        all = put_back((*arc)->closed, (*arc)->opened);
        for (auto tie = ties.rbegin(); all && tie != ties.rend(); ++tie) {
            all = !exchanges_list(*tie) || put_back(tie->contact, tie->against);
        }
    }
    return all ? std::optional(std::move(list)) : std::nullopt;
}

std::optional<Opening> opening_of(const ArcStart& start, const EventRecord& event) {
    const State& from = start.state;
    const std::optional<Contact> opened = contact_named(event.opened, from.packing);
    const std::optional<Contact> closed = contact_named(event.closed, from.packing);
    const auto at = opened ? std::find(from.contacts.begin(), from.contacts.end(), *opened) : from.contacts.end();
    if (at == from.contacts.end() || !closed || (event.power_turn && !event.held_at) ||
        event.power_turn != (closed->kind == ContactKind::held) || !start.solver || !start.solver->usable() ||
        (closed != opened && std::find(from.contacts.begin(), from.contacts.end(), *closed) != from.contacts.end())) {
        return {};
    }
    Opening opening{static_cast<std::size_t>(at - from.contacts.begin()), +1, event.kind == "rattler"};
    if (opened->kind == ContactKind::held) {
        double largest = 0;
        double force = multiplier(from, *start.solver, opening.contact, opening.rattles, largest);
        if (!opening.rattles && std::abs(force) <= record_tolerance * largest) {
            opening.rattles = true;
            force = multiplier(from, *start.solver, opening.contact, true, largest);
        }
        opening.direction = force > 0 ? -1 : +1;
    }
    return opening;
}

Followed follow(const ArcStart& from, const EventRecord& event, const Opening& opening, bool slowly) {
    Motion motion;
    motion.opened = opening.contact;
    motion.direction = opening.direction;
    motion.closed = *contact_named(event.closed, from.state.packing);
    motion.held_at = event.held_at.value_or(0);
    motion.displacement = event.displacement;
    motion.solver = from.solver;
    motion.touching = from.touching;
    Load load = from.state.load;
    load.set_loaded_stress(event.stress);
    motion.power_load = [&, at = from.state.packing](const std::vector<double>& q) mutable {
        at.q = q;
        return load_at(load, at, opening.rattles);
    };
    constexpr int finest = 2;      // two branches of the curve may be near each other
    motion.zooms = slowly ? 3 : 0; // choice: how often the last step is made anew, shorter
    Followed followed;
    for (int finer = slowly ? 1 : 0; finer <= finest && !followed.end; ++finer) {
        motion.step = std::ldexp(Motion().step, -4 * finer); // cost: steps shorter by 2^-4 where the look failed
        // guess: how much shorter the first steps of a look are, as a power of 2
        motion.doublings = finer > 0 ? 20 : 0; // branches cross where contacts are nearly singular at the start
        followed = follow(from.state, motion);
    }
    return followed;
}

} // namespace isostat::checker
