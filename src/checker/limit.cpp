// The ends of supported intervals: which force vanishes first.
#include "checker/bounds.hpp"
#include "checker/choice.hpp"
#include "checker/first_order.hpp"
#include "checker/forces.hpp"
#include "checker/index.hpp"
#include "checker/strut.hpp"

#include <fmt/format.h>

namespace isostat::checker {

namespace {

/// Rounding of the quotient that is recorded as the stress at a limit.
constexpr double limit_rounding = 0x1p-50; // choice: roundings of a quotient (checker.md limit_rounding)

/// Tolerance relative to the largest stress, where the changing stress is near 0, as a shear stress is.
constexpr double load_tolerance = 1e-6; // checker.md load_tolerance

/// The largest accepted bound of an end of the supported interval.
double loosest_end(const Place& place, const Bounded& stress) {
    double largest = 0;
    for (const double other : place.state->load.stress) {
        largest = std::max(largest, std::abs(other));
    }
    return std::max(force_tolerance * std::max(std::abs(place.stress()), std::abs(stress.value)),
                    load_tolerance * largest);
}

/// The key of the infinitesimal loads where forces vanish together: how soon each force vanishes.
Range soon(const Place& place, std::size_t l) {
    const Range& slope = place.evidence->slopes()[l];
    return place.evidence->infinitesimal()[l] / (slope.negative() ? -slope : slope);
}

} // namespace

Objections check_load_end(const Place& place, const Bounded& stress, std::size_t opened, int direction) {
    const Evidence& e = *place.evidence;
    const LoadEndClaim claim{false,
                             {next_below(stress.value - stress.bound), next_above(stress.value + stress.bound)},
                             place.state->contacts[opened]};
    std::string text;
    const Verdict verdict = judge_load_end(e, claim, direction, text);
    if (verdict != Verdict::proved) {
        return Objection{verdict == Verdict::refuted,
                         fmt::format("the stress is {} +- {}, found {}", stress.value, stress.bound, text)};
    }
    const Range found = Range(Rational(place.stress())) + step_to_limit(e, opened);
    return compare("the stress", stress, found, loosest_end(place, stress));
}

namespace {

/// A limit in a run that settles ties at first order, where one contact opens.
struct Limit {
    const Place& place;
    std::size_t opened;
    const std::vector<TieRecord>* said; ///< recorded ties; null: no record
    std::vector<Range> there;           ///< the forces
    std::vector<Range> first;           ///< their first-order terms
    ExactLoad load;
    int direction;

    /// Whether another force vanishes before that of the opening contact, or with it: `together`.
    [[nodiscard]] Objections before(std::size_t l, bool& together) const;
    /// Whether the infinitesimal loads select the contact that opens among forces that vanish together.
    [[nodiscard]] Objections among(const std::vector<int>& together) const;
    /// Ties are chosen, and this force cannot be told from that of the opening contact: a row may name either (C1 b);
    /// an arc must have been chosen against this one, or against one of its class.
    [[nodiscard]] bool chosen_against(std::size_t l) const;
    /// Forces, except that of the opening contact, that cannot be told from 0 at the limit and are positive before.
    [[nodiscard]] std::vector<int> vanishing() const;
    /// Whether these forces vanish together by counting.
    [[nodiscard]] bool is_class(const std::vector<int>& together) const;
};

std::vector<int> Limit::vanishing() const {
    std::vector<int> found;
    for (std::size_t l = 0; l < there.size(); ++l) {
        const Range& slope = place.evidence->slopes()[l];
        if (l != opened && there[l].has_zero() && (direction > 0 ? slope.negative() : slope.positive())) {
            found.push_back(static_cast<int>(l));
        }
    }
    return found;
}

bool Limit::is_class(const std::vector<int>& together) const {
    std::vector<int> all = together; // contacts without force may depend on these: multiples too, by 0
    all.insert(all.end(), place.zeros.begin(), place.zeros.end());
    return vanish_with(*place.evidence, all, opened);
}

bool Limit::chosen_against(std::size_t l) const {
    const auto recorded = [&](std::size_t k) {
        return recorded_choice(*said, "limit", place.evidence->name(opened), place.evidence->name(k)) != nullptr;
    };
    if (!place.chooses || said == nullptr || recorded(l)) {
        return place.chooses;
    }
    const std::vector<int> all = vanishing();
    return std::any_of(all.begin(), all.end(), [&](int k) { return recorded(static_cast<std::size_t>(k)); }) &&
           is_class(all);
}

Objections Limit::before(std::size_t l, bool& together) const {
    const Evidence& e = *place.evidence;
    const Range& slope = e.slopes()[l];
    together = false;
    if (contains(place.zeros, l) || place.is_held(l) || there[l].positive()) {
        return {};
    }
    if (there[l].negative()) {
        return Objection{true, fmt::format("the force of {} vanishes before that of {}", e.name(l), e.name(opened))};
    }
    if (slope.has_zero()) {
        if (first[l].positive() || place.chooses) {
            return {};
        }
        return Objection{
            false, fmt::format("the force of {} may vanish all along, and its first-order term at the limit is in {}",
                               e.name(l), shown(first[l]))};
    }
    if ((direction > 0) == slope.positive()) {
        return {}; // the force grows from a value that is not negative
    }
    if (chosen_against(l)) {
        return {};
    }
    const Range later = (limit_rate(first[l], slope) - load.rate) * Range(Rational(direction));
    if (later.negative()) { // a run has more digits to tell the two loads apart
        return Objection{false, fmt::format("the forces of {} and {} vanish at one load as far as is seen, and that of "
                                            "{} first: by {} at first order",
                                            e.name(l), e.name(opened), e.name(l), shown(later))};
    }
    together = !later.positive();
    return {};
}

Objections Limit::among(const std::vector<int>& together) const {
    const Evidence& e = *place.evidence;
    const Range mine = soon(place, opened);
    for (const int l : together) {
        const auto other = static_cast<std::size_t>(l);
        if (other == opened) {
            continue;
        }
        const Range its = soon(place, other);
        const bool this_one = mine.upper < its.lower;
        if (place.chooses && this_one) {
            continue; // any of these may open, and the rule takes this one (C1)
        }
        const bool comparable = is_class(together);
        const bool earlier = comparable && its.upper < mine.lower;
        if (comparable && !earlier && said == nullptr) {
            continue; // these vanish at one load for any loads: a row may name any of them (K22)
        }
        if (!comparable || !this_one) {
            return Objection{earlier,
                             fmt::format("{} and {} vanish together{}", e.name(opened), e.name(other),
                                         earlier ? ", and under the infinitesimal loads the second first" : "")};
        }
    }
    return {};
}

} // namespace

Objections check_limit_at(const Place& place, const Bounded& stress, std::size_t opened, ExactLoad& at_limit,
                          const std::vector<TieRecord>* said) {
    const Evidence& e = *place.evidence;
    const Range& slope = e.slopes()[opened];
    if (slope.has_zero()) {
        return Objection{false, fmt::format("the slope of the force of {} is not told from 0", e.name(opened))};
    }
    const Range step = step_to_limit(e, opened);
    const Range found = Range(Rational(place.stress())) + place.load.shift + step;
    if (Objections wrong = compare("the stress", stress, found, loosest_end(place, stress))) {
        wrong->text += fmt::format(" ({} opens)", e.name(opened));
        return wrong;
    }
    const int direction = slope.negative() ? 1 : -1;
    if (direction > 0 ? step.negative() : step.positive()) {
        return Objection{true, fmt::format("the force of {} grows in this direction", e.name(opened))};
    }
    const std::vector<Range> there = ForcesAfter{e, step}.all();
    const std::vector<Range> first = place.first->forces(there);
    at_limit = {found - Range(Rational(stress.value)), limit_rate(first[opened], slope)};
    if (said != nullptr) {
        const ChoiceRule choice{"limit",
                                [&](std::size_t l) { return there[l].has_zero() && !e.slopes()[l].has_zero(); },
                                [&](std::size_t l) { return soon(place, l); }};
        if (Objections wrong = check_choice(place, *said, opened, choice)) {
            return wrong;
        }
    }
    const Limit limit{place, opened, said, there, first, at_limit, direction};
    std::vector<int> together{static_cast<int>(opened)};
    for (std::size_t l = 0; l < there.size(); ++l) {
        bool with_it = false;
        if (Objections wrong = l == opened ? Objections() : limit.before(l, with_it)) {
            return wrong;
        }
        if (with_it) {
            together.push_back(static_cast<int>(l));
        }
    }
    std::sort(together.begin(), together.end());
    return together.size() == 1 ? Objections() : limit.among(together);
}

namespace {

/// Checks that the infinitesimal loads select the opening contact among forces that vanish together.
Objections taken_by_loads(const Place& place, std::size_t opened, const std::vector<std::size_t>& together) {
    const Evidence& e = *place.evidence;
    for (const std::size_t l : together) {
        if (soon(place, l).upper < soon(place, opened).lower) {
            return Objection{
                true, fmt::format("{} vanishes at the same load, and first under the infinitesimal loads", e.name(l))};
        }
        if (!(soon(place, opened).upper < soon(place, l).lower)) {
            return Objection{false, fmt::format("{} and {} vanish together", e.name(opened), e.name(l))};
        }
    }
    return {};
}

} // namespace

Objections check_limit(const Place& place, const EventRecord& event, double bound, std::size_t opened,
                       ExactLoad& at_limit) {
    const Evidence& e = *place.evidence;
    if (event.force != 0 || event.force_bound != 0) {
        return Objection{true,
                         fmt::format("the force at a limit is {} +- {}, not 0 +- 0", event.force, event.force_bound)};
    }
    // The row has the same number with the digits of an earlier rung.
    const double size = std::abs(event.stress) + std::abs(place.stress());
    const Bounded limit{event.stress, bound + limit_rounding * size};
    if (place.first) {
        return check_limit_at(place, limit, opened, at_limit, &event.ties);
    }
    // An equilibrium at the end of its interval leaves it on the side on which the force falls.
    const bool up = event.stress == place.stress() ? e.slopes()[opened].negative() : event.stress > place.stress();
    const int direction = up ? 1 : -1;
    if (Objections wrong = check_load_end(place, limit, opened, direction)) {
        // The arc may have been found on a lower rung than the row, and has no bound of its own.
        const Bounded roughly{event.stress, bound + record_tolerance * size};
        wrong->wrong = wrong->wrong && check_load_end(place, roughly, opened, direction);
        return wrong;
    }
    // Forces that vanish together with that of `opened`.
    const ForcesAfter there{e, step_to_limit(e, opened)};
    std::vector<std::size_t> together;
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        const bool other = l != opened && !contains(place.zeros, l) && !place.is_bar(l);
        if (!other || there.positive(l)) {
            continue;
        }
        if (e.slopes()[l].has_zero()) {
            return Objection{false, fmt::format("the force of {} may vanish at the limit too", e.name(l))};
        }
        together.push_back(l);
    }
    return taken_by_loads(place, opened, together);
}

} // namespace isostat::checker
