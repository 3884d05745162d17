#include "answers/state.hpp"

#include "certificate/averages.hpp"
#include "core/decimal.hpp"
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

/// What a state holds, and the counts of its stored coordinates.
void add_counting(Answer& out, const State& state, const Counting& c) {
    const Packing& packing = state.packing;
    const std::string grains = fmt::format("{}s", grain_word(packing.dimension));
    std::string bodies;
    if (!packing.bars.empty()) {
        const int count = Bodies(packing).count();
        out.item("bodies", count);
        bodies = fmt::format(" in {} {}", count, count == 1 ? "body" : "bodies");
    }
    out.item(grains, packing.disk_count(), grains, "{}{}", packing.disk_count(), bodies);
    const bool periodic = packing.cell.any();
    out.item("length", numbers(lengths_of(state)));
    out.item("solid_fraction", or_null(packing.solid_fraction()), periodic ? "cell" : "box",
             "{}, solid fraction {:.6f}",
             periodic ? cell_words(packing) : fmt::format("{}", fmt::join(lengths_of(state), " x ")),
             packing.solid_fraction());
    const auto shears = std::span(state.load.shear).first(packing.tilts());
    const bool sheared = std::ranges::any_of(shears, [](double shear) { return shear != 0; });
    out.item("stress", numbers(stresses_of(state)));
    if (sheared) {
        out.item("shear", numbers(shears));
    }
    out.item("load", word_of(state.load.kind, load_kind_words), "load", "sigma = ({}){}, {}",
             fmt::format("{}", fmt::join(stresses_of(state), ", ")),
             sheared ? fmt::format(", shear {}", fmt::join(shears, ", ")) : "",
             state.load.kind != LoadKind::nominal ? "true stresses"
             : packing.cell.keeps_shape ? fmt::format("along {}; on the size of the cell, it scales all forces alike",
                                                      axis_names[packing.axes() - 1])
             : periodic                 ? "nominal (constant forces on the periods)"
                                        : "nominal (constant wall forces)");
    if (const auto& path = state.load.path) {
        const auto at = of_path(state, path->at), rate = of_path(state, path->rate);
        out.item("path", {{"t", or_null(path->t)}, {"stress", numbers(at)}, {"direction", numbers(rate)}}, "loaded",
                 "t = {}: sigma = ({}) + t ({})", path->t, fmt::format("{}", fmt::join(at, ", ")),
                 fmt::format("{}", fmt::join(rate, ", ")));
    }
    out.same("N_f", "degrees of freedom N_f", c.dof_count);
    out.same("N", "contacts N", c.contact_count);
    out.item("rank", c.rank, "rank, stored coordinates", "{} ({})", c.rank,
             c.rank_exact == Verdict::proved ? "exact" : "proved lower bound");
    out.item("rank_exact", to_string(c.rank_exact));
    out.same("h", "self-stresses h", c.hyperstaticity);
    out.same("k", "mechanisms k", c.mechanisms);
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

/// The interval of the load, and the smallest force.
void add_forces(Answer& out, const Inspection& inspection) {
    const int dimension = inspection.truth.dimension;
    const EquilibriumRecord& r = inspection.record;
    const auto& interval = inspection.truth.claims.load_interval;
    out.item("interval_decided", interval.has_value());
    out.item("supported_interval", {or_null(r.stress_low), or_null(r.stress_high)}); // midpoints of the ends below
    out.item("opens", Json::array());
    for (const bool low : {true, false}) {
        const LoadEndClaim* const end = interval ? &(low ? interval->low : interval->high) : nullptr;
        const bool bounded = end != nullptr && !end->unbounded;
        out.item(low ? "interval_low" : "interval_high",
                 bounded ? Json::array({or_null(end->stress.lower), or_null(end->stress.upper)})
                         : Json::array({nullptr, nullptr}));
        out.json["opens"].push_back(bounded ? Json(to_string(end->opens, dimension)) : Json());
        if (end != nullptr) {
            out.line(low ? "supported interval" : "", "{} {}", low ? "from" : "to  ", end_text(*end, dimension));
        }
    }
    if (!interval) {
        out.line("supported interval", "undecided");
    }
    const Interval smallest = smallest_force(inspection);
    const std::string where = to_string(r.min_force_contact, dimension);
    if (r.backbone > 0) {
        out.line("smallest force", "{} in {} (every force known to {})", with_bound(smallest.lower, smallest.upper),
                 where, rounded_up(r.force_bound, 2));
    }
    out.item("min_force", or_null(r.min_force));
    out.item("min_force_between", {or_null(smallest.lower), or_null(smallest.upper)});
    out.item("min_force_contact", where);
    out.item("force_bound", or_null(r.force_bound));
    out.item("margin", or_null(r.margin));
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

/// An interval as the pair of its midpoint and radius, and as text with a bound.
Json pair_of(const Enclosure& e) {
    return {or_null(e.value), or_null(e.radius)};
}
std::string text_of(const Enclosure& e) {
    return with_bound(e.value - e.radius, e.value + e.radius);
}

void add_yielding(Answer& out, const Yielding& y, const Load& load, int dimension) {
    const std::span<const Enclosure> rates = std::span(y.length_rate).first(static_cast<std::size_t>(dimension));
    std::string rates_text, values;
    for (std::size_t a = 0; a < rates.size(); ++a) {
        rates_text += fmt::format("{}L{} by {}", a == 0 ? "" : ", ", axis_names[a], text_of(rates[a]));
    }
    for (const Enclosure& value : y.second_variation) {
        values += (values.empty() ? "" : ", ") + text_of(value);
    }
    out.item("second_variation", json::array_of(y.second_variation, pair_of));
    if (!values.empty()) {
        out.line("W'' in (X, Y, angle)", "{}", values);
    }
    Answer yielding;
    yielding.item("length_rates", json::array_of(rates, pair_of), "yields", "{} per unit of {}", rates_text,
                  load.stress_name());
    for (const auto& [key, where, event] : {std::tuple{"up", "rising", &y.up}, {"down", "falling", &y.down}}) {
        yielding.item(key, nullptr);
        if (event->contact.i >= 0 || event->flattens) {
            const std::string contact = event->flattens ? "" : to_string(event->contact, dimension);
            const char* const what = event->flattens ? "flattens" : event->opens ? "opens" : "closes";
            yielding.item(key,
                          {{"contact", event->flattens ? Json() : Json(contact)},
                           {"what", what},
                           {"stress", or_null(event->stress)}},
                          fmt::format("  under {}", where), "at these rates {} first, near {:.6g} (not proved)",
                          event->flattens ? "W'' vanishes along a mechanism" : contact + " " + what, event->stress);
        }
    }
    out.part("yielding", std::move(yielding));
}

void add_rattlers(Answer& out, const State& state, const Inspection& inspection) {
    out.item("rattlers", inspection.rattlers);
    if (state.packing.bars.empty()) {
        const std::vector<int> few = rattlers_by_coordination(state.packing, state.contacts);
        out.item("rattlers_by_coordination", few, "rattlers",
                 "{} by forces, {} by coordination (at most {} contacts, counted until none is left)",
                 inspection.rattlers.size(), few.size(), state.packing.dimension);
    } else {
        out.item("rotational_rattlers", inspection.rotational_rattlers, "rattlers",
                 "{} bodies without force, {} more that turn about their one member with contacts",
                 rattling_bodies(state.packing, inspection.rattlers), inspection.rotational_rattlers.size());
    }
    const double without = state.packing.solid_fraction_without(inspection.rattlers);
    out.item("solid_fraction_without_rattlers", or_null(without), "solid fraction",
             "{:.6f} without the rattlers by forces", without);
}

void add_inspection(Answer& out, const State& state, const Inspection& inspection) {
    const EquilibriumRecord& r = inspection.record;
    const CertificateClaims& claims = inspection.truth.claims;
    add_rattlers(out, state, inspection);
    out.same("backbone", "force-carrying contacts", carrying_count(inspection));
    out.item("held", r.held);
    if (inspection.equilibrium) {
        add_forces(out, inspection);
    }
    out.item("min_gap", nullptr);
    out.item("min_gap_contact", nullptr);
    if (claims.gaps && !std::isfinite(r.min_gap)) {
        out.line("smallest gap", "there is no other pair");
    } else if (claims.gaps) {
        const std::string nearest =
            r.min_gap_contact.i < 0 ? "" : to_string(r.min_gap_contact, inspection.truth.dimension);
        out.item("min_gap_contact", nearest.empty() ? Json() : Json(nearest));
        out.item("min_gap", r.min_gap, "smallest gap", "at least {} ({})", rounded_down(r.min_gap, 6),
                 nearest.empty() ? "no other pair is near" : "nearest: " + nearest);
    }
    if (claims.vertex) {
        out.item("gap_residual", or_null(r.gap_residual), "largest gap of a contact", "at most {}",
                 rounded_up(r.gap_residual, 2));
        out.item("sigma_min_bound", or_null(r.sigma_min_bound), "smallest singular value", "at least {}",
                 rounded_down(r.sigma_min_bound, 3));
        out.same("decided_by", "decided by", to_string(r.decided_by));
    }
    out.item("remark", inspection.remark);
    out.item("verdict", to_string(r.verdict), "isostatic equilibrium", "{}{}{}", to_string(r.verdict),
             inspection.remark.empty() ? "" : ": ", inspection.remark);
    out.same("stable", "stable", to_string(inspection.stable));
    if (inspection.yielding) {
        add_yielding(out, *inspection.yielding, state.load, inspection.truth.dimension);
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

void add_averages(Answer& out, const State& state, const Certification& truth, const Coordination& z) {
    const ForceAverages mean = force_averages(state, truth);
    const std::size_t axes = state.packing.axes();
    out.item("coordination_without_rattlers", or_null(z.carrying));
    out.item("coordination", or_null(z.all), "coordination number",
             "{:.6g}, {:.6g} of the force-carrying contacts without rattlers", z.all, z.carrying);
    out.item("pressure", or_null(mean.pressure));
    out.item("contact_stress", tensor_json(mean.stress, axes), "stress of the contacts",
             "{} (sum of f n n l over the volume), pressure {:.6g}", tensor_text(mean.stress, axes), mean.pressure);
    out.item("fabric", tensor_json(mean.fabric, axes), "fabric", "{} (mean of n n over force-carrying pairs)",
             tensor_text(mean.fabric, axes));
    out.item("mean_force", or_null(mean.mean_force));
    out.item("force_distribution", json::array_of(force_distribution(state, truth), [](const auto& at) {
                 return Json{or_null(at.first), or_null(at.second)};
             }));
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

/// \p each: the text has every force too.
void add_forces_at(Answer& out, const State& state, const Certification& truth, bool each) {
    Json forces = Json::array();
    for (std::size_t l = 0; l < truth.finite.size() && (each || out.lists); ++l) {
        const auto& [lower, upper] = truth.finite[l];
        const std::string name = to_string(state.contacts[l], state.packing.dimension);
        forces.push_back({name, or_null(lower), or_null(upper)});
        if (each) {
            out.line(fmt::format("force {:<18}", name), "{}", with_bound(lower, upper));
        }
    }
    out.item("forces", std::move(forces));
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

Answer to_answer(const StateAnswer& answer, const std::string& file, bool each_force, bool lists) {
    Answer out{.lists = lists};
    const State& state = answer.file.state;
    out.item("file", file);
    add_counting(out, state, answer.truth.counting);
    if (const std::string copy = compare::words_of_copy(state); !copy.empty()) {
        out.same("copy", "copy", copy);
    }
    if (answer.result.ok()) {
        add_inspection(out, state, answer.result.value());
    } else {
        const std::string remark = answer.result.failure().message(state.packing.dimension);
        const char* const verdict = answer.refuted() ? "refuted" : "undecided";
        out.item("remark", remark);
        out.item("verdict", verdict, "isostatic equilibrium", "{}: {}", verdict, remark);
    }
    add_true_vertex(out, answer.truth);
    if (const auto z = coordination_of(answer)) {
        add_averages(out, state, answer.truth, *z);
    }
    add_untold(out, answer.untold, answer.truth.verdict);
    out.item("singular_values", numbers(answer.singular_values));
    if (!answer.singular_values.empty()) {
        out.line("smallest singular values", "{} (of the stored coordinates, computed)",
                 fmt::format("{:.4g}", fmt::join(answer.singular_values, ", ")));
    }
    if (state.packing.cell.any()) {
        add_cell(out, state.packing, answer.cell ? &*answer.cell : nullptr);
    }
    if (answer.box) {
        add_box(out, state.packing, *answer.box);
    }
    add_face(out, state);
    add_forces_in_file(out, answer.file, answer.truth);
    add_forces_at(out, state, answer.truth, each_force);
    return out;
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
