// First-order decisions that records name.
#include "checker/choice.hpp"
#include "checker/limit.hpp"
#include "checker/recorded_arc.hpp"

#include <fmt/format.h>

namespace isostat::checker {

namespace {

/// One pair was chosen by name to close before another, after ways that are equal as far as the run knew.
bool chosen_step(const EventRecord& event, const Contact& chosen, const Contact& other) {
    const TieRecord* tie = recorded_choice(event.ties, "step", to_string<2>(chosen), to_string<2>(other));
    return tie != nullptr && tie->choice == "names" && chosen < other && tied_at_first_order(*tie);
}

std::optional<std::size_t> position(const Place& place, const std::string& name) {
    for (std::size_t l = 0; l < place.state->contacts.size(); ++l) {
        if (place.evidence->name(l) == name) {
            return l;
        }
    }
    return {};
}

/// First-order gap of a pair that touches.
std::optional<Range> first_gap(const Place& place, const std::string& name) {
    for (const Gap& gap : place.touching) {
        if (to_string<2>(gap.pair) == name) {
            return gap.value;
        }
    }
    return {};
}

/// First-order length of the way on which a pair that touches closes; nothing when it does not close.
std::optional<Range> first_way(const Place& from, const std::string& name, std::size_t opened, int direction) {
    for (const Gap& gap : from.touching) {
        if (to_string<2>(gap.pair) == name) {
            const Velocities& velocities = from.first->velocities();
            const Range rate = velocities.gap_rate(gap.pair, velocities.opening(opened, direction));
            return rate.negative() ? std::optional<Range>(gap.value / (Range(Rational(0)) - rate)) : std::nullopt;
        }
    }
    return {};
}

/// At the limit where `opened` opens: first-order term of a force that is 0 all along, or of the stress at which it is
/// 0.
std::optional<Range> first_limit(const Place& from, const std::string& name, std::size_t opened, bool all_along) {
    const auto l = position(from, name);
    const auto& slopes = from.evidence->slopes();
    if (!l || !from.first || slopes[opened].has_zero()) {
        return {};
    }
    const Range first = from.first->forces(forces_after(from, step_to_limit(from, opened)))[*l];
    if (all_along) {
        return first;
    }
    return slopes[*l].has_zero() ? std::nullopt : std::optional<Range>(limit_rate(first, slopes[*l]));
}

/// A recorded enclosure and a proved one have a number in common.
bool meets(const Range& range, const Rational& value, double bound) {
    return range.lower <= value + Rational(bound) && range.upper >= value - Rational(bound);
}

bool is_finite(double value, double bound) {
    return std::isfinite(value) && std::isfinite(bound) && bound >= 0;
}

/// An arc whose ties are looked at.
struct Arc {
    const Place& base; ///< where it starts, with the list that was reached
    const Place& from; ///< the same with the list that opens
    const Place& to;
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
        const auto l = position(to, name);
        return l && to.first ? std::optional<Range>(to.first_force[*l]) : std::nullopt;
    }

    /// Left at 0: not refuted to vanish in the base; a gap is not told from 0 at first order either, as far as the run
    /// knew.
    [[nodiscard]] bool stays_zero(const TieRecord& tie) const {
        if (tie.what == "gap") { // `term` asks of pairs that touch
            return std::abs(tie.other) <= tie.other_bound;
        }
        const bool all_along = tie.what == "zero all along";
        const Place& place = all_along ? base : to;
        const auto l = position(place, tie.contact);
        return l && (all_along ? place.evidence->slopes() : place.evidence->forces)[*l].has_zero();
    }

    [[nodiscard]] Objections check_term(const TieRecord& tie, const std::string& name, double value,
                                        double bound) const {
        const std::optional<Range> range = term(tie.what, name);
        if (!range) {
            return Objection{
                true, fmt::format("a first-order decision '{}' about {}, of which there is none", tie.what, name)};
        }
        // Keys of held coordinates and of the rule least_negative are kept with the other sign.
        const bool either = tie.what == "opening";
        if (!is_finite(value, bound) ||
            !(meets(*range, Rational(value), bound) || (either && meets(*range, Rational(-value), bound)))) {
            return Objection{true, fmt::format("the first-order term of {} ('{}') is {} +- {}, found in {}", name,
                                               tie.what, value, bound, shown(*range))};
        }
        return {};
    }
};

} // namespace

Objections check_exchange(const Place& place, const TieRecord& tie, std::size_t opened) {
    const auto wrong = [&](const std::string& what) {
        return Objection{true,
                         fmt::format("{} enters the list for {} ('{}'): {}", tie.contact, tie.against, tie.what, what)};
    };
    const auto pair = std::find_if(place.touching.begin(), place.touching.end(),
                                   [&](const Gap& gap) { return to_string<2>(gap.pair) == tie.contact; });
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
    const Range share = velocities.gap_rate(pair->pair, velocities.opening(*leaves, +1));
    const bool overlaps = tie.what == "second order"; // else it rests
    const Range& first = overlaps ? bend : rate;
    if (bend.positive() || (bend.negative() && !overlaps) || share.negative()) {
        return wrong(fmt::format("second derivative of its gap in {}, share in {}", shown(bend), shown(share)));
    }
    if ((overlaps && !bend.negative()) || !share.positive()) {
        return Objection{false, fmt::format("{} enters the list ('{}'), its second derivative in {}, share in {}: not "
                                            "told from 0",
                                            tie.contact, tie.what, shown(bend), shown(share))};
    }
    if (!is_finite(tie.first, tie.first_bound) || !is_finite(tie.other, tie.other_bound) ||
        !meets(first, Rational(tie.first), tie.first_bound) || !meets(share, Rational(tie.other), tie.other_bound)) {
        return wrong(fmt::format("{} {} +- {} found in {}, share {} +- {} found in {}",
                                 overlaps ? "second derivative" : "rate", tie.first, tie.first_bound, shown(first),
                                 tie.other, tie.other_bound, shown(share)));
    }
    return {};
}

Objections check_rest(const Place& place, const TieRecord& tie, std::size_t opened, int direction) {
    const auto pair = std::find_if(place.touching.begin(), place.touching.end(),
                                   [&](const Gap& gap) { return to_string<2>(gap.pair) == tie.contact; });
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
    return {};
}

Objections check_step(const Place& place, const EventRecord& event, std::size_t opened, int direction) {
    const bool said =
        std::any_of(event.ties.begin(), event.ties.end(), [](const TieRecord& t) { return t.what == "step"; });
    if (place.touching.empty()) {
        return said ? Objections(Objection{true, "a step of length O(eps), but no pair touches"}) : Objections();
    }
    const Velocities& velocities = place.first->velocities();
    const Velocities::Solution motion = velocities.opening(opened, direction);
    std::vector<Gap> ways; // the one that is said to close first
    for (const Gap& gap : place.touching) {
        const Range rate = velocities.gap_rate(gap.pair, motion);
        if (rate.negative()) { // else it opens, or stays as far as is seen
            const auto at = event.closed == to_string<2>(gap.pair) ? ways.begin() : ways.end();
            ways.insert(at, {gap.pair, gap.value / (Range(Rational(0)) - rate)});
        }
    }
    std::optional<Range> shortest;
    std::optional<Contact> first;
    for (const Gap& way : ways) {
        if (!shortest || way.value.upper < shortest->lower) {
            shortest = way.value;
            first = way.pair;
        } else if (!(shortest->upper < way.value.lower) && !chosen_step(event, *first, way.pair)) {
            return Objection{false, fmt::format("{} and {} close after ways that are equal at first order",
                                                to_string<2>(*first), to_string<2>(way.pair))};
        }
    }
    if (said != first.has_value()) {
        return Objection{true, first ? fmt::format("{} touch and close at once at first order", to_string<2>(*first))
                                     : "a step of length O(eps), but no pair that touches closes"};
    }
    if (first && event.closed != to_string<2>(*first)) {
        return Objection{
            true, fmt::format("{} closes, but at first order {} close before", event.closed, to_string<2>(*first))};
    }
    return {};
}

Objections check_ties(const Place& base, const Place& from, const Place& to, const EventRecord& event,
                      std::size_t opened, int direction) {
    const Arc arc{base, from, to, opened, direction};
    for (const TieRecord& tie : event.ties) {
        if (exchanges_list(tie)) {
            continue; // `check_exchange`
        }
        if (tie.what == "rest") {
            if (Objections wrong = check_rest(from, tie, opened, direction)) {
                return wrong;
            }
            continue;
        }
        if (tie.choice == "zero" && !arc.stays_zero(tie)) {
            return Objection{true, fmt::format("'{}' of {} is left at 0, but does not vanish", tie.what, tie.contact)};
        }
        if (tie.choice == "watched" && (tie.what != "gap" || tie.other > tie.other_bound)) {
            return Objection{true, fmt::format("'{}' of {} stays watched, but does not overlap at first order",
                                               tie.what, tie.against)};
        }
        if (tie.what != "gap") {
            if (Objections wrong = arc.check_term(tie, tie.contact, tie.first, tie.first_bound)) {
                return wrong;
            }
        }
        if (!tie.against.empty()) {
            if (Objections wrong = arc.check_term(tie, tie.against, tie.other, tie.other_bound)) {
                return wrong;
            }
        }
    }
    return {};
}

} // namespace isostat::checker
