// The vertices of a replay and what the rule opens there.
#include "checker/replay.hpp"

#include "checker/gaps.hpp"

#include <fmt/format.h>

namespace isostat::checker {

namespace {

bool contains(const std::vector<int>& sorted, std::size_t value) {
    return std::binary_search(sorted.begin(), sorted.end(), static_cast<int>(value));
}

/// Sign of all forces of one stage: those that are no structural zeros, or the infinitesimal ones of those that are.
Objections negative_ones(const Place& place, bool finite, std::vector<int>& negative) {
    const Evidence& e = *place.evidence;
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        if (contains(place.zeros, l) == finite) {
            continue;
        }
        const Range& force = finite ? e.forces[l] : e.infinitesimal[l];
        if (force.negative()) {
            negative.push_back(static_cast<int>(l));
        } else if (!force.positive()) {
            return Objection{false, fmt::format("the sign of the {}force of {} is not known: {}",
                                                finite ? "" : "infinitesimal ", e.name(l), shown(force))};
        }
    }
    return {};
}

} // namespace

Range Place::coordinate(std::size_t k) const {
    const bool moves = evidence->problem.dof_of[k] >= 0;
    return Range::around(evidence->problem.length(evidence->vertex.middle[k]),
                         moves ? evidence->vertex.radius : Rational(0));
}

Range Place::length(int axis) const {
    return coordinate(2 * static_cast<std::size_t>(evidence->problem.disks) + static_cast<std::size_t>(axis));
}

Objections make_place(State<2> state, Place& place) {
    place.state = std::make_unique<State<2>>(std::move(state));
    place.evidence = std::make_unique<Evidence>(*place.state, CheckerArithmetic::automatic);
    const Evidence& e = *place.evidence;
    if (!e.problem.unsupported.empty()) {
        return Objection{false, e.problem.unsupported};
    }
    if (!e.vertex.found) {
        return Objection{false, "no true vertex is proved: " + e.why_no_vertex()};
    }
    place.zeros = having_zero(e.forces);
    if (!vanish_structurally(e.problem, place.zeros, e.finite_load)) {
        return Objection{false, "some forces cannot be told from 0 and are no structural zeros"};
    }
    return {};
}

Objections decide(const Place& place, Decision& decision) {
    if (Objections open = negative_ones(place, true, decision.candidates)) {
        return open;
    }
    if (!decision.candidates.empty()) {
        decision.kind = "tension";
        return {};
    }
    if (Objections open = negative_ones(place, false, decision.candidates)) {
        return open;
    }
    decision.kind = decision.candidates.empty() ? "" : "rattler";
    return {};
}

Objections check_limit(const Place& place, const EventRecord& event, std::size_t opened) {
    const Evidence& e = *place.evidence;
    const double around = record_tolerance * std::max(1.0, std::abs(event.stress));
    const LoadEndClaim claim{false, {event.stress - around, event.stress + around}, place.state->contacts[opened]};
    std::string text;
    const int direction = event.stress > place.stress() ? 1 : -1;
    const Verdict verdict = judge_load_end(e, claim, direction, text);
    if (verdict != Verdict::proved) {
        return Objection{verdict == Verdict::refuted, fmt::format("limit of the load at {}", text)};
    }
    if (std::abs(event.force) > record_tolerance) {
        return Objection{true, fmt::format("the force at a limit is {}, not 0", event.force)};
    }
    // Forces that vanish together: the infinitesimal loads decide which one comes first.
    const Range step = Range(Rational(0)) - e.forces[opened] / e.slopes[opened];
    const auto order = [&e](std::size_t l) {
        const Range slope = e.slopes[l].negative() ? Range(Rational(0)) - e.slopes[l] : e.slopes[l];
        return e.infinitesimal[l] / slope;
    };
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        const bool other = l != opened && !contains(place.zeros, l);
        if (!other || (e.forces[l] + step * e.slopes[l]).positive()) {
            continue;
        }
        if (e.slopes[l].has_zero()) {
            return Objection{false, fmt::format("the force of {} may vanish at the limit too", e.name(l))};
        }
        if (order(l).upper < order(opened).lower) {
            return Objection{
                true, fmt::format("{} vanishes at the same load, and first under the infinitesimal loads", e.name(l))};
        }
        if (!(order(opened).upper < order(l).lower)) {
            return Objection{false, fmt::format("{} and {} vanish together", e.name(opened), e.name(l))};
        }
    }
    return {};
}

Objections check_rule(const Place& place, const EventRecord& event, std::size_t opened, const std::string& rule) {
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
    if (decision.kind != event.kind) {
        return Objection{true, fmt::format("the kind is '{}': there is a {}force < 0 in {}", event.kind,
                                           decision.kind == "rattler" ? "infinitesimal " : "",
                                           e.name(static_cast<std::size_t>(decision.candidates[0])))};
    }
    const std::vector<Range>& forces = decision.kind == "rattler" ? e.infinitesimal : e.forces;
    const Range& chosen = forces[opened];
    if (!contains(decision.candidates, opened)) {
        return Objection{true, fmt::format("{} opens, but its force is in {}", e.name(opened), shown(chosen))};
    }
    Rational largest = 0;
    for (const int l : decision.candidates) {
        const Range& force = forces[static_cast<std::size_t>(l)];
        largest = std::max<Rational>(largest, -force.lower);
        if (static_cast<std::size_t>(l) == opened) {
            continue;
        }
        const bool most = rule == "most_negative";
        if (most ? force.upper < chosen.lower : (rule == "least_negative" && force.lower > chosen.upper)) {
            return Objection{true, fmt::format("{} opens with {}, but the rule '{}' takes {} with {}", e.name(opened),
                                               shown(chosen), rule, e.name(static_cast<std::size_t>(l)), shown(force))};
        }
        if (most ? !(chosen.upper < force.lower) : (rule == "least_negative" && !(force.upper < chosen.lower))) {
            return Objection{false, fmt::format("the rule cannot order {} and {}", e.name(opened),
                                                e.name(static_cast<std::size_t>(l)))};
        }
    }
    const double difference = std::abs(event.force - chosen.lower.get_d());
    if (!(difference <= 100 * record_tolerance * std::max(1.0, largest.get_d()))) {
        return Objection{true,
                         fmt::format("the force of {} is {}, found in {}", e.name(opened), event.force, shown(chosen))};
    }
    if (rule != "most_negative" && rule != "least_negative") {
        return Objection{false, fmt::format("the rule '{}' is not checked, only that the force is negative", rule)};
    }
    return {};
}

} // namespace isostat::checker
