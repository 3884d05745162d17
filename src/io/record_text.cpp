#include "io/record_text.hpp"

#include "io/state_json.hpp"
#include "packing/words.hpp"

#include <isostat/io/run_directory.hpp>

#include <limits>
#include <optional>
#include <type_traits>

namespace isostat {

RecordColumns record_columns(const Load& load, bool tilts) {
    RecordColumns columns;
    columns.dimension = load.dimension;
    const auto loaded = static_cast<std::size_t>(load.loaded_axis);
    const auto other = static_cast<std::size_t>(load.other_axis());
    const Layout layout{load.dimension, 0};
    const bool by_role = load.dimension == plane;
    columns.of_path = load.path.has_value();
    columns.stress = by_role ? "sigma2" : load.stress_name();
    for (std::size_t k = 0; k < layout.axes() + (tilts ? layout.tilts() : 0); ++k) {
        const std::size_t axis = !by_role ? k : k == 0 ? other : k == 1 ? loaded : 3 - other - loaded;
        const bool numbered = by_role || k < layout.axes();
        const std::string name = numbered ? std::to_string(k + 1) : tilt_names[k - layout.axes()];
        columns.measures.push_back({(numbered ? "eps" : "eps_") + name, (numbered ? "L" : "") + name, axis});
        if (axis == loaded) {
            columns.strain = columns.measures.back().strain;
        } else if (axis == other) {
            columns.other_strain = columns.measures.back().strain;
        }
    }
    return columns;
}

namespace {

using json::Json;

/// "log2_zero": bound of what vanishes in the base, null: exactly; without "bits" no difference was to be found.
Json tie_json(const TieDecision& tie, int dimension) {
    const auto term = [](const Enclosure& e) { return Json::array({json::or_null(e.value), json::or_null(e.radius)}); };
    Json object;
    object["decision"] = tie.what;
    object["contact"] = to_string(tie.chosen, dimension);
    object["first_order"] = term(tie.first);
    if (tie.against.i >= 0) {
        object["against"] = to_string(tie.against, dimension);
        object["against_first_order"] = term(tie.other);
    }
    if (tie.choice != TieChoice::none) {
        object["choice"] = to_string(tie.choice);
    }
    if (tie.what != "step") {
        object["log2_zero"] = json::or_null(tie.exponent);
        object["bits"] = tie.bits;
    }
    return object;
}

Json certificate_json(const ArcCertificate& certificate) {
    const bool proved = certificate.verdict == Verdict::proved;
    Json object;
    object["verdict"] = to_string(certificate.verdict);
    object["pieces"] = certificate.pieces;
    object["centres"] = certificate.factorisations;
    object["moving"] = certificate.moving;
    if (!proved) {
        object["reason"] = certificate.reason;
        return object;
    }
    object["turning"] = certificate.turning;
    object["tube"] = json::or_null(certificate.tube);
    object["tube_margin"] = json::or_null(certificate.tube_margin);
    object["gap_margin"] = json::or_null(certificate.gap_margin);
    object["power"] = to_string(certificate.power);
    object["power_open_start"] = certificate.power_open_start;
    object["power_open_end"] = certificate.power_open_end;
    return object;
}

/// The one list of the fields of an arc, in their order. `use` takes the name and the value: an integer, a number, a
/// word, or what only some arcs have.
template <class Use> void for_each_event_field(const ArcRecord& arc, const RecordColumns& names, const Use& use) {
    use("step", arc.step);
    use("equilibrium", arc.equilibrium);
    use("arc", arc.arc);
    use("kind", to_string(arc.kind));
    use("opened", to_string(arc.opened, names.dimension));
    use("closed", to_string(arc.closed, names.dimension));
    use("power_turn", arc.power_turn);
    use("held_at", arc.power_turn ? std::optional(arc.held_at) : std::nullopt);
    use(names.stress, arc.stress);
    use(names.strain, arc.strain);
    use(names.strain + "_bound", arc.strain_bound);
    use("force", arc.force);
    use("force_bound", arc.force_bound);
    use("power", arc.power);
    use("power_bound", arc.power_bound);
    use("work", arc.work);
    use("work_bound", arc.work_bound);
    use("displacement", arc.displacement);
    use("steps", arc.steps);
    use("margin", arc.margin);
    use("decided_by", to_string(arc.decided_by));
    const auto tie = [&](const TieDecision& decision) { return tie_json(decision, names.dimension); };
    use("perturbed", arc.perturbed.empty() ? std::nullopt : std::optional<Json>(json::array_of(arc.perturbed, tie)));
    use("certificate", arc.certificate ? std::optional<Json>(certificate_json(*arc.certificate)) : std::nullopt);
}

/// Counters by the places of their names in a record: one list for writing and reading. `use` takes the place, then the
/// number.
template <class Counted, class Use> void for_each_counter(Counted& counters, const Use& use) {
    const auto word = [](auto value) { return std::string(to_string(value)); };
    use("/arcs", counters.steps);
    use("/equilibria", counters.equilibria);
    use("/seconds", counters.seconds);
    auto& tally = counters.tally;
    use("/decisions/combinatorial", tally.combinatorial);
    use("/decisions/double", tally.double_bound);
    use("/decisions/double-double", tally.double_double);
    use("/decisions/mpfr", tally.multiprecision);
    use("/decisions/exact", tally.exact);
    use("/decisions/undecided", tally.undecided);
    use("/decisions/smallest_margin", tally.smallest_margin);
    for (std::size_t k = 0; k < decision_kinds; ++k) {
        const std::string kind = "/decisions/kinds/" + word(static_cast<DecisionKind>(k)) + "/";
        for (std::size_t rung = 0; rung < tally.by_kind[k].size(); ++rung) {
            use(kind + word(static_cast<Rung>(rung)), tally.by_kind[k][rung]);
        }
        use(kind + "smallest_margin", tally.smallest_margin_of[k]);
    }
    use("/decisions/ties/structural", tally.structural_ties);
    use("/decisions/ties/other", tally.ties);
    for (std::size_t k = 0; k < decision_kinds; ++k) {
        use("/decisions/ties/perturbed/" + word(static_cast<DecisionKind>(k)), tally.perturbed[k]);
    }
    use("/decisions/ties/choices", tally.choices); // absent: 0
    use("/certified_states/proved", counters.states.proved);
    use("/certified_states/refuted", counters.states.refuted);
    use("/certified_states/undecided", counters.states.undecided);
    use("/certified_states/seconds", counters.states.seconds);
    use("/certified_arcs/certified", counters.arcs.certified);
    use("/certified_arcs/undecided", counters.arcs.undecided);
    use("/certified_arcs/power_undecided", counters.arcs.power_undecided);
    use("/certified_arcs/pieces", counters.arcs.pieces);
    use("/certified_arcs/centres", counters.arcs.factorisations);
    use("/certified_arcs/tube_margin", counters.arcs.tube_margin);
    use("/certified_arcs/gap_margin", counters.arcs.gap_margin);
    use("/certified_arcs/seconds", counters.arcs.seconds);
}

/// Takes a number from a document: a run goes on counting from there.
template <class Value> void read_from(const json::Field& document, const std::string& place, Value& value) {
    json::Field field = document;
    for (std::size_t at = 1, end = 0; end != std::string::npos; at = end + 1) {
        end = place.find('/', at);
        const std::string name = place.substr(at, end - at);
        if (name == "choices" && !field.has("choices")) {
            return;
        }
        field = field.at(name.c_str());
    }
    if constexpr (std::is_floating_point_v<Value>) {
        value = field.number();
    } else {
        constexpr long most = sizeof(Value) == sizeof(int) ? std::numeric_limits<int>::max() : 1L << 53;
        const long count = field.integer();
        if (count < 0 || count > most) {
            field.fail("a count, an integer from 0 to {}", most);
        }
        value = static_cast<Value>(count);
    }
}

} // namespace

EventNames event_names(const RecordColumns& names) {
    EventNames result;
    for_each_event_field(ArcRecord{}, names, [&result](const std::string& name, const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        result.all.push_back(name);
        if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>>) {
            result.numbers.push_back(name);
        }
    });
    return result;
}

std::string event_line(const ArcRecord& arc, const RecordColumns& names) {
    Json line;
    for_each_event_field(arc, names, [&line](const std::string& name, const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, double>) {
            line[name] = json::or_null(value);
        } else if constexpr (std::is_same_v<Value, std::optional<double>> ||
                             std::is_same_v<Value, std::optional<Json>>) {
            if (value) {
                line[name] = *value;
            }
        } else {
            line[name] = value;
        }
    });
    return json::dumped(line) + "\n";
}

std::string witness_line(const ArcRecord& arc) {
    Json line;
    line["step"] = arc.step;
    if (arc.certificate && arc.certificate->verdict == Verdict::proved) {
        const ArcWitness& witness = arc.certificate->witness;
        if (!witness.whole) {
            line["grains"] = witness.grains;
        }
        line["centres"] = json::array_of(witness.centres, [](const ArcWitness::Centre& centre) {
            return Json{{"held", centre.held}, {"q", centre.q}};
        });
        line["end"] = witness.end;
    }
    return json::dumped(line) + "\n";
}

Json counters_json(const RunCounters& counters) {
    Json object;
    for_each_counter(counters, [&object](const std::string& place, auto value) {
        if constexpr (std::is_floating_point_v<decltype(value)>) {
            object[Json::json_pointer(place)] = json::or_null(value);
        } else if (value != 0 || !place.ends_with("/choices")) {
            object[Json::json_pointer(place)] = value;
        }
    });
    return object;
}

RunCounters counters_from(const json::Field& field) {
    RunCounters counters;
    for_each_counter(counters, [&field](const std::string& place, auto& value) { read_from(field, place, value); });
    return counters;
}

} // namespace isostat
