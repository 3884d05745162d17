// The vertices of a replay and what the rule opens there.
#include "checker/replay.hpp"

#include "checker/bounds.hpp"
#include "checker/choice.hpp"
#include "checker/gaps.hpp"
#include "checker/index.hpp"
#include "checker/structural_zeros.hpp"
#include "checker/strut.hpp"

#include <fmt/format.h>

namespace isostat::checker {

namespace {

/// Roundings of the quotient that is written as the stress at a limit.
constexpr double limit_rounding = 0x1p-50;

/// Sign of all forces of one stage: those that are no structural zeros, or the infinitesimal ones of those that are.
Objections negative_ones(const Place& place, bool finite, std::vector<int>& negative) {
    const Evidence& e = *place.evidence;
    bool silent = false;
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        if (contains(place.zeros, l) == finite || static_cast<int>(l) == place.fresh) {
            continue;
        }
        if (finite && place.fresh >= 0 && place.silent[l]) {
            silent = true;
            continue;
        }
        if (finite && contains(place.ties, l) && place.chooses && !place.is_held(l)) {
            continue; // left at 0: it opens nothing
        }
        const Range& force = contains(place.ties, l) && finite ? place.first_force[l]
                             : finite                          ? e.forces[l]
                                                               : e.infinitesimal()[l];
        if (place.is_held(l) && (force.negative() || force.positive())) {
            negative.push_back(static_cast<int>(l)); // it competes with minus its magnitude
        } else if (force.negative()) {
            negative.push_back(static_cast<int>(l));
        } else if (!force.positive()) {
            return Objection{false, fmt::format("the sign of the {}force of {} is not known: {}",
                                                finite ? "" : "infinitesimal ", e.name(l), shown(force))};
        }
    }
    if (silent && negative.empty()) {
        return Objection{false, "no force is negative but perhaps those of contacts that carry nothing at the turn"};
    }
    return {};
}

} // namespace

double largest_force(const std::vector<Range>& forces) {
    double size = 0;
    for (const Range& force : forces) {
        size = std::max({size, std::abs(force.lower.get_d()), std::abs(force.upper.get_d())});
    }
    return size;
}

const std::vector<Gap>& Place::gaps() const {
    if (!gaps_) {
        gaps_ = smallest_gaps(evidence->problem, *state, evidence->vertex);
    }
    return *gaps_;
}

Range Place::coordinate(std::size_t k) const {
    const bool moves = evidence->problem.dof_of[k] >= 0;
    return Range::around(evidence->problem.length(evidence->vertex.middle[k]),
                         moves ? evidence->vertex.radius : Rational(0));
}

Range Place::length(int axis) const {
    return coordinate(2 * static_cast<std::size_t>(evidence->problem.disks) + static_cast<std::size_t>(axis));
}

Objections make_place(State<2> state, Place& place, const ExactLoad& load, int fresh,
                      std::shared_ptr<const Solver> near, int digits) {
    place.state = std::make_unique<State<2>>(std::move(state));
    place.evidence = std::make_unique<Evidence>(*place.state, CheckerArithmetic::automatic, true, std::move(near),
                                                place.state->perturbation ? std::max(digits, more_digits) : digits);
    place.load = load;
    place.fresh = fresh;
    Evidence& e = *place.evidence;
    if (!e.problem.unsupported.empty()) {
        return Objection{false, e.problem.unsupported};
    }
    if (!e.vertex.found) {
        return Objection{false, "no true vertex is proved: " + e.why_no_vertex()};
    }
    if (load.shift.lower != 0 || load.shift.upper != 0) {
        for (std::size_t l = 0; l < e.forces.size(); ++l) {
            e.forces[l] = e.forces[l] + load.shift * e.slopes()[l];
        }
    }
    place.zeros = having_zero(e.forces);
    std::erase(place.zeros, fresh);
    if (fresh >= 0) {
        place.silent = without_force(place);
    }
    if (place.state->perturbation) {
        place.first = std::make_unique<FirstOrder>(e, place.state->perturbation->rho);
        place.first_force = place.first->forces(e.forces);
        for (std::size_t l = 0; l < e.forces.size(); ++l) {
            place.first_force[l] = place.first_force[l] + load.rate * e.slopes()[l];
        }
        // What changes with the radii is no structural zero; nor is what the pattern does not make vanish.
        const auto structural = place.chooses ? structural_zeros(e.problem, e.finite_load) : std::nullopt;
        for (const int l : place.zeros) {
            const auto index = static_cast<std::size_t>(l);
            if (!place.first_force[index].has_zero() || (structural && !contains(*structural, index))) {
                place.ties.push_back(l);
            }
        }
        std::erase_if(place.zeros, [&](int l) { return contains(place.ties, static_cast<std::size_t>(l)); });
        for (const Gap& gap : place.gaps()) {
            if (gap.value.has_zero()) {
                place.touching.push_back({gap.pair, place.first->gap(gap.pair)});
            }
        }
    }
    if (!vanish_structurally(e.problem, place.zeros, e.finite_load)) {
        return Objection{false, "some forces cannot be told from 0 and are no structural zeros"};
    }
    return {};
}

Objections sharpen(Place& place, int digits) {
    Place sharper;
    sharper.chooses = place.chooses;
    Objections open =
        make_place(State<2>(*place.state), sharper, place.load, place.fresh, place.evidence->solver, digits);
    if (sharper.evidence->vertex.found) {
        sharper.evidence->solver = place.evidence->solver; // the next motion starts with the same factors
        place = std::move(sharper);
    }
    return open;
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

namespace {

/// The largest bound of an end of the supported interval that is accepted.
double loosest_end(const Place& place, const Bounded& stress) {
    return force_tolerance * std::max(std::abs(place.stress()), std::abs(stress.value));
}

/// First-order term of the stress at which the force of a contact vanishes, from its first-order term there.
Range limit_rate(const Range& first, const Range& slope) {
    return Range(Rational(0)) - first / slope;
}

} // namespace

Objections compare(const char* name, const Bounded& said, const Range& found, double loosest) {
    const auto [value, bound] = said;
    if (!std::isfinite(value) || !(bound >= 0)) {
        return Objection{true, fmt::format("{} is {} +- {}, found {}", name, value, bound, shown(found))};
    }
    if (!(bound <= loosest)) {
        return Objection{false,
                         fmt::format("{} is {} +- {}: a bound that says too little (at most {:.3g} is accepted)", name,
                                     value, bound, loosest),
                         true};
    }
    const Rational lower = Rational(value) - Rational(bound);
    const Rational upper = Rational(value) + Rational(bound);
    if (found.lower >= lower && found.upper <= upper) {
        return {};
    }
    return Objection{found.upper < lower || found.lower > upper,
                     fmt::format("{} is {} +- {}, found {}", name, value, bound, shown(found))};
}

Objections compare(const char* name, const Bounded& said, const Range& found, double loosest, const EventRecord& event,
                   double size) {
    if (!std::isnan(said.bound)) {
        return compare(name, said, found, loosest);
    }
    if (!event.estimated) {
        return Objection{false, fmt::format("{} is {}, without a bound", name, said.value), true};
    }
    Objections off = compare(name, {said.value, record_tolerance * size}, found, record_tolerance * size);
    if (off) {
        off->wrong = false;
        off->for_good = true;
    }
    return off;
}

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
    const Range found = Range(Rational(place.stress())) - e.forces[opened] / e.slopes()[opened];
    return compare("the stress", stress, found, loosest_end(place, stress));
}

namespace {

/// What the infinitesimal loads compare where forces vanish together: how soon each does.
Range soon(const Place& place, std::size_t l) {
    const Range& slope = place.evidence->slopes()[l];
    return place.evidence->infinitesimal()[l] / (slope.negative() ? Range(Rational(0)) - slope : slope);
}

} // namespace

Objections check_limit_at(const Place& place, const Bounded& stress, std::size_t opened, ExactLoad& at_limit,
                          const std::vector<TieRecord>* said) {
    const Evidence& e = *place.evidence;
    const Range& slope = e.slopes()[opened];
    if (slope.has_zero()) {
        return Objection{false, fmt::format("the slope of the force of {} is not told from 0", e.name(opened))};
    }
    const Range step = Range(Rational(0)) - e.forces[opened] / slope;
    const Range found = Range(Rational(place.stress())) + place.load.shift + step;
    if (Objections wrong = compare("the stress", stress, found, loosest_end(place, stress))) {
        wrong->text += fmt::format(" ({} opens)", e.name(opened));
        return wrong;
    }
    const int direction = slope.negative() ? 1 : -1;
    if (direction > 0 ? step.negative() : step.positive()) {
        return Objection{true, fmt::format("the force of {} grows in this direction", e.name(opened))};
    }
    std::vector<Range> there;
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        there.push_back(e.forces[l] + step * e.slopes()[l]);
    }
    const std::vector<Range> first = place.first->forces(there);
    at_limit.shift = found - Range(Rational(stress.value));
    at_limit.rate = limit_rate(first[opened], slope);
    const ChoiceRule choice{"limit", [&](std::size_t l) { return there[l].has_zero() && !e.slopes()[l].has_zero(); },
                            [&](std::size_t l) { return soon(place, l); }};
    if (said != nullptr) {
        if (Objections wrong = check_choice(place, *said, opened, choice)) {
            return wrong;
        }
    }
    std::vector<int> together{static_cast<int>(opened)};
    for (std::size_t l = 0; l < there.size(); ++l) {
        if (l == opened || contains(place.zeros, l) || place.is_held(l) || there[l].positive()) {
            continue;
        }
        if (said != nullptr && recorded_choice(*said, "limit", e.name(opened), e.name(l)) != nullptr) {
            continue;
        }
        if (there[l].negative()) {
            return Objection{true,
                             fmt::format("the force of {} vanishes before that of {}", e.name(l), e.name(opened))};
        }
        if (e.slopes()[l].has_zero()) {
            if (!first[l].positive() && !place.chooses) {
                return Objection{false, fmt::format("the force of {} may vanish all along, and its first-order term at "
                                                    "the limit is in {}",
                                                    e.name(l), shown(first[l]))};
            }
            continue;
        }
        if ((direction > 0) == e.slopes()[l].positive()) {
            continue; // it grows from a force that is not negative
        }
        const Range later = (limit_rate(first[l], e.slopes()[l]) - at_limit.rate) * Range(Rational(direction));
        if (later.negative()) { // a run has more digits to tell the two loads apart
            return Objection{false,
                             fmt::format("the forces of {} and {} vanish at one load as far as is seen, and that of {} "
                                         "first: by {} at first order",
                                         e.name(l), e.name(opened), e.name(l), shown(later))};
        }
        const bool chosen = place.chooses && said == nullptr && comes_first(place, opened, l, choice);
        if (!later.positive() && !chosen) {
            together.push_back(static_cast<int>(l));
        }
    }
    if (together.size() == 1) {
        return {};
    }
    std::sort(together.begin(), together.end());
    Forces loaded = e.finite_load;
    for (std::size_t j = 0; j < loaded.size(); ++j) {
        loaded[j] = Range(abs(loaded[j].lower) + abs(e.unit_load[j].lower));
    }
    for (const int l : together) {
        const auto other = static_cast<std::size_t>(l);
        if (other == opened) {
            continue;
        }
        const Range mine = soon(place, opened);
        const Range its = soon(place, other);
        if (place.chooses && mine.upper < its.lower) {
            continue; // any of them may open, and the rule takes this one (C1)
        }
        if (!vary_together(e.problem, together, loaded) || !(mine.upper < its.lower)) {
            const bool earlier = vary_together(e.problem, together, loaded) && its.upper < mine.lower;
            return Objection{earlier,
                             fmt::format("{} and {} vanish together{}", e.name(opened), e.name(other),
                                         earlier ? ", and under the infinitesimal loads the second first" : "")};
        }
    }
    return {};
}

namespace {

/// One pair was chosen by name to close before another, after ways that are equal as far as the run knew.
bool chosen_step(const EventRecord& event, const Contact& chosen, const Contact& other) {
    const TieRecord* tie = recorded_choice(event.ties, "step", to_string<2>(chosen), to_string<2>(other));
    return tie != nullptr && tie->choice == "names" && chosen < other && tied_at_first_order(*tie);
}

} // namespace

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

Objections check_ties(const Place& from, const Place& to, const EventRecord& event, std::size_t opened, int direction) {
    const auto position = [](const Place& place, const std::string& name) -> std::optional<std::size_t> {
        for (std::size_t l = 0; l < place.state->contacts.size(); ++l) {
            if (place.evidence->name(l) == name) {
                return l;
            }
        }
        return {};
    };
    // The first-order term of one name in one kind of decision; nothing: there is no such term.
    const auto found = [&](const std::string& what, const std::string& name) -> std::optional<Range> {
        if (what == "gap") {
            for (const Gap& gap : to.touching) {
                if (to_string<2>(gap.pair) == name) {
                    return gap.value;
                }
            }
            return {};
        }
        if (what == "step") {
            for (const Gap& gap : from.touching) {
                if (to_string<2>(gap.pair) == name) {
                    const Velocities& velocities = from.first->velocities();
                    const Range rate = velocities.gap_rate(gap.pair, velocities.opening(opened, direction));
                    return rate.negative() ? std::optional<Range>(gap.value / (Range(Rational(0)) - rate))
                                           : std::nullopt;
                }
            }
            return {};
        }
        const bool limit = what == "limit" || what == "zero all along";
        const Place& place = limit ? from : to;
        const auto l = position(place, name);
        if (!l || !place.first) {
            return {};
        }
        if (!limit) {
            return place.first_force[*l];
        }
        const Evidence& e = *place.evidence;
        if (e.slopes()[opened].has_zero()) {
            return {};
        }
        const Range step = Range(Rational(0)) - e.forces[opened] / e.slopes()[opened];
        std::vector<Range> there;
        for (std::size_t k = 0; k < e.forces.size(); ++k) {
            there.push_back(e.forces[k] + step * e.slopes()[k]);
        }
        const Range first = place.first->forces(there)[*l];
        if (what == "zero all along") {
            return first;
        }
        return e.slopes()[*l].has_zero() ? std::nullopt : std::optional<Range>(limit_rate(first, e.slopes()[*l]));
    };
    // Left at 0: not refuted to vanish in the base; a gap is not told from 0 at first order either, as far as the run
    // knew.
    const auto stays_zero = [&](const TieRecord& tie) {
        if (tie.what == "gap") { // `found` asks of pairs that touch
            return std::abs(tie.other) <= tie.other_bound;
        }
        const bool all_along = tie.what == "zero all along";
        const Evidence& e = *(all_along ? from : to).evidence;
        for (std::size_t l = 0; l < e.forces.size(); ++l) {
            if (e.name(l) == tie.contact) {
                return (all_along ? e.slopes() : e.forces)[l].has_zero();
            }
        }
        return false;
    };
    for (const TieRecord& tie : event.ties) {
        if (!tie.choice.empty() && !to.chooses) {
            return Objection{true,
                             fmt::format("'{}' of {} is chosen, in a run that chooses nothing", tie.what, tie.contact)};
        }
        if (tie.choice == "zero" && !stays_zero(tie)) {
            return Objection{true, fmt::format("'{}' of {} is left at 0, but does not vanish", tie.what, tie.contact)};
        }
        if (tie.choice == "watched" && (tie.what != "gap" || tie.other > tie.other_bound)) {
            return Objection{true, fmt::format("'{}' of {} stays watched, but does not overlap at first order",
                                               tie.what, tie.against)};
        }
        const auto check = [&](const std::string& name, double value, double bound) -> Objections {
            const std::optional<Range> range = found(tie.what, name);
            if (!range) {
                return Objection{
                    true, fmt::format("a first-order decision '{}' about {}, of which there is none", tie.what, name)};
            }
            // Keys of held coordinates and of the rule least_negative are kept with the other sign.
            const bool either = tie.what == "opening";
            const auto meets = [&](const Rational& middle) {
                return range->lower <= middle + Rational(bound) && range->upper >= middle - Rational(bound);
            };
            if (!(bound >= 0) || !std::isfinite(value) || !std::isfinite(bound) ||
                !(meets(Rational(value)) || (either && meets(Rational(-value))))) {
                return Objection{true, fmt::format("the first-order term of {} ('{}') is {} +- {}, found in {}", name,
                                                   tie.what, value, bound, shown(*range))};
            }
            return {};
        };
        if (tie.what != "gap") {
            if (Objections wrong = check(tie.contact, tie.first, tie.first_bound)) {
                return wrong;
            }
        }
        if (!tie.against.empty()) {
            if (Objections wrong = check(tie.against, tie.other, tie.other_bound)) {
                return wrong;
            }
        }
    }
    return {};
}

Objections check_turn(const Place& place, const EventRecord& event, bool rattles) {
    const Evidence& e = *place.evidence;
    const auto held = static_cast<std::size_t>(place.fresh);
    const std::vector<Range>& forces = rattles ? e.infinitesimal() : e.forces;
    const Rational room = Rational(turn_tolerance) * Rational(largest_force(forces));
    if (forces[held].lower > room || forces[held].upper < -room) {
        return Objection{true,
                         fmt::format("the power of the load does not vanish where {} is held: its multiplier is in "
                                     "{}",
                                     event.closed, shown(forces[held]))};
    }
    const Velocities velocities(e);
    const Velocities::Solution motion = velocities.opening(held, 1);
    const auto k = static_cast<std::size_t>(place.state->contacts[held].i);
    Rational fastest = 0;
    for (const Rational& v : motion.middle) {
        fastest = std::max<Rational>(fastest, abs(v));
    }
    if (abs(motion.middle[k]) + motion.radius < fastest * Rational(1 - turn_tolerance)) {
        return Objection{true, fmt::format("{} is held, but another coordinate is {} times as fast", event.closed,
                                           Rational(fastest / abs(motion.middle[k])).get_d())};
    }
    return {};
}

Objections check_limit(const Place& place, const EventRecord& event, double bound, std::size_t opened,
                       ExactLoad& at_limit) {
    const Evidence& e = *place.evidence;
    if (event.force != 0 || !(event.force_bound == 0 || event.estimated)) {
        return Objection{true,
                         fmt::format("the force at a limit is {} +- {}, not 0 +- 0", event.force, event.force_bound)};
    }
    // The row says the same with the digits of an earlier rung.
    const double size = std::abs(event.stress) + std::abs(place.stress());
    const Bounded limit{event.stress, bound + limit_rounding * size};
    if (place.first) {
        return check_limit_at(place, limit, opened, at_limit, &event.ties);
    }
    // An equilibrium that stands at the end of its interval leaves it on the side on which the force falls.
    const bool up = event.stress == place.stress() ? e.slopes()[opened].negative() : event.stress > place.stress();
    const int direction = up ? 1 : -1;
    if (Objections wrong = check_load_end(place, limit, opened, direction)) {
        // The arc may have been found on a lower rung than the row, and has no bound of its own.
        const Bounded roughly{event.stress, bound + record_tolerance * size};
        wrong->wrong = wrong->wrong && check_load_end(place, roughly, opened, direction);
        return wrong;
    }
    // Forces that vanish together: the infinitesimal loads decide which one comes first.
    const Range step = Range(Rational(0)) - e.forces[opened] / e.slopes()[opened];
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        const bool other = l != opened && !contains(place.zeros, l);
        if (!other || (e.forces[l] + step * e.slopes()[l]).positive()) {
            continue;
        }
        if (e.slopes()[l].has_zero()) {
            return Objection{false, fmt::format("the force of {} may vanish at the limit too", e.name(l))};
        }
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

namespace {

/// Order of two contacts by what the rule compares: -1 when `a` has the smaller key, 0 when it is not known.
/// `at_first_order`: the finite forces did not tell.
int compare_keys(const Place& place, bool finite, std::size_t a, std::size_t b, bool& at_first_order) {
    const Evidence& e = *place.evidence;
    const auto key = [&](std::size_t l, bool first) {
        const Range& force = finite ? e.forces[l] : e.infinitesimal()[l];
        const bool flipped = place.is_held(l) && force.positive(); // it competes with minus its magnitude
        const Range& value = first ? place.first_force[l] : force;
        return flipped ? Range(Rational(0)) - value : value;
    };
    Range difference = key(a, false) - key(b, false);
    at_first_order = difference.has_zero() && finite && place.first;
    if (at_first_order) {
        difference = key(a, true) - key(b, true);
    }
    return difference.negative() ? -1 : difference.positive() ? 1 : 0;
}

} // namespace

namespace {

ChoiceRule opening_choice(const Place& place, std::size_t opened, const std::string& rule) {
    const auto tied = [&place, opened](std::size_t l) {
        bool at_first_order = false;
        (void)compare_keys(place, true, l, opened, at_first_order);
        return at_first_order;
    };
    const auto load = [&place, least = rule == "least_negative"](std::size_t l) {
        const Range& f = place.evidence->infinitesimal()[l];
        return least ? Range(Rational(0)) - f : f;
    };
    return {"opening", tied, load};
}

} // namespace

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
    if (place.is_held(opened) ? event.kind != "release" : decision.kind != event.kind) {
        return Objection{true, fmt::format("the kind is '{}': there is a {}force < 0 in {}", event.kind,
                                           decision.kind == "rattler" ? "infinitesimal " : "",
                                           e.name(static_cast<std::size_t>(decision.candidates[0])))};
    }
    const std::vector<Range>& forces = decision.kind == "rattler" ? e.infinitesimal() : e.forces;
    const Range& chosen = forces[opened];
    const ChoiceRule choice = opening_choice(place, opened, rule);
    if (Objections wrong = check_choice(place, place.said, opened, choice)) {
        return wrong;
    }
    if (!contains(decision.candidates, opened)) {
        return Objection{true, fmt::format("{} opens, but its force is in {}", e.name(opened), shown(chosen))};
    }
    for (const int l : decision.candidates) {
        const auto other = static_cast<std::size_t>(l);
        const Range& force = forces[other];
        if (other == opened || recorded_choice(place.said, "opening", e.name(opened), e.name(other)) != nullptr) {
            continue;
        }
        const bool most = rule == "most_negative";
        const bool by_name = rule == "least_index";
        bool at_first_order = false; // where a run has more digits to tell the forces apart
        int sign = compare_keys(place, decision.kind != "rattler", other, opened, at_first_order);
        if (by_name) {
            sign = place.state->contacts[other] < place.state->contacts[opened] ? -1 : 1;
            at_first_order = false;
        } else if (decision.kind != "rattler" && same_at_turn(place, opened, other)) {
            // Finite forces tell only where the turn was rounded to.
            sign = strut_order(place, other, opened).value_or(0);
        }
        const bool comes_first = most || by_name ? sign < 0 : rule == "least_negative" && sign > 0;
        if (comes_first && holds_may_explain(place, other, opened)) {
            return Objection{false,
                             fmt::format("{} opens with {}, but the rule '{}' takes {} with {}, unless a coordinate "
                                         "held earlier was released and turned back where it stood",
                                         e.name(opened), shown(chosen), rule, e.name(other), shown(force))};
        }
        if (comes_first) {
            return Objection{!at_first_order,
                             fmt::format("{} opens with {}, but the rule '{}' takes {} with {}", e.name(opened),
                                         shown(chosen), rule, e.name(static_cast<std::size_t>(l)), shown(force))};
        }
        if (sign == 0 && (most || rule == "least_negative")) {
            return Objection{false, fmt::format("the rule cannot order {} and {}", e.name(opened),
                                                e.name(static_cast<std::size_t>(l)))};
        }
    }
    const double size = largest_force(forces);
    if (Objections wrong =
            compare("force", {event.force, event.force_bound}, chosen, force_tolerance * size, event, 100 * size)) {
        return wrong;
    }
    if (rule != "most_negative" && rule != "least_negative" && rule != "least_index") {
        return Objection{false, fmt::format("the rule '{}' is not checked, only that the force is negative", rule),
                         true};
    }
    return {};
}

} // namespace isostat::checker
