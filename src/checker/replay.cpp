// The vertices of a replay, and the forces that are negative there.
#include "checker/replay.hpp"

#include "checker/first_order.hpp"
#include "checker/forces.hpp"
#include "checker/index.hpp"
#include "checker/strut.hpp"
#include "checker/vertex.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace isostat::checker {

namespace {

/// Signs of all forces of one stage: those that are no structural zeros, or the infinitesimal forces of structural
/// zeros. An objection where no force is proved negative, and one may be.
Objections negative_ones(const Place& place, bool finite, Decision& decision, bool still) {
    std::vector<int>& negative = decision.candidates;
    Objections open;
    const Evidence& e = *place.evidence;
    bool silent = false;
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        if (contains(place.zeros, l) == finite || static_cast<int>(l) == place.fresh || place.is_bar(l) ||
            (still && place.is_held(l) && !finite)) {
            continue;
        }
        if (finite && place.fresh >= 0 && place.silent[l]) {
            silent = true;
            continue;
        }
        if (finite && contains(place.ties, l) && place.chooses && !place.is_held(l)) {
            continue; // left at 0, so it opens nothing
        }
        const ContactForces& stage = finite ? e.forces : e.infinitesimal();
        if (!contains(place.ties, l) && stage.positive(l) && !place.is_held(l)) {
            continue;
        }
        const Range force = contains(place.ties, l) && finite ? place.first_force[l]
                            : finite                          ? e.forces[l]
                                                              : e.infinitesimal()[l];
        // A held coordinate competes with minus its magnitude.
        if (force.negative() || (force.positive() && place.is_held(l))) {
            negative.push_back(static_cast<int>(l));
        } else if (!force.positive()) {
            decision.open.push_back(static_cast<int>(l));
            open = Objection{false, fmt::format("the sign of the {}force of {} is not known: {}",
                                                finite ? "" : "infinitesimal ", e.name(l), shown(force))};
        }
    }
    if (silent && negative.empty()) {
        return Objection{false, "no force is negative but perhaps those of contacts that carry nothing at the turn"};
    }
    return negative.empty() ? open : Objections();
}

/// Adds the first-order terms of forces, of the load and of the gaps that cannot be told from 0.
void add_first_order(Place& place) {
    Evidence& e = *place.evidence;
    place.first = std::make_unique<FirstOrder>(e, place.state->perturbation->rho);
    place.first_force = place.first->forces(e.forces);
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        place.first_force[l] = place.first_force[l] + place.load.rate * e.slopes()[l];
    }
    // Forces that change with the radii are no structural zeros; nor are those that the pattern alone does not make 0.
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

} // namespace

double largest_force(const ContactForces& forces) {
    double largest = 0;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        largest = std::max(largest, forces.bounds(l).size());
    }
    return std::min(largest, std::numeric_limits<double>::max());
}

const std::vector<Gap>& Place::gaps() const {
    if (!gaps_) {
        gaps_ = smallest_gaps(evidence->problem, *state, evidence->vertex);
    }
    return *gaps_;
}

Range Place::coordinate(std::size_t k) const {
    return coordinate_at(evidence->problem, evidence->vertex, k);
}

Range Place::length(int axis) const {
    return coordinate(evidence->problem.layout.of_length(static_cast<std::size_t>(axis)));
}

namespace {

Objections place_with(int digits, State state, Place& place, const ExactLoad& load, int fresh,
                      const std::shared_ptr<const Solver>& near) {
    place.state = std::make_unique<State>(std::move(state));
    place.evidence = std::make_unique<Evidence>(*place.state, CheckerArithmetic::automatic, true, near,
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
        e.forces = ForcesAfter{e, load.shift}.all();
    }
    place.zeros = having_zero(e.forces);
    std::erase(place.zeros, fresh);
    if (place.state->perturbation) {
        add_first_order(place);
    }
    if (!vanish_structurally(e.problem, place.zeros, e.finite_load)) { // the other forces only cannot be told from 0
        const auto structural = structural_zeros(e.problem, e.finite_load);
        if (!structural) {
            return Objection{false, "some forces cannot be told from 0 and are no structural zeros"};
        }
        std::erase_if(place.zeros, [&](int l) { return !contains(*structural, static_cast<std::size_t>(l)); });
    }
    if (fresh >= 0) {
        place.silent = without_force(place);
    }
    return {};
}

} // namespace

Objections make_place(State state, Place& place, const ExactLoad& load, int fresh,
                      const std::shared_ptr<const Solver>& near, int digits) {
    Objections open = place_with(digits, std::move(state), place, load, fresh, near);
    if (place.evidence->problem.digits >= usual_digits || (!open && place.evidence->well_known())) {
        return open;
    }
    Place again;
    again.chooses = place.chooses;
    open = place_with(usual_digits, State(*place.state), again, load, fresh, near);
    place = std::move(again);
    return open;
}

ExactLoad meant_load(const State& state) {
    const auto& contacts = state.contacts;
    const auto vanishes = state.perturbation
                              ? std::find(contacts.begin(), contacts.end(), state.perturbation->load_zero)
                              : contacts.end();
    Place at;
    if (vanishes == contacts.end() || (make_place(State(state), at), !at.evidence->vertex.found)) {
        return {};
    }
    const auto l = static_cast<std::size_t>(vanishes - contacts.begin());
    const Range& slope = at.evidence->slopes()[l];
    if (slope.has_zero()) {
        return {};
    }
    // A stored load is the rounded exact load. If the found load is farther away, the stored load is taken as exact.
    const Range step = step_to_limit(*at.evidence, l);
    const auto& stress = state.load.stress;
    const Rational room(record_tolerance * std::max({std::abs(stress[0]), std::abs(stress[1]), std::abs(stress[2])}));
    if (step.lower < -room || step.upper > room) {
        return {};
    }
    // The rate is that of a contact that has opened: for a start it is given, as the radii are.
    const Enclosure& rate = state.perturbation->stress_rate;
    return {step, Range::around(Rational(rate.value), Rational(rate.radius))};
}

Objections sharpen(Place& place, int digits) {
    Place sharper;
    sharper.chooses = place.chooses;
    Objections open = make_place(State(*place.state), sharper, place.load, place.fresh, place.evidence->solver, digits);
    if (sharper.evidence->vertex.found) {
        sharper.evidence->solver = place.evidence->solver; // the next motion starts with the same factors
        sharper.said = std::move(place.said);
        place = std::move(sharper);
    }
    return open;
}

Objections decide(const Place& place, Decision& decision, bool still) {
    if (Objections open = negative_ones(place, true, decision, still)) {
        return open;
    }
    if (!decision.candidates.empty()) {
        decision.kind = "tension";
        return {};
    }
    if (Objections open = negative_ones(place, false, decision, still)) {
        return open;
    }
    decision.kind = decision.candidates.empty() ? "" : "rattler";
    return {};
}

Objections compare(const std::string& name, const Bounded& said, const Range& found, double loosest) {
    const auto [value, bound] = said;
    if (!std::isfinite(value) || !(bound >= 0)) {
        return Objection{true, fmt::format("{} is {} +- {}, found {}", name, value, bound, shown(found))};
    }
    if (!(bound <= loosest)) { // the number itself may be right all the same
        const Bounded itself{value, loosest};
        return std::isfinite(loosest) && !compare(name, itself, found, loosest)
                   ? Objections()
                   : Objection{false,
                               fmt::format("{} is {} +- {}: a bound that says too little (at most {:.3g} is accepted)",
                                           name, value, bound, loosest),
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

Objections compare_if_bounded(const std::string& name, const Bounded& said, const Range& found, double loosest) {
    return std::isnan(said.bound) ? Objection{false, fmt::format("{} is {}, without a bound", name, said.value), true}
                                  : compare(name, said, found, loosest);
}

} // namespace isostat::checker
