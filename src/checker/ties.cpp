// First-order decisions that records name.
#include "checker/choice.hpp"
#include "checker/first_order.hpp"
#include "checker/index.hpp"
#include "checker/recorded_arc.hpp"

#include <fmt/format.h>

namespace isostat::checker {

Objections check_said(const std::string& what, const Bounded& said, const Range& found) {
    const auto [value, bound] = said;
    const bool apart =
        found.lower > Rational(value) + Rational(bound) || found.upper < Rational(value) - Rational(bound);
    return apart ? Objections(
                       Objection{true, fmt::format("{} is {} +- {}, found in {}", what, value, bound, shown(found))})
                 : Objections();
}

namespace {

/// One pair was chosen by name to close before another, after steps whose lengths cannot be told apart.
bool chosen_step(const Place& place, const EventRecord& event, const Contact& chosen, const Contact& other) {
    const TieRecord* tie = recorded_choice(event.ties, "step", place.named(chosen), place.named(other));
    return tie != nullptr && tie->choice == "names" && chosen < other;
}

std::optional<std::size_t> position(const Place& place, const std::string& name) {
    for (std::size_t l = 0; l < place.state->contacts.size(); ++l) {
        if (place.evidence->name(l) == name) {
            return l;
        }
    }
    return {};
}

std::vector<Gap>::const_iterator touching_pair(const Place& place, const std::string& name) {
    return std::find_if(place.touching.begin(), place.touching.end(),
                        [&](const Gap& gap) { return place.named(gap.pair) == name; });
}

/// First-order gap of a pair that touches.
std::optional<Range> first_gap(const Place& place, const std::string& name) {
    const auto gap = touching_pair(place, name);
    return gap == place.touching.end() ? std::nullopt : std::optional(gap->value);
}

/// First-order length of the step on which a touching pair closes; nothing when it does not close.
std::optional<Range> first_way(const Place& from, const std::string& name, std::size_t opened, int direction) {
    const auto gap = touching_pair(from, name);
    if (gap == from.touching.end()) {
        return {};
    }
    const Velocities& velocities = from.first->velocities();
    const Range rate = -velocities.gap_rate(gap->pair, velocities.opening(opened, direction));
    return rate.positive() ? std::optional(gap->value / rate) : std::nullopt;
}

/// At the limit where `opened` opens: first-order term of a force
/// that is 0 all along, or of the stress at which it vanishes.
std::optional<Range> first_limit(const Place& from, const std::string& name, std::size_t opened, bool all_along) {
    const auto l = position(from, name);
    const auto& slopes = from.evidence->slopes();
    if (!l || !from.first || slopes[opened].has_zero() || slopes[*l].has_zero() != all_along) {
        return {};
    }
    const std::vector<Range> there = ForcesAfter{*from.evidence, step_to_limit(*from.evidence, opened)}.all();
    const std::vector<Range> first = from.first->forces(there);
    if (all_along) {
        return there[*l].has_zero() ? std::optional(first[*l]) : std::nullopt;
    }
    return limit_rate(first[*l], slopes[*l]);
}

/// How a force or a gap that vanishes in the base is treated, by the sign of its first-order term (C1).
std::string left_as(const std::string& what, const Range& first) {
    return first.positive() ? "" : what == "gap" && first.negative() ? "watched" : "zero";
}

/// An arc whose recorded ties are checked.
struct Arc {
    const Place& base; ///< its start, with the list that was reached
    const Place& from; ///< the same, with the list that opens
    const Place& to;
    const EventRecord& event;
    std::size_t opened;
    int direction;

    /// The first-order term of one name in one kind of decision; nothing: there is no such term.
    [[nodiscard]] std::optional<Range> term(const std::string& what, const std::string& name) const {
        if (what == "gap") {
            return first_gap(to, name);
        }
        if (what == "step") {
            return first_way(from, name, opened, direction);
        }
        if (what == "limit" || what == "zero all along") {
            return first_limit(base, name, opened, what != "limit");
        }
        const bool at_start = what == "start";
        if (at_start && (event.equilibrium != 0 || event.arc != 1)) {
            return {};
        }
        const Place& at = at_start ? base : to;
        const auto l = position(at, name);
        const bool tied = l && at.first && (what != "force" || contains(at.ties, *l) || contains(at.zeros, *l));
        return tied ? std::optional(at.first_force[*l]) : std::nullopt;
    }

    [[nodiscard]] Objections check_term(const TieRecord& tie, const std::string& name, const Bounded& said) const {
        const std::optional<Range> found = term(tie.what, name);
        if (!found) {
            return Objection{
                true, fmt::format("a first-order decision '{}' about {}, of which there is none", tie.what, name)};
        }
        const std::string what = fmt::format("the first-order term of {} ('{}')", name, tie.what);
        Objections wrong = check_said(what, said, *found);
        const bool of_keys = tie.what == "opening" || tie.what == "start";
        if (wrong && of_keys) { // those of the rule least_negative are kept with the other sign
            wrong = check_said(what, {-said.value, said.bound}, *found);
        }
        return wrong;
    }

    /// Checks an entry left at 0, watched, or told from 0, by the sign of its term: as found, and as recorded.
    [[nodiscard]] Objections check_left(const TieRecord& tie) const {
        const bool gap = tie.what == "gap";
        const Rational value(gap ? tie.other : tie.first);
        const std::string& name = gap ? tie.against : tie.contact;
        const std::string recorded =
            left_as(tie.what, Range::around(value, Rational(gap ? tie.other_bound : tie.first_bound)));
        const std::string found = left_as(tie.what, *term(tie.what, name));
        if (tie.choice == found && tie.choice == recorded) {
            return {};
        }
        return Objection{tie.choice != found && tie.choice != recorded,
                         fmt::format("'{}' of {} is left as '{}', but by its first-order term as '{}'", tie.what, name,
                                     tie.choice, tie.choice == found ? recorded : found)};
    }

    /// The rule chose between two contacts that first-order terms do not separate, by the record and as found.
    [[nodiscard]] Objections check_tied(const TieRecord& tie) const {
        // 0x1p-50: exact: rounding of recorded differences is less (checker.md K22)
        const Rational room = (Rational(tie.first_bound) + Rational(tie.other_bound)) * (1 + Rational(0x1p-50)) +
                              Rational(0x1p-50) * (abs(Rational(tie.first)) + abs(Rational(tie.other)));
        const bool recorded = abs(Rational(tie.first) - Rational(tie.other)) <= room;
        const bool found = (*term(tie.what, tie.contact) - *term(tie.what, tie.against)).has_zero();
        return recorded && found
                   ? Objections()
                   : Objection{!recorded, fmt::format("a choice '{}' between {} and {}, which their first-order terms "
                                                      "tell apart",
                                                      tie.what, tie.contact, tie.against)};
    }

    [[nodiscard]] Objections check(const TieRecord& tie) const {
        const bool alone =
            tie.what == "force" || tie.what == "zero all along" || (tie.what == "step" && tie.against.empty());
        const bool gap = tie.what == "gap";
        const bool ends = gap || tie.what == "step"; // these end the arc
        if (alone != tie.against.empty() || (ends && tie.contact != event.closed) ||
            (gap && (tie.first != 0 || tie.first_bound != 0))) {
            return Objection{true, fmt::format("a first-order decision '{}' of {} and {}: there is no such one here",
                                               tie.what, tie.contact, tie.against)};
        }
        if (Objections wrong = gap ? Objections() : check_term(tie, tie.contact, {tie.first, tie.first_bound})) {
            return wrong;
        }
        if (Objections wrong = alone ? Objections() : check_term(tie, tie.against, {tie.other, tie.other_bound})) {
            return wrong;
        }
        if (gap || (alone && tie.what != "step")) {
            return to.chooses ? check_left(tie) : Objections();
        }
        const bool chosen = tie.choice == "names" || (tie.choice == "infinitesimal loads" && tie.what != "step");
        if (chosen && !alone) {
            return check_tied(tie);
        }
        return tie.choice.empty() ? Objections()
                                  : Objection{true, fmt::format("'{}' of {} is chosen by '{}', which chooses no such "
                                                                "thing",
                                                                tie.what, tie.contact, tie.choice)};
    }

    /// Backwards from the end, a touching pair does not overlap; one that overlaps at first order touched all along, or
    /// only grazes here (C1 g): otherwise it closed before. `back`: the motion back; null: the arc has no length.
    [[nodiscard]] Objections check_back(const Gap& pair, const Velocities::Solution* back) const {
        const std::string name = to.named(pair.pair);
        if (back == nullptr) {
            const bool overlapped = std::any_of(from.touching.begin(), from.touching.end(),
                                                [](const Gap& gap) { return !gap.value.positive(); });
            return !pair.value.negative() || overlapped
                       ? Objections()
                       : Objection{true,
                                   fmt::format("{} overlap at first order, after a step before which none did", name)};
        }
        const Velocities& velocities = to.first->velocities();
        const Range rate = velocities.gap_rate(pair.pair, *back);
        const bool watched = pair.value.negative();
        if (!rate.has_zero()) {
            return rate.negative() || watched
                       ? Objection{!to.is_held(opened),
                                   fmt::format("{} touch at the end of the arc and {} before: the rate of their gap is "
                                               "in {} on the way back, their first-order gap in {}",
                                               name, rate.negative() ? "overlap" : "close", shown(rate),
                                               shown(pair.value))}
                       : Objections();
        }
        const Range bend = velocities.bend(pair.pair, opened, *back);
        return bend.negative() ? Objections(Objection{true, fmt::format("{} overlap before the end of the arc: the "
                                                                        "second derivative of their gap is in {}",
                                                                        name, shown(bend))})
                               : Objections();
    }
};

} // namespace

Objections check_exchange(const Place& place, const TieRecord& tie, std::size_t opened) {
    const auto wrong = [&](const std::string& what) {
        return Objection{true,
                         fmt::format("{} enters the list for {} ('{}'): {}", tie.contact, tie.against, tie.what, what)};
    };
    const auto pair = touching_pair(place, tie.contact);
    const auto leaves = position(place, tie.against);
    if (!place.chooses || !leaves || *leaves == opened || pair == place.touching.end() || place.is_held(opened)) {
        return wrong("no such exchange is possible");
    }
    const Velocities& velocities = place.first->velocities();
    const Velocities::Solution motion = velocities.opening(opened, +1);
    const Range rate = velocities.gap_rate(pair->pair, motion);
    if (!rate.has_zero()) {
        return wrong("the rate of its gap is in " + shown(rate));
    }
    const Range bend = velocities.bend(pair->pair, opened, motion);
    const Velocities::Solution other = velocities.opening(*leaves, +1);
    const Range share = velocities.gap_rate(pair->pair, other);
    const bool overlaps = tie.what == "second order"; // otherwise the pair rests
    const Range& first = overlaps ? bend : rate;
    if (bend.positive() || (bend.negative() && !overlaps) || share.negative()) {
        return wrong(fmt::format("second derivative of its gap in {}, share in {}", shown(bend), shown(share)));
    }
    if ((overlaps && !bend.negative()) || !share.positive()) {
        return Objection{false, fmt::format("{} enters the list ('{}'), its second derivative in {}, share in {}: not "
                                            "told from 0",
                                            tie.contact, tie.what, shown(bend), shown(share))};
    }
    Objections late = check_said(overlaps ? "second derivative" : "rate", {tie.first, tie.first_bound}, first);
    return late ? late : check_said("share", {tie.other, tie.other_bound}, share);
}

Objections check_rest(const Place& place, const TieRecord& tie, std::size_t opened, int direction) {
    const auto pair = touching_pair(place, tie.contact);
    if (pair == place.touching.end() || tie.choice != "zero" || tie.against != place.evidence->name(opened)) {
        return Objection{true, fmt::format("{} is taken to keep touching, but does not touch where {} opens",
                                           tie.contact, tie.against)};
    }
    const Velocities& velocities = place.first->velocities();
    const Velocities::Solution motion = velocities.opening(opened, direction);
    const Range rate = velocities.gap_rate(pair->pair, motion);
    const Range bend = velocities.bend(pair->pair, opened, motion);
    if (!rate.has_zero() || !bend.has_zero()) {
        return Objection{true, fmt::format("{} is taken to keep touching, but the rate of its gap is in {}, the second "
                                           "derivative in {}",
                                           tie.contact, shown(rate), shown(bend))};
    }
    Objections late = check_said("second derivative", {tie.first, tie.first_bound}, bend);
    return late ? late : check_said("rate", {tie.other, tie.other_bound}, rate);
}

Objections check_step(const Place& place, const EventRecord& event, std::size_t opened, int direction) {
    const bool said =
        std::any_of(event.ties.begin(), event.ties.end(), [](const TieRecord& t) { return t.what == "step"; });
    if (place.touching.empty()) {
        return said ? Objections(Objection{true, "a step of length O(eps), but no pair touches"}) : Objections();
    }
    const Velocities& velocities = place.first->velocities();
    const Velocities::Solution motion = velocities.opening(opened, direction);
    std::vector<Gap> ways; // the recorded first one to close
    for (const Gap& gap : place.touching) {
        const Range rate = velocities.gap_rate(gap.pair, motion);
        if (rate.negative()) { // otherwise it opens, or cannot be told to move
            const auto at = event.closed == place.named(gap.pair) ? ways.begin() : ways.end();
            ways.insert(at, {gap.pair, gap.value / -rate});
        }
    }
    std::optional<Range> shortest;
    std::optional<Contact> first;
    for (const Gap& way : ways) {
        if (!shortest || way.value.upper < shortest->lower) {
            shortest = way.value;
            first = way.pair;
        } else if (!(shortest->upper < way.value.lower) && !chosen_step(place, event, *first, way.pair)) {
            return Objection{false, fmt::format("{} and {} close after ways that are equal at first order",
                                                place.named(*first), place.named(way.pair))};
        }
    }
    if (said != first.has_value()) {
        return Objection{true, first ? fmt::format("{} touch and close at once at first order", place.named(*first))
                                     : "a step of length O(eps), but no pair that touches closes"};
    }
    if (first && event.closed != place.named(*first)) {
        return Objection{
            true, fmt::format("{} closes, but at first order {} close before", event.closed, place.named(*first))};
    }
    return {};
}

Objections check_ties(const Place& base, const Place& from, const Place& to, const EventRecord& event,
                      std::size_t opened, int direction) {
    const Arc arc{base, from, to, event, opened, direction};
    for (const TieRecord& tie : event.ties) {
        if (exchanges_list(tie)) {
            continue; // `check_exchange`
        }
        if (Objections wrong = tie.what == "rest" ? check_rest(from, tie, opened, direction) : arc.check(tie)) {
            return wrong;
        }
    }
    const bool stays =
        std::any_of(event.ties.begin(), event.ties.end(), [](const TieRecord& tie) { return tie.what == "step"; });
    std::optional<Velocities::Solution> back;
    if (!stays && !to.touching.empty()) {
        back = to.first->velocities().opening(opened, +1);
    }
    for (const Gap& pair : to.touching) {
        if (Objections wrong = arc.check_back(pair, back ? &*back : nullptr)) {
            return wrong;
        }
    }
    return {};
}

} // namespace isostat::checker
