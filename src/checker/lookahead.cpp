#include "checker/lookahead.hpp"

namespace isostat::checker {

bool Lookahead::in_order(std::size_t event) const {
    const EventRecord& record = records_.events[event];
    const auto row = static_cast<std::size_t>(record.equilibrium);
    return record.arc > 1 || (record.equilibrium > 0 && row < records_.equilibria.size() &&
                              records_.equilibria[row].integer("previous") == record.equilibrium - 1);
}

void Lookahead::look_ahead(const Place& from, std::size_t event) {
    if (threads() < 2 || from.state->perturbation) {
        return; // one thread gains nothing; with first-order ties the next vertex depends on proofs
    }
    const auto depth = 2 * static_cast<std::size_t>(threads());
    while (ahead_.size() < depth) {
        const bool first = ahead_.empty();
        const std::size_t next = first ? event : ahead_.back().event + 1;
        if (next >= records_.events.size() || (!first && (!ahead_.back().followed.end || !in_order(next)))) {
            return;
        }
        const Start start{
            {first ? *from.state : ahead_.back().end, first ? from.evidence->solver : ahead_.back().followed.solver}};
        const EventRecord& event_record = records_.events[next];
        const std::optional<Opening> opening = opening_of(start.at, event_record);
        if (!opening || !event_record.ties.empty()) {
            return;
        }
        ahead_.push_back(arc_of(start, next, *opening));
    }
}

Lookahead::Start Lookahead::start_at(const Place& from, const ExactLoad& load) {
    Start start{{*from.state, from.evidence->solver}, load};
    for (const Gap& gap : from.touching) {
        start.at.touching.push_back(gap.pair);
    }
    return start;
}

Arrival Lookahead::arrive(const Place& from, std::size_t event, const Opening& opening, const ExactLoad& load) {
    if (ahead_.empty() || ahead_.front().event != event || !(ahead_.front().opening == opening)) {
        forget();
        ahead_.push_back(arc_of(start_at(from, load), event, opening));
    }
    Arc arc = std::move(ahead_.front());
    ahead_.pop_front();
    return end_of(std::move(arc));
}

Arrival Lookahead::arrive_slowly(const Place& from, std::size_t event, const Opening& opening, const ExactLoad& load) {
    forget();
    return end_of(arc_of(start_at(from, load), event, opening, true));
}

Arrival Lookahead::end_of(Arc arc) {
    Arrival arrival{std::move(arc.followed), {}, {}};
    if (arrival.followed.end) {
        Proved proved = arc.proof.get();
        arrival.open = std::move(proved.open);
        arrival.place = std::move(proved.place);
        if (!arrival.place.evidence || arrival.place.evidence->solver != arrival.followed.solver) {
            forget(); // the later arcs were followed with other factors than they will have
        }
    }
    return arrival;
}

Lookahead::Arc Lookahead::arc_of(const Start& from, std::size_t event, const Opening& opening, bool slowly) const {
    const EventRecord& record = records_.events[event];
    Arc arc{event, opening, follow(from.at, record, opening, slowly), from.at.state, {}};
    Load& load = arc.end.load;
    load.set_loaded_stress(record.stress);
    if (!arc.followed.end) {
        return arc;
    }
    arc.end.packing.q = *arc.followed.end;
    arc.end.contacts[opening.contact] = *contact_named(record.closed, arc.end.packing);
    const int fresh = record.power_turn ? static_cast<int>(opening.contact) : -1;
    arc.proof = Future<Proved>(
        [end = arc.end, exact = from.load, fresh, factors = arc.followed.solver, chooses = records_.chooses] {
            Proved proved;
            proved.place.chooses = chooses;
            proved.open = make_place(end, proved.place, exact, fresh, factors);
            if (!proved.open) {
                (void)proved.place.gaps();
            }
            return proved;
        });
    return arc;
}

} // namespace isostat::checker
