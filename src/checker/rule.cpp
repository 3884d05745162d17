// Which contact the rule opens, and which coordinate is held.
#include "checker/choice.hpp"
#include "checker/index.hpp"
#include "checker/replay.hpp"
#include "checker/strut.hpp"

#include <fmt/format.h>

// exact: all other numbers of this file: splitmix64, what the rule random draws

namespace isostat::checker {

bool grains_bear_force(const Place& place, std::size_t contact) {
    const std::vector<Contact>& contacts = place.state->contacts;
    const auto bears = [&](int grain) {
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            const Contact& c = contacts[l];
            const bool touches = c.i == grain || (c.of_disks() && c.j == grain);
            if (l != contact && c.kind != ContactKind::held && touches && !contains(place.zeros, l)) {
                return true;
            }
        }
        return false;
    };
    const Contact& opened = contacts[contact];
    return opened.kind != ContactKind::held && bears(opened.i) && (!opened.of_disks() || bears(opened.j));
}

Objections check_turn(const Place& place, const EventRecord& event, bool rattles) {
    const Evidence& e = *place.evidence;
    const auto held = static_cast<std::size_t>(place.fresh);
    const ContactForces& forces = rattles ? e.infinitesimal() : e.forces;
    const Rational room = Rational(turn_tolerance) * Rational(largest_force(forces));
    if (forces[held].lower > room || forces[held].upper < -room) {
        return Objection{true,
                         fmt::format("the power of the load does not vanish where {} is held: its multiplier is in "
                                     "{}",
                                     event.closed, shown(forces[held]))};
    }
    if (const Range& load = e.forces[held]; rattles && !place.first && (load.lower > room || load.upper < -room)) {
        return Objection{true, fmt::format("the finite load has a power where {} is held: its multiplier is in {}",
                                           event.closed, shown(load))};
    }
    const Velocities velocities(e);
    const Velocities::Solution motion = velocities.opening(held, 1);
    const auto k = static_cast<std::size_t>(place.state->contacts[held].i);
    const double fastest = motion.fastest();
    if (abs(motion.middle[k]) + motion.radius < Rational(fastest) * Rational(1 - turn_tolerance)) {
        return Objection{true, fmt::format("{} is held, but another coordinate is {} times as fast", event.closed,
                                           fastest / std::abs(motion.middle[k].get_d()))};
    }
    return {};
}

namespace {

/// Order of two contacts by the key of the rule: -1 when `a` has the smaller key, 0 when unknown. `at_first_order`: the
/// finite forces did not decide.
int compare_keys(const Place& place, bool finite, std::size_t a, std::size_t b, bool& at_first_order) {
    const Evidence& e = *place.evidence;
    const auto key = [&](std::size_t l, bool first) {
        const Range& force = finite ? e.forces[l] : e.infinitesimal()[l];
        const bool flipped = place.is_held(l) && force.positive(); // it competes with minus its magnitude
        const Range& value = first ? place.first_force[l] : force;
        return flipped ? -value : value;
    };
    Range difference = key(a, false) - key(b, false);
    at_first_order = difference.has_zero() && finite && place.first;
    if (at_first_order) {
        difference = key(a, true) - key(b, true);
    }
    return difference.negative() ? -1 : difference.positive() ? 1 : 0;
}

ChoiceRule opening_choice(const Place& place, std::size_t opened, const std::string& rule) {
    const auto tied = [&place, opened](std::size_t l) {
        bool at_first_order = false;
        (void)compare_keys(place, true, l, opened, at_first_order);
        return at_first_order;
    };
    const auto load = [&place, least = rule == "least_negative"](std::size_t l) {
        const Range& f = place.evidence->infinitesimal()[l];
        return least ? -f : f;
    };
    return {"opening", tied, load};
}

/// A released coordinate is held again at once, which leaves no record (descent.md): with the held value moved by the
/// accuracy of the turn its multiplier has the other sign, so the power vanished before.
bool turns_back_at_once(const Place& place, std::size_t contact, bool finite) {
    constexpr double last_bits = 0x1p-40; // of the largest radius; checker.md turns_back_at_once
    if (!place.is_held(contact)) {
        return false;
    }
    const auto multiplier = [contact, finite](const Place& at) {
        return (finite ? at.evidence->forces : at.evidence->infinitesimal())[contact];
    };
    const bool falls = multiplier(place).positive();
    State state = *place.state;
    const auto coordinate = static_cast<std::size_t>(state.contacts[contact].i);
    state.packing.q[coordinate] += (falls ? -last_bits : last_bits) * state.packing.max_radius();
    Place moved;
    moved.chooses = place.chooses;
    (void)make_place(std::move(state), moved, place.load, -1, place.evidence->solver); // its other forces do not matter
    if (!moved.evidence->vertex.found) {
        return false;
    }
    return falls ? multiplier(moved).negative() : multiplier(place).negative() && multiplier(moved).positive();
}

/// The lower bound of one force is above the upper bound of that of the opening contact, whatever its sign. A held
/// coordinate competes with minus its magnitude.
bool is_less_negative(const Place& place, const ContactForces& forces, std::size_t one, std::size_t opened) {
    const Range& f = forces[one];
    const Range& first = forces[opened];
    const Rational least = place.is_held(one) ? std::min<Rational>(f.lower, -f.upper) : f.lower;
    const Rational most = place.is_held(opened) && first.positive() ? Rational(-first.lower) : first.upper;
    return most < least;
}

/// Empty, or the reason why the rule does not put `opened` before another contact that may open.
Objections check_order(const Place& place, const std::string& kind, std::size_t opened, std::size_t other,
                       const std::string& rule) {
    const Evidence& e = *place.evidence;
    const ContactForces& forces = kind == "rattler" ? e.infinitesimal() : e.forces;
    const bool most = rule == "most_negative";
    const bool by_name = rule == "least_index";
    bool at_first_order = false; // a run may have more digits to tell the forces apart
    int sign = compare_keys(place, kind != "rattler", other, opened, at_first_order);
    if (by_name) {
        sign = place.state->contacts[other] < place.state->contacts[opened] ? -1 : 1;
        at_first_order = false;
    } else if (kind != "rattler" && same_at_turn(place, opened, other)) {
        // Finite forces only show how the turn was rounded.
        sign = strut_order(place, other, opened).value_or(0);
    } else if (kind != "rattler" && equal_by_place(e, e.finite_load, place.zeros, other, opened)) {
        const Range excess = e.infinitesimal()[other] - e.infinitesimal()[opened]; // S6, S7
        sign = excess.negative() ? -1 : excess.positive() ? 1 : 0;
        at_first_order = false;
    }
    if (most || by_name ? sign < 0 : rule == "least_negative" && sign > 0) {
        if (turns_back_at_once(place, other, kind != "rattler")) {
            return {};
        }
        const bool holds = holds_may_explain(place, other, opened);
        const bool left = kind == "rattler" && is_left(place, other); // as at an equilibrium (C1)
        return Objection{!holds && !left && !at_first_order,
                         fmt::format("{} opens with {}, but the rule '{}' takes {} with {}{}", e.name(opened),
                                     shown(forces[opened]), rule, e.name(other), shown(forces[other]),
                                     left    ? ", which the run left at 0"
                                     : holds ? ", unless a coordinate held earlier was released and turned back where "
                                               "it stood"
                                             : "")};
    }
    if (sign == 0 && (most || rule == "least_negative")) {
        return Objection{false, fmt::format("the rule cannot order {} and {}", e.name(opened), e.name(other))};
    }
    return {};
}

/// The candidate that the rule `random` opens, in the order of contacts: splitmix64 of the seed and the steps before.
std::size_t drawn(std::uint64_t seed, long step, std::size_t candidates) {
    std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(step);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return (z ^ (z >> 31)) % candidates;
}

/// The candidates are not known where holds may have been
/// released and held again at once, or radii are R_i + eps rho_i.
Objections check_draw(const Place& place, const EventRecord& event, std::size_t opened, std::uint64_t seed,
                      const std::vector<int>& candidates) {
    const auto& contacts = place.state->contacts;
    const auto before = std::count_if(candidates.begin(), candidates.end(),
                                      [&](int l) { return contacts[static_cast<std::size_t>(l)] < contacts[opened]; });
    const std::size_t place_drawn = drawn(seed, event.step, candidates.size());
    if (place_drawn == static_cast<std::size_t>(before)) {
        return {};
    }
    const bool known = !place.first && std::none_of(contacts.begin(), contacts.end(),
                                                    [](const Contact& c) { return c.kind == ContactKind::held; });
    return Objection{known,
                     fmt::format("{} opens, number {} of {} candidates: the rule 'random' draws {}", event.opened,
                                 before, candidates.size(), place_drawn),
                     true};
}

} // namespace

Objections check_rule(const Place& place, const EventRecord& event, std::size_t opened, const RunRecords& run) {
    const std::string& rule = run.rule;
    if (event.stress != place.stress()) {
        return Objection{
            true, fmt::format("the stress is {}, and was {} in the same rearrangement", event.stress, place.stress())};
    }
    Decision decision;
    if (Objections open = decide(place, decision)) {
        return open;
    }
    const Evidence& e = *place.evidence;
    if (decision.kind.empty()) {
        return Objection{true, "all forces are positive: an equilibrium was reached before this arc"};
    }
    if (place.is_held(opened) ? event.kind != "release" : decision.kind != event.kind) {
        return Objection{true, fmt::format("the kind is '{}': there is a {}force < 0 in {}", event.kind,
                                           decision.kind == "rattler" ? "infinitesimal " : "",
                                           e.name(static_cast<std::size_t>(decision.candidates[0])))};
    }
    const ContactForces& forces = decision.kind == "rattler" ? e.infinitesimal() : e.forces;
    if (Objections wrong = check_choice(place, place.said, opened, opening_choice(place, opened, rule))) {
        return wrong;
    }
    for (const int l : decision.open) { // a less negative force does not open, whatever its sign
        const auto other = static_cast<std::size_t>(l);
        if (rule != "most_negative" || !is_less_negative(place, forces, other, opened)) {
            return Objection{false, fmt::format("the sign of the force of {} is not known: {}", e.name(other),
                                                shown(forces[other]))};
        }
    }
    if (!contains(decision.candidates, opened)) {
        return Objection{true, fmt::format("{} opens, but its force is in {}", e.name(opened), shown(forces[opened]))};
    }
    for (const int l : decision.candidates) {
        const auto other = static_cast<std::size_t>(l);
        if (other == opened || recorded_choice(place.said, "opening", e.name(opened), e.name(other)) != nullptr) {
            continue;
        }
        if (Objections wrong = check_order(place, decision.kind, opened, other, rule)) {
            return wrong;
        }
    }
    if (Objections wrong = compare_if_bounded("force", {event.force, event.force_bound}, forces[opened],
                                              force_tolerance * largest_force(forces))) {
        return wrong;
    }
    if (rule == "random" && run.rule_seed) {
        return check_draw(place, event, opened, *run.rule_seed, decision.candidates);
    }
    if (rule != "most_negative" && rule != "least_negative" && rule != "least_index") {
        return Objection{false, fmt::format("the rule '{}' is not checked, only that the force is negative", rule),
                         true};
    }
    return {};
}

std::vector<std::string_view> opening_rules() {
    return {"most_negative", "random", "least_negative", "least_index"};
}

} // namespace isostat::checker
