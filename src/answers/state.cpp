#include "answers/state.hpp"

#include "certificate/averages.hpp"
#include "core/decimal.hpp"
#include "io/text.hpp"
#include "packing/bodies.hpp"
#include "packing/words.hpp"

#include <isostat/rigidity/counting.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace isostat::answers {

using json::Json;
using json::or_null;
using text::say;

namespace {

std::span<const double> lengths_of(const State& state) {
    return std::span(state.packing.q).subspan(state.packing.length_at(0), state.packing.axes());
}

std::span<const double> stresses_of(const State& state) {
    return std::span(state.load.stress).first(state.packing.axes());
}

/// The rates of the axes, and of the tilts where these move.
std::span<const double> of_path(const State& state, const StressRates& all) {
    const Packing& packing = state.packing;
    return std::span(all).first(packing.axes() + (packing.cell.shears() ? packing.tilts() : 0));
}

Json numbers(std::span<const double> values) {
    return json::array_of(values, or_null);
}

std::string bodies_text(int count) {
    return fmt::format(" in {} {}", count, count == 1 ? "body" : "bodies");
}

void print_counting(std::string& out, const State& state, const Counting& c) {
    say(out, "{:<25}{}{}\n", fmt::format("{}s", grain_word(state.packing.dimension)), state.packing.disk_count(),
        state.packing.bars.empty() ? "" : bodies_text(Bodies(state.packing).count()));
    const bool periodic = state.packing.cell.any();
    say(out, "{:<25}{}, solid fraction {:.6f}\n", periodic ? "cell" : "box",
        periodic ? cell_words(state.packing) : fmt::format("{}", fmt::join(lengths_of(state), " x ")),
        state.packing.solid_fraction());
    const auto shears = std::span(state.load.shear).first(state.packing.tilts());
    const bool sheared = std::ranges::any_of(shears, [](double shear) { return shear != 0; });
    say(out, "load                     sigma = ({}){}, {}\n", fmt::format("{}", fmt::join(stresses_of(state), ", ")),
        sheared ? fmt::format(", shear {}", fmt::join(shears, ", ")) : "",
        state.load.kind != LoadKind::nominal ? "true stresses"
        : state.packing.cell.keeps_shape ? fmt::format("along {}; on the size of the cell, it scales all forces alike",
                                                       axis_names[state.packing.axes() - 1])
        : periodic                       ? "nominal (constant forces on the periods)"
                                         : "nominal (constant wall forces)");
    if (state.load.path) {
        const auto list = [&](const StressRates& all) {
            return fmt::format("{}", fmt::join(of_path(state, all), ", "));
        };
        say(out, "loaded                   t = {}: sigma = ({}) + t ({})\n", state.load.path->t,
            list(state.load.path->at), list(state.load.path->rate));
    }
    say(out, "degrees of freedom N_f   {}\n", c.dof_count);
    say(out, "contacts N               {}\n", c.contact_count);
    say(out, "rank, stored coordinates {} ({})\n", c.rank,
        c.rank_exact == Verdict::proved ? "exact" : "proved lower bound");
    say(out, "self-stresses h          {}\n", c.hyperstaticity);
    say(out, "mechanisms k             {}\n", c.mechanisms);
}

/// Contains the smallest finite force that is no structural zero.
Interval smallest_force(const Inspection& inspection) {
    Interval smallest{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (std::size_t l = 0; l < inspection.structural_zero.size(); ++l) {
        if (inspection.structural_zero[l] == 0 && inspection.contacts[l].is_unilateral()) {
            smallest.lower = std::min(smallest.lower, inspection.truth.finite[l].lower);
            smallest.upper = std::min(smallest.upper, inspection.truth.finite[l].upper);
        }
    }
    return smallest;
}

void print_forces(std::string& out, const Inspection& inspection, int dimension) {
    const EquilibriumRecord& r = inspection.record;
    const CertificateClaims& claims = inspection.truth.claims;
    if (claims.load_interval) {
        say(out, "supported interval       from {}\n", end_text(claims.load_interval->low, dimension));
        say(out, "                         to   {}\n", end_text(claims.load_interval->high, dimension));
    } else {
        say(out, "supported interval       undecided\n");
    }
    if (r.backbone > 0) {
        const Interval smallest = smallest_force(inspection);
        say(out, "smallest force           {} in {} (every force known to {})\n",
            with_bound(smallest.lower, smallest.upper), to_string(r.min_force_contact, dimension),
            rounded_up(r.force_bound, 2));
    }
}

/// Number of contacts with a force, without the held coordinates of the list.
int carrying_count(const Inspection& inspection) {
    int held = 0;
    for (std::size_t l = 0; l < inspection.structural_zero.size(); ++l) {
        held += inspection.contacts[l].kind == ContactKind::held && inspection.structural_zero[l] == 0 ? 1 : 0;
    }
    return inspection.record.backbone - held;
}

/// Counts rattling bodies by their first members.
int rattling_bodies(const Packing& packing, const std::vector<int>& rattlers) {
    const Bodies bodies(packing);
    return static_cast<int>(std::ranges::count_if(rattlers, [&](int i) { return bodies.of(i) == i; }));
}

void print_yielding(std::string& out, const Inspection& inspection, const Load& load) {
    if (!inspection.yielding) {
        return;
    }
    const Yielding& y = *inspection.yielding;
    std::string rates;
    for (std::size_t a = 0; a < static_cast<std::size_t>(inspection.truth.dimension); ++a) {
        const Enclosure& rate = y.length_rate[a];
        rates += fmt::format("{}L{} by {}", a == 0 ? "" : ", ", axis_names[a],
                             with_bound(rate.value - rate.radius, rate.value + rate.radius));
    }
    std::string values;
    for (const Enclosure& value : y.second_variation) {
        values += (values.empty() ? "" : ", ") + with_bound(value.value - value.radius, value.value + value.radius);
    }
    if (!values.empty()) {
        say(out, "W'' in (X, Y, angle)     {}\n", values);
    }
    say(out, "yields                   {} per unit of {}\n", rates, load.stress_name());
    for (const auto& [where, event] : {std::pair{"rising", &y.up}, {"falling", &y.down}}) {
        if (event->contact.i >= 0 || event->flattens) {
            const std::string what = event->flattens ? "W'' vanishes along a mechanism"
                                                     : to_string(event->contact, inspection.truth.dimension) +
                                                           (event->opens ? " opens" : " closes");
            say(out, "  under {:<7}          at these rates {} first, near {:.6g} (not proved)\n", where, what,
                event->stress);
        }
    }
}

void print_inspection(std::string& out, const State& state, const Inspection& inspection) {
    const EquilibriumRecord& r = inspection.record;
    if (state.packing.bars.empty()) {
        const std::vector<int> few = rattlers_by_coordination(state.packing, state.contacts);
        say(out,
            "rattlers                 {} by forces, {} by coordination (at most {} contacts, counted until none is "
            "left)\n",
            inspection.rattlers.size(), few.size(), state.packing.dimension);
    } else {
        say(out,
            "rattlers                 {} bodies without force, {} more that turn about their one member with "
            "contacts\n",
            rattling_bodies(state.packing, inspection.rattlers), inspection.rotational_rattlers.size());
    }
    say(out, "solid fraction           {:.6f} without the rattlers by forces\n",
        state.packing.solid_fraction_without(inspection.rattlers));
    say(out, "force-carrying contacts  {}\n", carrying_count(inspection));
    if (inspection.equilibrium) {
        print_forces(out, inspection, inspection.truth.dimension);
    }
    if (inspection.truth.claims.gaps) {
        say(out, "smallest gap             {}\n",
            !std::isfinite(r.min_gap)
                ? "there is no other pair"
                : fmt::format("at least {} ({})", rounded_down(r.min_gap, 6),
                              r.min_gap_contact.i < 0
                                  ? "no other pair is near"
                                  : "nearest: " + to_string(r.min_gap_contact, inspection.truth.dimension)));
    }
    if (inspection.truth.claims.vertex) {
        say(out, "largest gap of a contact at most {}\n", rounded_up(r.gap_residual, 2));
        say(out, "smallest singular value  at least {}\n", rounded_down(r.sigma_min_bound, 3));
        say(out, "decided by               {}\n", to_string(r.decided_by));
    }
    say(out, "isostatic equilibrium    {}{}{}\n", to_string(r.verdict), inspection.remark.empty() ? "" : ": ",
        inspection.remark);
    say(out, "stable                   {}\n", to_string(inspection.stable));
    print_yielding(out, inspection, state.load);
}

Json counting_json(const std::string& file, const State& state, const Counting& c) {
    Json object;
    object["file"] = file;
    object[fmt::format("{}s", grain_word(state.packing.dimension))] = state.packing.disk_count();
    if (!state.packing.bars.empty()) {
        object["bodies"] = Bodies(state.packing).count();
    }
    object["length"] = numbers(lengths_of(state));
    object["solid_fraction"] = or_null(state.packing.solid_fraction());
    object["stress"] = numbers(stresses_of(state));
    object["load"] = word_of(state.load.kind, load_kind_words);
    if (const auto& path = state.load.path) {
        object["path"] = {{"t", or_null(path->t)},
                          {"stress", numbers(of_path(state, path->at))},
                          {"direction", numbers(of_path(state, path->rate))}};
    }
    object.update(json::counts(c));
    return object;
}

void add_yielding(Json& object, const Yielding& y, int dimension) {
    const auto event = [dimension](const Yielding::Event& e) {
        if (e.flattens) {
            return Json{{"contact", nullptr}, {"what", "flattens"}, {"stress", or_null(e.stress)}};
        }
        return e.contact.i < 0 ? Json()
                               : Json{{"contact", to_string(e.contact, dimension)},
                                      {"what", e.opens ? "opens" : "closes"},
                                      {"stress", or_null(e.stress)}};
    };
    const auto pairs = [](std::span<const Enclosure> values) {
        return json::array_of(values, [](const Enclosure& e) { return Json{or_null(e.value), or_null(e.radius)}; });
    };
    const Json rates = pairs(std::span(y.length_rate).first(static_cast<std::size_t>(dimension)));
    object["second_variation"] = pairs(y.second_variation);
    object["yielding"] = {{"length_rates", rates}, {"up", event(y.up)}, {"down", event(y.down)}};
}

void add_inspection(Json& object, const State& state, const Inspection& inspection) {
    const EquilibriumRecord& r = inspection.record;
    object["rattlers"] = inspection.rattlers;
    if (state.packing.bars.empty()) {
        object["rattlers_by_coordination"] = rattlers_by_coordination(state.packing, state.contacts);
    } else {
        object["rotational_rattlers"] = inspection.rotational_rattlers;
    }
    object["solid_fraction_without_rattlers"] = or_null(state.packing.solid_fraction_without(inspection.rattlers));
    object["backbone"] = carrying_count(inspection);
    object["held"] = r.held;
    if (inspection.equilibrium) {
        const auto& interval = inspection.truth.claims.load_interval;
        Json opens = Json::array();
        object["interval_decided"] = interval.has_value();
        object["supported_interval"] = {or_null(r.stress_low), or_null(r.stress_high)}; // midpoints of the ends below
        for (const auto& [key, end] :
             {std::pair{"interval_low", &LoadIntervalClaim::low}, {"interval_high", &LoadIntervalClaim::high}}) {
            const LoadEndClaim* const known = interval && !((*interval).*end).unbounded ? &((*interval).*end) : nullptr;
            object[key] = known != nullptr ? Json::array({or_null(known->stress.lower), or_null(known->stress.upper)})
                                           : Json::array({nullptr, nullptr});
            opens.push_back(known != nullptr ? Json(to_string(known->opens, inspection.truth.dimension)) : Json());
        }
        object["opens"] = std::move(opens);
        const Interval smallest = smallest_force(inspection);
        object["min_force"] = or_null(r.min_force);
        object["min_force_between"] = {or_null(smallest.lower), or_null(smallest.upper)};
        object["min_force_contact"] = to_string(r.min_force_contact, inspection.truth.dimension);
        object["force_bound"] = or_null(r.force_bound);
        object["margin"] = or_null(r.margin);
    }
    if (inspection.truth.claims.vertex) {
        object["decided_by"] = to_string(r.decided_by);
        object["gap_residual"] = or_null(r.gap_residual);
        object["sigma_min_bound"] = or_null(r.sigma_min_bound);
    }
    object["min_gap"] = inspection.truth.claims.gaps ? or_null(r.min_gap) : Json();
    object["min_gap_contact"] = inspection.truth.claims.gaps && std::isfinite(r.min_gap) && r.min_gap_contact.i >= 0
                                    ? Json(to_string(r.min_gap_contact, inspection.truth.dimension))
                                    : Json();
    object["verdict"] = to_string(r.verdict);
    object["stable"] = to_string(inspection.stable);
    object["remark"] = inspection.remark;
    if (inspection.yielding) {
        add_yielding(object, *inspection.yielding, inspection.truth.dimension);
    }
}

Json tensor_json(const ForceAverages::Tensor& tensor, std::size_t axes) {
    Json out = Json::array();
    for (std::size_t a = 0; a < axes; ++a) {
        out.push_back(numbers(std::span(tensor[a]).first(axes)));
    }
    return out;
}

std::string tensor_text(const ForceAverages::Tensor& tensor, std::size_t axes) {
    std::string text;
    for (std::size_t a = 0; a < axes; ++a) {
        for (std::size_t b = 0; b < axes; ++b) {
            text += fmt::format("{}{:.6g}", b > 0 ? " " : a > 0 ? "; " : "", tensor[a][b]);
        }
    }
    return text;
}

/// Whether the finite forces are known.
bool has_forces(const State& state, const Certification& truth) {
    return !state.contacts.empty() && truth.finite.size() == state.contacts.size();
}

void print_averages(std::string& out, const State& state, const Certification& truth, const Coordination& z) {
    const ForceAverages mean = force_averages(state, truth);
    const std::size_t axes = state.packing.axes();
    say(out, "coordination number      {:.6g}, {:.6g} of the force-carrying contacts without rattlers\n", z.all,
        z.carrying);
    say(out, "stress of the contacts   {} (sum of f n n l over the volume), pressure {:.6g}\n",
        tensor_text(mean.stress, axes), mean.pressure);
    say(out, "fabric                   {} (mean of n n over force-carrying pairs)\n", tensor_text(mean.fabric, axes));
}

void add_averages(Json& object, const State& state, const Certification& truth, const Coordination& z) {
    const ForceAverages mean = force_averages(state, truth);
    const std::size_t axes = state.packing.axes();
    object["coordination"] = or_null(z.all);
    object["coordination_without_rattlers"] = or_null(z.carrying);
    object["contact_stress"] = tensor_json(mean.stress, axes);
    object["pressure"] = or_null(mean.pressure);
    object["fabric"] = tensor_json(mean.fabric, axes);
    object["mean_force"] = or_null(mean.mean_force);
    object["force_distribution"] = json::array_of(force_distribution(state, truth), [](const auto& at) {
        return Json{or_null(at.first), or_null(at.second)};
    });
}

/// The smallest singular values of a structure that is proved regular.
std::vector<double> singular_values_of(std::optional<int> wanted, const State& state) {
    constexpr int of_spheres = 10;
    const int count = wanted.value_or(state.packing.dimension == plane ? 0 : of_spheres);
    if (count == 0) {
        return {};
    }
    const auto structure = IsostaticStructure::prove(state.packing, state.contacts);
    return structure.ok() ? smallest_singular_values(structure.value(), count) : std::vector<double>();
}

/// Prints each force.
void print_forces_at(std::string& out, const State& state, const Certification& truth) {
    for (std::size_t l = 0; l < truth.finite.size(); ++l) {
        say(out, "force {:<18} {}\n", to_string(state.contacts[l], state.packing.dimension),
            with_bound(truth.finite[l].lower, truth.finite[l].upper));
    }
}

Json forces_json(const State& state, const Certification& truth) {
    Json out = Json::array();
    for (std::size_t l = 0; l < truth.finite.size(); ++l) {
        out.push_back({to_string(state.contacts[l], state.packing.dimension), or_null(truth.finite[l].lower),
                       or_null(truth.finite[l].upper)});
    }
    return out;
}

/// Empty when the forces or the rattlers are not known.
std::optional<Coordination> coordination_of(const StateAnswer& answer) {
    const State& state = answer.file.state;
    return answer.result.ok() && has_forces(state, answer.truth)
               ? std::optional(
                     coordination(state, answer.truth, rattling_bodies(state.packing, answer.result.value().rattlers)))
               : std::nullopt;
}

} // namespace

std::string to_text(const StateAnswer& answer, bool each_force) {
    std::string out;
    const State& state = answer.file.state;
    print_counting(out, state, answer.truth.counting);
    if (const std::string copy = compare::words_of_copy(state); !copy.empty()) {
        say(out, "copy                     {}\n", copy);
    }
    if (answer.result.ok()) {
        print_inspection(out, state, answer.result.value());
    } else {
        say(out, "isostatic equilibrium    {}: {}\n", answer.refuted() ? "refuted" : "undecided",
            answer.result.failure().message(state.packing.dimension));
    }
    print_true_vertex(out, answer.truth);
    if (const auto z = coordination_of(answer)) {
        print_averages(out, state, answer.truth, *z);
    }
    if (!answer.singular_values.empty()) {
        say(out, "smallest singular values {} (of the stored coordinates, computed)\n",
            fmt::format("{:.4g}", fmt::join(answer.singular_values, ", ")));
    }
    if (answer.cell) {
        print_cell(out, *answer.cell);
    }
    if (answer.box) {
        print_box(out, state.packing, *answer.box);
    }
    print_face(out, state);
    print_forces_in_file(out, answer.file, answer.truth);
    if (each_force) {
        print_forces_at(out, state, answer.truth);
    }
    return out;
}

Json to_json(const StateAnswer& answer, const std::string& file) {
    const State& state = answer.file.state;
    Json object = counting_json(file, state, answer.truth.counting);
    if (answer.result.ok()) {
        add_inspection(object, state, answer.result.value());
    } else {
        object["verdict"] = answer.refuted() ? "refuted" : "undecided";
        object["remark"] = answer.result.failure().message(state.packing.dimension);
    }
    if (const auto z = coordination_of(answer)) {
        add_averages(object, state, answer.truth, *z);
    }
    add_untold(object, answer.untold, answer.truth.verdict);
    if (const std::string copy = compare::words_of_copy(state); !copy.empty()) {
        object["copy"] = copy;
    }
    object["true_configuration"] = true_vertex_json(answer.truth);
    object["forces"] = forces_json(state, answer.truth);
    object["singular_values"] = numbers(answer.singular_values);
    if (answer.cell) {
        object["cell"] = cell_json(state.packing, *answer.cell);
    }
    if (answer.box) {
        object["box"] = box_json(*answer.box);
    }
    add_face(object, state);
    add_forces_in_file(object, answer.file, answer.truth);
    return object;
}

StateAnswer answer_of(const StateFile& file, std::optional<int> singular_values) {
    const State& state = file.state;
    Result<Inspection> result = inspect_vertex(state);
    Certification truth = result.ok() ? result.value().truth : certify(state);
    const bool clumps = !state.packing.bars.empty(); // strains of cells with clumps are not counted
    auto cell = state.packing.cell.all() && !clumps ? std::optional(inspect_cell(state, truth)) : std::nullopt;
    compare::Untold untold = compare::untold_by(compare::imported_rounding(state), state, truth);
    if (result.ok()) {
        withhold(untold, result.value());
    }
    if (cell) {
        withhold(untold, *cell);
        if (untold.any()) { // adds the result with the undecided gaps closed
            std::vector<Contact> closed = state.contacts;
            closed.insert(closed.end(), untold.gaps.begin(), untold.gaps.end());
            add_if_closed(state.packing, closed, *cell);
        }
    }
    auto box = inspect_box(state, truth);
    if (box) {
        withhold(untold, box->collective);
    }
    return {file,
            std::move(result),
            std::move(truth),
            std::move(cell),
            std::move(box),
            std::move(untold),
            singular_values_of(singular_values, state)};
}

} // namespace isostat::answers
