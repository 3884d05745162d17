// The numbers of records against the vertices of a replay.
#include "checker/choice.hpp"
#include "checker/index.hpp"
#include "checker/newton.hpp"
#include "checker/rational.hpp"
#include "checker/replay.hpp"
#include "checker/vertex.hpp"

#include <fmt/format.h>

#include <set>

namespace isostat::checker {

namespace {

/// Compares a recorded number with the found one, up to `record_tolerance` of `size`.
Objections compare(const std::string& name, double recorded, const Range& found, double size) {
    const Rational room =
        // exact: not 0
        Rational(record_tolerance) * Rational(std::clamp(size, 1e-300, std::numeric_limits<double>::max()));
    if (std::isfinite(recorded) && Rational(recorded) >= found.lower - room &&
        Rational(recorded) <= found.upper + room) {
        return {};
    }
    return Objection{true, fmt::format("{} is {}, found {}", name, recorded, shown(found))};
}

/// Compares a column, with its column `_bound`.
Objections compare(const std::string& name, const EquilibriumLine& line, const Range& found, double size) {
    return compare(name, Bounded{line.at(name), line.bound(name)}, found, record_tolerance * size);
}

Objections compare(const std::string& name, int recorded, int found) {
    if (recorded == found) {
        return {};
    }
    return Objection{true, fmt::format("{} is {}, found {}", name, recorded, found)};
}

/// 0 without a reference length. The tilts follow the axes: A_ab over the length of b.
Range strain_of(const Place& place, int axis) {
    const Load& load = place.state->load;
    const Range over{Rational(load.strain_length(axis))};
    return over.positive() ? (Range(Rational(load.at_rest(axis))) - place.length(axis)) / over : Range(Rational(0));
}

/// Work of a load between two vertices.
Range work(const Place& from, const Place& to, const Forces& load, double& size) {
    Range sum(Rational(0));
    size = 0;
    for (const auto& [dof, force] : load.acting()) {
        const auto k = static_cast<std::size_t>(from.evidence->problem.coordinate_of[dof]);
        sum = sum + force * (to.coordinate(k) - from.coordinate(k));
        size += std::abs(force.lower.get_d() * to.coordinate(k).lower.get_d());
    }
    return sum;
}

/// Work of the infinitesimal loads between two vertices: from doubles where these show it to be positive.
Range infinitesimal_work(const Place& from, const Place& to) {
    const std::vector<double>& load = to.state->load.infinitesimal;
    const double off = rounded_up(from.evidence->vertex.moved_most + to.evidence->vertex.moved_most);
    Bounds sum;
    for (std::size_t k = 0; k < load.size(); ++k) {
        const Bounds way = Bounds(to.state->packing.q[k]) - from.state->packing.q[k];
        sum = sum + load[k] * (way + Bounds::around(off));
    }
    double unused = 0;
    return sum.positive() && std::isfinite(sum.upper)
               ? Range(Rational(sum.lower), Rational(sum.upper))
               : work(from, to, infinitesimal_load(to.evidence->problem, *to.state), unused);
}

std::set<Contact> contact_set(const State& state) {
    return {state.contacts.begin(), state.contacts.end()};
}

/// Number of bodies without a force, each counted at its first member.
int rattlers(const Place& place) {
    const std::vector<int> body = bodies_of(place.state->packing);
    std::vector<bool> rattles(body.size());
    for (std::size_t i = 0; i < body.size(); ++i) {
        rattles[i] = body[i] == static_cast<int>(i);
    }
    for (std::size_t l = 0; l < place.state->contacts.size(); ++l) {
        const Contact& c = place.state->contacts[l];
        if (!contains(place.zeros, l) && c.is_unilateral()) {
            rattles[at(body[at(c.i)])] = false;
            rattles[at(body[at(c.of_disks() ? c.j : c.i)])] = false;
        }
    }
    return static_cast<int>(std::count(rattles.begin(), rattles.end(), true));
}

/// A row names two disks without the image: it is right when it is right for one of the possible pairs, and wrong when
/// it is wrong for each. Nothing: no such pair exists.
template <class Pairs, class Pair, class Check>
std::optional<Objections> check_meant(const std::optional<Contact>& columns, const Pairs& among, const Pair& pair_of,
                                      const Check& check) {
    std::optional<Objections> found;
    for (std::size_t l = 0; l < among.size() && columns; ++l) {
        if (!may_be(*columns, pair_of(among[l]))) {
            continue;
        }
        Objections objection = check(l);
        if (!objection) {
            return Objections();
        }
        if (!found || ((*found)->wrong && !objection->wrong)) {
            found = std::move(objection);
        }
    }
    return found;
}

/// Calls `check_meant` for the contacts of a place.
template <class Check>
std::optional<Objections> check_meant(const std::optional<Contact>& columns, const Place& place, const Check& check) {
    return check_meant(
        columns, place.state->contacts, [](const Contact& c) { return c; }, check);
}

Objections check_smallest_gap(const Place& place, const EquilibriumLine& line) {
    const std::vector<Gap>& near = place.gaps();
    const auto pair = contact_of_columns(line.integer("min_gap_i"), line.integer("min_gap_j"), place.state->packing);
    const bool none = line.integer("min_gap_i") == no_contact && line.integer("min_gap_j") == no_contact;
    if (near.empty()) {
        const bool infinite = std::isinf(line.at("min_gap")) && line.bound("min_gap") == 0;
        return none && infinite ? Objections() : Objection{true, "min_gap is said to be of a pair, but there is none"};
    }
    const auto size = place.state->packing.max_radius();
    const auto found = check_meant(
        pair, near, [](const Gap& gap) { return gap.pair; },
        [&](std::size_t l) { return compare("min_gap", line, near[l].value, size); });
    return found ? *found
                 : Objection{true, fmt::format("min_gap is said to be of {}, found of {}",
                                               pair ? place.named(*pair) : "no pair", place.named(near[0].pair))};
}

Objections check_smallest_force(const Place& place, const EquilibriumLine& line) {
    const Evidence& e = *place.evidence;
    std::optional<std::size_t> smallest;
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        if (e.state.contacts[l].is_unilateral() && !contains(place.zeros, l) &&
            (!smallest || (e.forces.bounds(l).lower <= e.forces.bounds(*smallest).upper &&
                           e.forces[l].lower < e.forces[*smallest].lower))) {
            smallest = l;
        }
    }
    if (!smallest) {
        const bool none = std::isinf(line.at("min_force")) && line.integer("min_force_i") == no_contact;
        return none ? Objections() : Objection{true, "min_force is said of a contact, but none carries a force"};
    }
    const Bounded said{line.at("min_force"), line.at("force_bound")};
    const double loosest = force_tolerance * largest_force(e.forces);
    if (Objections wrong = compare("min_force", said, e.forces[*smallest], loosest)) {
        return wrong;
    }
    const auto named =
        contact_of_columns(line.integer("min_force_i"), line.integer("min_force_j"), place.state->packing);
    const auto found =
        check_meant(named, place, [&](std::size_t l) { return compare("min_force", said, e.forces[l], loosest); });
    return found ? *found : Objection{true, "min_force is said to be of what is no contact"};
}

Objections check_interval(const Place& place, const EquilibriumLine& line, bool high) {
    const std::string name = line.names->stress + (high ? "_high" : "_low");
    const Bounded stress{line.at(name), line.bound(name)};
    const auto opens = contact_of_columns(line.integer(high ? "opens_high_i" : "opens_low_i"),
                                          line.integer(high ? "opens_high_j" : "opens_low_j"), place.state->packing);
    const bool named = line.integer(high ? "opens_high_i" : "opens_low_i") != no_contact ||
                       line.integer(high ? "opens_high_j" : "opens_low_j") != no_contact;
    if (std::isfinite(stress.value) != opens.has_value() || (!opens && named)) {
        return Objection{true, "an end of the supported interval has a contact exactly when it is bounded"};
    }
    const int direction = high ? 1 : -1;
    if (!opens) {
        std::string text;
        const Verdict verdict = judge_load_end(*place.evidence, {true, {}, {}}, direction, text);
        const bool infinite = stress.value == direction * std::numeric_limits<double>::infinity() && stress.bound == 0;
        // Where ties are chosen a slope that cannot be told from 0 opens nothing, as at the other ends (C1; K22).
        const bool none = verdict == Verdict::proved || (verdict == Verdict::undecided && place.chooses);
        return none && infinite
                   ? Objections()
                   : Objection{!infinite || verdict == Verdict::refuted,
                               fmt::format("{} = {} +- {}: found {}", name, stress.value, stress.bound, text)};
    }
    auto found = check_meant(opens, place, [&](std::size_t opened) -> Objections {
        ExactLoad unused;
        const Range& slope = place.evidence->slopes()[opened];
        if (high ? slope.positive() : slope.negative()) {
            return Objection{true, fmt::format("the force of {} grows in this direction", place.named(*opens))};
        }
        return place.first ? check_limit_at(place, stress, opened, unused, nullptr)
                           : check_load_end(place, stress, opened, direction);
    });
    if (!found) {
        return Objection{true, fmt::format("{} ends the supported interval, but is no contact", place.named(*opens))};
    }
    if (*found) {
        (*found)->text = fmt::format("{}: {}", name, (*found)->text);
    }
    return *found;
}

/// The recorded tie of a pair that touches at the end; null: no record.
const TieRecord* said_of_gap(const EventRecord& event, const std::string& pair) {
    const auto tie = std::find_if(event.ties.begin(), event.ties.end(),
                                  [&](const TieRecord& t) { return t.what == "gap" && t.against == pair; });
    return tie == event.ties.end() ? nullptr : &*tie;
}

/// The arc is of length O(eps): no finite motion.
bool is_first_order_step(const EventRecord& event) {
    return std::any_of(event.ties.begin(), event.ties.end(), [](const TieRecord& tie) { return tie.what == "step"; });
}

/// A pair touches, and would overlap with radii R_i + eps rho_i.
Objection touches(const std::string& pair, const char* where, const Range& first) {
    return {first.negative(), fmt::format("{} touch at {}, first-order gap in {}", pair, where, shown(first))};
}

/// No pair overlaps. `settled`: judges pairs that touch, from their first-order gaps.
template <class Settled> Objections check_no_overlap(const Place& place, const char* where, const Settled& settled) {
    for (const Gap& gap : place.gaps()) {
        if (gap.value.has_zero() && place.first) {
            if (Objections open = settled(gap.pair, place.first->gap(gap.pair))) {
                return open;
            }
            continue;
        }
        if (gap.value.negative()) {
            return Objection{
                true, fmt::format("{} overlap at {}, gap in {}", place.named(gap.pair), where, shown(gap.value))};
        }
        if (!gap.value.positive()) {
            return Objection{false, fmt::format("{} may overlap at {}", place.named(gap.pair), where)};
        }
    }
    return {};
}

/// Checks that the recorded power is 0 where the arc ends at a power turn.
Objections check_power_at_turn(const Place& to, const EventRecord& event) {
    const double room = turn_tolerance * std::max(1e-300, largest_force(to.evidence->forces)); // exact: not 0
    if (!(std::abs(event.power) <= room) || !std::isnan(event.power_bound)) {
        return Objection{true, fmt::format("the power is {} +- {} at a power turn: expected 0, without a bound",
                                           event.power, event.power_bound)};
    }
    return {};
}

/// Checks that the recorded power at a new contact is that of the load, and positive: F . v = f_c for the motion v on
/// which the gap of the new contact c closes at the rate 1 and no other changes. By counting this power may be 0 at
/// this very place, where the grain that closes the gap is in a plane with others.
Objections check_power_at_contact(const Place& to, const EventRecord& event, bool rattles) {
    const auto& contacts = to.state->contacts;
    const auto slot = std::find(contacts.begin(), contacts.end(), *contact_named(event.closed, to.state->packing));
    const auto l = static_cast<std::size_t>(slot - contacts.begin());
    const ContactForces& forces = rattles ? to.evidence->infinitesimal() : to.evidence->forces;
    const bool zero = !rattles && contains(to.zeros, l);
    const Range power = zero ? Range(Rational(0)) : forces[l];
    if (!zero && !power.positive() && !(to.first && power.has_zero())) {
        return Objection{power.negative(),
                         fmt::format("the power is in {}: expected > 0 at the end of every arc", shown(power))};
    }
    if (rattles && !to.first && !contains(to.zeros, l) && !to.evidence->forces[l].positive()) {
        return Objection{to.evidence->forces[l].negative(),
                         fmt::format("the power of the finite load is in {}", shown(to.evidence->forces[l]))};
    }
    return compare_if_bounded("power", {event.power, event.power_bound}, power,
                              force_tolerance * largest_force(forces));
}

/// The decrease of Phi = sum sigma_a ln L_a (S5 (b), stability.md). \pre true stresses, without loads on disks
Range fall_of_phi(const Place& from, const Place& to) {
    Range fall(Rational(0));
    for (int a = 0; a < to.state->packing.dimension; ++a) {
        fall = fall +
               Range(stress_of(to.state->load, static_cast<std::size_t>(a))) * logarithm(from.length(a) / to.length(a));
    }
    return fall;
}

/// Checks that the recorded work is that of the finite loads, if dead, and that the potential falls, if there is one.
Objections check_work(const Place& from, const Place& to, const EventRecord& event, bool rattles) {
    const Load& load = to.state->load;
    const bool dead = load.kind == LoadKind::nominal;
    double size = 0;
    const Range done = dead ? work(from, to, to.evidence->finite_load, size) : Range(Rational(0));
    if (Objections wrong =
            !dead ? Objections()
                  : compare_if_bounded("work", {event.work, event.work_bound}, done, record_tolerance * size)) {
        return wrong;
    }
    const bool potential =
        dead || rattles || std::all_of(load.disk_force.begin(), load.disk_force.end(), [](double f) { return f == 0; });
    if (is_first_order_step(event) || !potential) {
        return {}; // no work
    }
    // On arcs of rattlers the finite load does no work, so the infinitesimal one decides.
    const Range decides = rattles ? infinitesimal_work(from, to) : dead ? done : fall_of_phi(from, to);
    if (!decides.positive()) {
        return Objection{decides.negative(),
                         fmt::format("the potential does not decrease: work in {}", shown(decides))};
    }
    return {};
}

/// Checks that no force is negative.
Objections check_forces(const Place& place) {
    Decision decision;
    if (Objections open = decide(place, decision, !place.state->packing.bars.empty())) {
        return open;
    }
    if (decision.kind.empty()) {
        return {};
    }
    const Evidence& e = *place.evidence;
    const ContactForces& forces = decision.kind == "rattler" ? e.infinitesimal() : e.forces;
    // A negative force that is told from 0 here refutes the row. A force that cannot be told from 0 does not, because
    // the run may have decided its sign with more digits.
    const auto told = [&](int l) { return !forces[static_cast<std::size_t>(l)].has_zero(); };
    const auto first = std::find_if(decision.candidates.begin(), decision.candidates.end(), told);
    const bool wrong = first != decision.candidates.end();
    const auto l = static_cast<std::size_t>(wrong ? *first : decision.candidates[0]);
    const bool rattler = decision.kind == "rattler";
    const std::string found = fmt::format("no equilibrium: the {}force of {} is in {}", rattler ? "infinitesimal " : "",
                                          e.name(l), shown(forces[l]));
    // Where the load of an axis is 0 counting makes forces vanish that the run only saw near 0, and left at 0 by
    // choice, which is an equilibrium of the finite loads for any infinitesimal ones (C1).
    const bool left = rattler && is_left(place, l);
    return Objection{wrong && !left, left ? found + ", which the run left at 0" : found};
}

Objections check_counts(const Place& place, const EquilibriumLine& line) {
    const Evidence& e = *place.evidence;
    const int contacts = e.problem.contacts() - e.count(ContactKind::bar);
    const auto zeros = static_cast<int>(
        std::count_if(place.zeros.begin(), place.zeros.end(), [&](int l) { return !place.is_bar(at(l)); }));
    const std::vector<std::pair<const char*, int>> counts{{"dofs", contacts},
                                                          {"contacts", contacts},
                                                          {"rank", contacts},
                                                          {"h", 0},
                                                          {"k", 0},
                                                          {"backbone", contacts - zeros},
                                                          {"held", e.count(ContactKind::held)},
                                                          {"rattlers", rattlers(place)},
                                                          {"proved", 1}};
    for (const auto& [name, found] : counts) {
        if (Objections wrong = compare(name, line.integer(name), found)) {
            return wrong;
        }
    }
    if (line.has("touching") != (place.first != nullptr)) {
        return Objection{true, "the column 'touching' belongs to runs that settle ties at first order"};
    }
    if (line.has("touching")) { // a run with more digits may tell from 0 what cannot be told here
        const auto found = static_cast<int>(place.touching.size());
        if (Objections other = compare("touching", line.integer("touching"), found)) {
            other->wrong = line.integer("touching") > found;
            return other;
        }
    }
    return {};
}

/// W, and in `size` the scale of its rounding.
Range potential_of(const Place& place, double& size) {
    const Evidence& e = *place.evidence;
    Range potential(Rational(0));
    size = 0;
    for (const auto& [dof, force] : e.finite_load.acting()) {
        const auto k = static_cast<std::size_t>(e.problem.coordinate_of[dof]);
        potential = potential - force * place.coordinate(k);
        size += std::abs(force.lower.get_d() * place.coordinate(k).lower.get_d());
    }
    return potential;
}

/// Stresses, strains, lengths, potential and solid fraction.
Objections check_measures(const Place& place, const EquilibriumLine& line) {
    const Load& load = place.state->load;
    const double sigma = load.loaded_stress();
    const double across = load.other_stress();
    double box = 0;
    for (int a = 0; a < load.dimension; ++a) {
        box = std::max(box, place.state->packing.length(a));
    }
    std::vector<std::tuple<std::string, Range, double>> without_bound{
        {line.names->stress, Range(Rational(sigma)), std::abs(sigma)},
        {"ratio", Range(Rational(sigma)) / Range(Rational(across)), std::abs(sigma / across)}};
    if (load.path) {
        without_bound.emplace_back("p", Range(Rational(load.mean_stress())), std::abs(across));
        without_bound.emplace_back("q", Range(Rational(load.deviator())), std::abs(across));
    }
    for (const auto& [name, found, scale] : without_bound) {
        if (Objections wrong = compare(name, line.at(name), found, scale)) {
            return wrong;
        }
    }
    std::vector<std::tuple<std::string, Range, double>> with_bound;
    const RecordColumns names = record_columns(load, place.state->packing.cell.shears());
    if (names.measures.size() != line.names->measures.size() || names.stress != line.names->stress) {
        return Objection{true, "the columns are those of another dimension, of another load, or of tilts that move or "
                               "do not"};
    }
    for (const auto& [strain, length, axis] : names.measures) {
        with_bound.emplace_back(strain, strain_of(place, static_cast<int>(axis)), 1);
        with_bound.emplace_back(length, place.length(static_cast<int>(axis)), box);
    }
    if (load.kind == LoadKind::nominal) {
        double size = 0;
        const Range potential = potential_of(place, size);
        with_bound.emplace_back("potential", potential, size);
    }
    for (const auto& [name, found, scale] : with_bound) {
        if (Objections wrong = compare(name, line, found, scale)) {
            return wrong;
        }
    }
    if (std::abs(line.at("solid_fraction") - place.state->packing.solid_fraction()) > record_tolerance) {
        return Objection{true, fmt::format("solid_fraction is {}, found {}", line.at("solid_fraction"),
                                           place.state->packing.solid_fraction())};
    }
    return {};
}

} // namespace

Objections check_end(const Place& from, const Place& to, const EventRecord& event, bool rattles) {
    if (Objections wrong = compare_if_bounded(record_columns(to.state->load, to.state->load.loads_tilt()).strain,
                                              {event.strain, event.strain_bound},
                                              strain_of(to, to.state->load.loaded_axis), arc_strain_tolerance)) {
        return wrong;
    }
    const auto settled = [&](const Contact& pair, const Range& first) -> Objections {
        const TieRecord* said = said_of_gap(event, to.named(pair));
        const bool left = to.chooses && (first.has_zero() || (said != nullptr && said->choice == "watched"));
        if (!first.positive() && !left) {
            return touches(to.named(pair), "the end of the arc", first);
        }
        return said != nullptr ? Objections() // without a record a run with more digits may have told the gap from 0
                               : Objection{false, fmt::format("{} touch at the end of the arc as far as is seen, and "
                                                              "the record does not name them",
                                                              to.named(pair))};
    };
    if (Objections wrong = check_no_overlap(to, "the end of the arc", settled)) {
        return wrong;
    }
    if (Objections wrong =
            event.power_turn ? check_power_at_turn(to, event) : check_power_at_contact(to, event, rattles)) {
        return wrong;
    }
    return check_work(from, to, event, rattles);
}

Objections check_start(const Place& place, const State& given) {
    const std::set<Contact> given_list = contact_set(given);
    const std::set<Contact> list = contact_set(*place.state);
    const bool no_other = std::includes(given_list.begin(), given_list.end(), list.begin(), list.end());
    const auto settled = [&](const Contact& pair, const Range& first) {
        const bool watched = no_other && !given_list.contains(pair); // since the start (C1 g)
        const bool left = place.chooses && (first.has_zero() || watched);
        return first.positive() || left ? Objections() : touches(place.named(pair), "the start", first);
    };
    if (!place.first && given_list != list) {
        return Objection{true, "start.json has other contacts than those with which its arcs lead to equilibrium 0"};
    }
    return check_no_overlap(place, "the start", settled);
}

Objections check_equilibrium(const Place& place, const EquilibriumLine& line) {
    if (Objections wrong = check_forces(place)) {
        return wrong;
    }
    // Pairs that touch were checked where the arc ended.
    if (Objections wrong =
            check_no_overlap(place, "an equilibrium", [](const auto&, const auto&) { return Objections(); })) {
        return wrong;
    }
    for (const auto& check : {check_counts, check_measures, check_smallest_gap, check_smallest_force}) {
        if (Objections wrong = check(place, line)) {
            return wrong;
        }
    }
    for (const bool high : {false, true}) {
        if (Objections wrong = check_interval(place, line, high)) {
            return wrong;
        }
    }
    return {};
}

namespace {

/// Compares the first-order terms of one list of a stored state with those found, by name.
Objections check_terms(const Place& place, const char* what, const std::vector<std::pair<Contact, Enclosure>>& said,
                       const std::vector<Gap>& found) {
    if (said.size() != found.size()) {
        return Objection{true, fmt::format("{} of {} {}, found {}", said.size(), what, "in the state", found.size())};
    }
    for (const auto& [contact, term] : said) {
        const auto at = std::find_if(found.begin(), found.end(),
                                     [&contact = contact](const Gap& one) { return one.pair == contact; });
        const std::string name = fmt::format("the first-order {} of {}", what, place.named(contact));
        if (at == found.end()) {
            return Objection{true, name + ": there is no such one"};
        }
        if (Objections wrong = check_said(name, {term.value, term.radius}, at->value)) {
            return wrong;
        }
    }
    return {};
}

/// Checks a stored state whose radii have a direction. Its exact load is that where `load_zero` vanishes, if any.
Objections check_direction(const Place& place, const RadiusPerturbation& said) {
    std::vector<Gap> zero;
    bool moves = false; // a force that vanishes at the exact load, and not at others
    for (const int l : place.ties) {
        const auto index = static_cast<std::size_t>(l);
        zero.push_back({place.state->contacts[index], place.first_force[index]});
        moves = moves || !place.evidence->slopes()[index].has_zero();
    }
    if (Objections wrong = check_terms(place, "gap", said.open, place.touching)) {
        return wrong;
    }
    if (Objections wrong = check_terms(place, "force", said.zero, zero)) {
        return wrong;
    }
    const bool at_limit = moves && (place.load.shift.lower != 0 || place.load.shift.upper != 0);
    const auto named =
        std::find_if(zero.begin(), zero.end(), [&](const Gap& one) { return one.pair == said.load_zero; });
    if ((said.load_zero.i >= 0) != at_limit || (at_limit && named == zero.end())) {
        return Objection{true, fmt::format("load_zero is {}: {} vanishes at the exact load",
                                           said.load_zero.i < 0 ? "missing" : place.named(said.load_zero),
                                           at_limit ? "another force" : "no force")};
    }
    return at_limit ? check_said("stress_rate", {said.stress_rate.value, said.stress_rate.radius}, place.load.rate)
                    : Objections();
}

/// Compares the doubles of a stored state with the vertex that was reached. Where these are farther from it than
/// doubles of a well conditioned packing, but its contacts are as closed as doubles allow, or it is the given start of
/// the run, the vertex near the stored state decides.
Objections check_coordinates(const Place& place, const State& stored, bool given) {
    const double size = stored.packing.max_radius();
    Objections wrong;
    for (std::size_t k = 0; k < stored.packing.q.size() && !wrong; ++k) {
        wrong = compare("a coordinate of the stored state", stored.packing.q[k], place.coordinate(k), size);
    }
    const System system(stored.packing, stored.contacts);
    const auto closed = [&](const Contact& contact) {
        constexpr double rounding = 0x1p-40; // choice: gaps of a stored state that is as closed as doubles allow
        return given || contact.kind == ContactKind::held ||
               std::abs(system.value(stored.packing.q, contact)) <= rounding * size;
    };
    if (!wrong || !wrong->wrong || !std::all_of(stored.contacts.begin(), stored.contacts.end(), closed)) {
        return wrong;
    }
    Place own;
    (void)make_place(stored, own, place.load);
    if (!own.evidence || !own.evidence->vertex.found) {
        return Objection{false, wrong->text};
    }
    for (std::size_t k = 0; k < stored.packing.q.size(); ++k) {
        const Range a = own.coordinate(k);
        const Range b = place.coordinate(k);
        if (a.upper < b.lower || b.upper < a.lower) {
            return wrong;
        }
    }
    return {};
}

} // namespace

Objections check_stored(const Place& place, const State& stored, const std::optional<State>& start) {
    if (contact_set(stored) != contact_set(*place.state)) {
        return Objection{true, "the stored state has other contacts"};
    }
    State same = stored; // but what is checked apart
    same.packing.q = place.state->packing.q;
    same.contacts = place.state->contacts;
    if (const auto& here = place.state->perturbation; here && same.perturbation) {
        same.perturbation->load_zero = here->load_zero;
        same.perturbation->stress_rate = here->stress_rate;
    }
    if (const std::string other = state_difference(same, *place.state); !other.empty()) {
        return Objection{true, other + " of the stored state is not that of the run"};
    }
    if (stored.perturbation) {
        if (Objections wrong = check_direction(place, *stored.perturbation)) {
            return wrong;
        }
    }
    return check_coordinates(place, stored, start && stored.packing.q == start->packing.q);
}

bool is_left(const Place& place, std::size_t l) {
    const auto& radii = place.state->perturbation;
    const Contact& contact = place.state->contacts[l];
    return recorded_choice(place.said, "force", place.evidence->name(l), "") != nullptr ||
           (radii && std::any_of(radii->zero.begin(), radii->zero.end(),
                                 [&contact](const auto& zero) { return zero.first == contact; }));
}

Objections check_stored_forces(const Place& place, const std::vector<double>& forces) {
    const Evidence& e = *place.evidence;
    if (!forces.empty() && forces.size() != e.forces.size()) {
        return Objection{true, fmt::format("{} forces for {} contacts", forces.size(), e.forces.size())};
    }
    const double size = 100 * largest_force(e.forces); // choice: tolerance of stored forces (checker.md)
    for (std::size_t l = 0; l < forces.size(); ++l) {
        if (Objections wrong = compare("the stored force of " + e.name(l), forces[l], e.forces[l], size)) {
            return wrong;
        }
    }
    return {};
}

} // namespace isostat::checker
