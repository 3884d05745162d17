#include "checker/foresight.hpp"

#include <algorithm>
#include <cmath>

namespace isostat::checker {

namespace {

std::vector<double> load_at(const Load<2>& load, const Packing<2>& packing, bool rattles) {
    std::vector<double> pushing = rattles ? load.infinitesimal : load.external_force(packing);
    pushing.resize(packing.q.size(), 0.0);
    return pushing;
}

/// The multiplier of a contact in double.
double multiplier(const State<2>& state, const Solver& solver, std::size_t contact, bool rattles, double& largest) {
    const Structure structure(state.packing, state.contacts);
    const std::vector<double> load = load_at(state.load, state.packing, rattles);
    Eigen::MatrixXd b(static_cast<Eigen::Index>(structure.coordinate_of.size()), 1);
    for (std::size_t j = 0; j < structure.coordinate_of.size(); ++j) {
        b(static_cast<Eigen::Index>(j), 0) = -load[static_cast<std::size_t>(structure.coordinate_of[j])];
    }
    const Eigen::MatrixXd forces = solver.solve_transposed(b);
    largest = forces.lpNorm<Eigen::Infinity>();
    return forces(static_cast<Eigen::Index>(contact), 0);
}

/// How the record says that its arc begins, as far as doubles tell; nothing: something is unusual.
std::optional<Opening> guessed(const State<2>& from, const Solver& solver, const EventRecord& event) {
    const std::optional<Contact> opened = contact_named(event.opened, from.packing);
    const std::optional<Contact> closed = contact_named(event.closed, from.packing);
    const auto at = opened ? std::find(from.contacts.begin(), from.contacts.end(), *opened) : from.contacts.end();
    if (at == from.contacts.end() || !closed || !event.ties.empty() || (event.power_turn && !event.held_at) ||
        event.power_turn != (closed->kind == ContactKind::held) || !solver.usable() ||
        (closed != opened && std::find(from.contacts.begin(), from.contacts.end(), *closed) != from.contacts.end())) {
        return {};
    }
    Opening opening{static_cast<std::size_t>(at - from.contacts.begin()), +1, event.kind == "rattler"};
    if (opened->kind == ContactKind::held) {
        double largest = 0;
        double force = multiplier(from, solver, opening.contact, opening.rattles, largest);
        if (!opening.rattles && std::abs(force) <= record_tolerance * largest) {
            opening.rattles = true;
            force = multiplier(from, solver, opening.contact, true, largest);
        }
        opening.direction = force > 0 ? -1 : +1;
    }
    return opening;
}

} // namespace

bool Foresight::in_order(std::size_t event) const {
    const EventRecord& record = records_.events[event];
    const auto row = static_cast<std::size_t>(record.equilibrium);
    return record.arc > 1 || (record.equilibrium > 0 && row < records_.equilibria.size() &&
                              records_.equilibria[row].integer("previous") == record.equilibrium - 1);
}

void Foresight::look_ahead(const Place& from, std::size_t event) {
    if (threads() < 2 || from.state->perturbation) {
        return; // one thread gains nothing; with ties settled at first order the next vertex depends on proofs
    }
    const auto depth = 2 * static_cast<std::size_t>(threads());
    while (ahead_.size() < depth) {
        const bool first = ahead_.empty();
        const std::size_t next = first ? event : ahead_.back().event + 1;
        if (next >= records_.events.size() || (!first && (!ahead_.back().followed.end || !in_order(next)))) {
            return;
        }
        const Start start{first ? *from.state : ahead_.back().end,
                          first ? from.evidence->solver : ahead_.back().followed.solver};
        const std::optional<Opening> opening = guessed(start.state, *start.solver, records_.events[next]);
        if (!opening) {
            return;
        }
        ahead_.push_back(arc_of(start, next, *opening));
    }
}

Foresight::Start Foresight::start_at(const Place& from, const ExactLoad& load) {
    Start start{*from.state, from.evidence->solver, {}, load};
    for (const Gap& gap : from.touching) {
        start.touching.push_back(gap.pair);
    }
    return start;
}

Arrival Foresight::arrive(const Place& from, std::size_t event, const Opening& opening, const ExactLoad& load) {
    if (ahead_.empty() || ahead_.front().event != event || !(ahead_.front().opening == opening)) {
        forget();
        ahead_.push_back(arc_of(start_at(from, load), event, opening));
    }
    Arc arc = std::move(ahead_.front());
    ahead_.pop_front();
    return end_of(std::move(arc));
}

Arrival Foresight::arrive_slowly(const Place& from, std::size_t event, const Opening& opening, const ExactLoad& load) {
    forget();
    return end_of(arc_of(start_at(from, load), event, opening, true));
}

Arrival Foresight::end_of(Arc arc) {
    Arrival arrival{std::move(arc.followed), {}, {}};
    if (arrival.followed.end) {
        Proved proved = arc.proof.get();
        arrival.open = std::move(proved.open);
        arrival.place = std::move(proved.place);
        if (!arrival.place.evidence || arrival.place.evidence->solver != arrival.followed.solver) {
            forget(); // the arcs after it were followed with other factors than they will be
        }
    }
    return arrival;
}

Foresight::Arc Foresight::arc_of(const Start& from, std::size_t event, const Opening& opening, bool slowly) const {
    const EventRecord& record = records_.events[event];
    Arc arc{event, opening, {}, from.state, {}};
    Motion motion;
    motion.opened = opening.contact;
    motion.direction = opening.direction;
    motion.closed = *contact_named(record.closed, from.state.packing);
    motion.held_at = record.held_at.value_or(0);
    motion.displacement = record.displacement;
    motion.solver = from.solver;
    motion.touching = from.touching;
    Load<2>& load = arc.end.load;
    load.stress[static_cast<std::size_t>(load.loaded_axis)] = record.stress;
    motion.power_load = [&, at = from.state.packing](const std::vector<double>& q) mutable {
        at.q = q;
        return load_at(load, at, opening.rattles);
    };
    if (!slowly) {
        arc.followed = follow(from.state, motion);
    }
    if (!arc.followed.end) {
        motion.step /= 16;
        motion.zooms = slowly ? 3 : 0;
        arc.followed = follow(from.state, motion);
    }
    if (!arc.followed.end) {
        return arc;
    }
    arc.end.packing.q = *arc.followed.end;
    arc.end.contacts[opening.contact] = motion.closed;
    const int fresh = record.power_turn ? static_cast<int>(opening.contact) : -1;
    arc.proof = Future<Proved>([end = arc.end, exact = from.load, fresh, factors = arc.followed.solver] {
        Proved proved;
        proved.open = make_place(end, proved.place, exact, fresh, factors);
        if (!proved.open) {
            (void)proved.place.gaps();
        }
        return proved;
    });
    return arc;
}

} // namespace isostat::checker
