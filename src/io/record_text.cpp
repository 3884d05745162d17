#include "io/record_text.hpp"

#include "io/perturbation_json.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/run_directory.hpp>

#include <fmt/format.h>

#include <array>
#include <limits>

namespace isostat {

namespace {

using json::Json;

/// Of every row.
constexpr std::array common_columns{"number",
                                    "previous",
                                    "segment",
                                    "sigma2",
                                    "ratio",
                                    "eps1",
                                    "eps2",
                                    "L1",
                                    "L2",
                                    "solid_fraction",
                                    "arcs",
                                    "rattlers",
                                    "backbone",
                                    "dofs",
                                    "contacts",
                                    "rank",
                                    "h",
                                    "k",
                                    "held",
                                    "sigma2_low",
                                    "sigma2_high",
                                    "opens_low_i",
                                    "opens_low_j",
                                    "opens_high_i",
                                    "opens_high_j",
                                    "potential",
                                    "min_force",
                                    "min_force_i",
                                    "min_force_j",
                                    "min_gap",
                                    "min_gap_i",
                                    "min_gap_j",
                                    "force_bound",
                                    "sigma_min_bound",
                                    "balance",
                                    "virtual_power",
                                    "gap_residual",
                                    "margin",
                                    "decided_by",
                                    "proved",
                                    "certified",
                                    "eps1_bound",
                                    "eps2_bound",
                                    "L1_bound",
                                    "L2_bound",
                                    "sigma2_low_bound",
                                    "sigma2_high_bound",
                                    "potential_bound",
                                    "min_gap_bound",
                                    "seconds"};

/// Columns i and j of a contact: see `equilibria_columns`.
std::string two_columns(const Contact& contact) {
    constexpr int none = -9;
    if (contact.i < 0) {
        return fmt::format("{0},{0}", none);
    }
    switch (contact.kind) {
    case ContactKind::disk_disk: return fmt::format("{},{}", contact.i, contact.j);
    case ContactKind::lower_wall: return fmt::format("{},{}", contact.i, -1 - contact.j);
    case ContactKind::upper_wall: return fmt::format("{},{}", contact.i, -3 - contact.j);
    case ContactKind::held: break;
    }
    return fmt::format("{},{}", contact.i, none);
}

/// "log2_zero": bound of what vanishes in the base, null: exactly; without "bits" no difference was to be found.
Json tie_json(const TieDecision& tie) {
    const auto term = [](const Enclosure& e) { return Json::array({json::or_null(e.value), json::or_null(e.radius)}); };
    Json object;
    object["decision"] = tie.what;
    object["contact"] = to_string<2>(tie.chosen);
    object["first_order"] = term(tie.first);
    if (tie.against.i >= 0) {
        object["against"] = to_string<2>(tie.against);
        object["against_first_order"] = term(tie.other);
    }
    if (tie.choice != TieChoice::none) {
        object["choice"] = to_string(tie.choice);
    }
    if (tie.what != "step") {
        object["log2_zero"] = json::exponent_json(tie.exponent);
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

/// A run goes on counting from here.
long counted(const json::Field& field) {
    constexpr long most = 1L << 53;
    const long value = field.integer();
    if (value < 0 || value > most) {
        field.fail("a count");
    }
    return value;
}

} // namespace

std::string event_line(const ArcRecord<2>& arc) {
    Json line;
    line["step"] = arc.step;
    line["equilibrium"] = arc.equilibrium;
    line["arc"] = arc.arc;
    line["kind"] = to_string(arc.kind);
    line["opened"] = to_string<2>(arc.opened);
    line["closed"] = to_string<2>(arc.closed);
    line["power_turn"] = arc.power_turn;
    if (arc.power_turn) {
        line["held_at"] = arc.held_at;
    }
    line["sigma2"] = json::or_null(arc.stress);
    line["eps2"] = json::or_null(arc.strain);
    line["eps2_bound"] = json::or_null(arc.strain_bound);
    line["force"] = json::or_null(arc.force);
    line["force_bound"] = json::or_null(arc.force_bound);
    line["power"] = json::or_null(arc.power);
    line["power_bound"] = json::or_null(arc.power_bound);
    line["work"] = json::or_null(arc.work);
    line["work_bound"] = json::or_null(arc.work_bound);
    line["displacement"] = json::or_null(arc.displacement);
    line["steps"] = arc.steps;
    line["margin"] = json::or_null(arc.margin);
    line["decided_by"] = to_string(arc.decided_by);
    if (!arc.perturbed.empty()) {
        line["perturbed"] = Json::array();
        for (const TieDecision& tie : arc.perturbed) {
            line["perturbed"].push_back(tie_json(tie));
        }
    }
    if (arc.certificate) {
        line["certificate"] = certificate_json(*arc.certificate);
    }
    return json::dumped(line) + "\n";
}

std::string witness_line(const ArcRecord<2>& arc) {
    Json line;
    line["step"] = arc.step;
    if (arc.certificate && arc.certificate->verdict == Verdict::proved) {
        const ArcWitness& witness = arc.certificate->witness;
        if (!witness.whole) {
            line["grains"] = witness.grains;
        }
        line["centres"] = Json::array();
        for (const ArcWitness::Centre& centre : witness.centres) {
            line["centres"].push_back({{"held", centre.held}, {"q", centre.q}});
        }
        line["end"] = witness.end;
    }
    return json::dumped(line) + "\n";
}

std::vector<std::string> equilibria_columns(MoreColumns more) {
    std::vector<std::string> all(common_columns.begin(), common_columns.end());
    const auto add = [&all](std::initializer_list<const char*> names) {
        all.insert(all.end() - 1, names.begin(), names.end()); // the time is last
    };
    if (more.tilt) {
        add({"eps3", "L3", "eps3_bound", "L3_bound"});
    }
    if (more.touching) {
        add({"touching"});
    }
    return all;
}

std::string equilibria_header(MoreColumns more) {
    return fmt::format("# {}\n", fmt::join(equilibria_columns(more), ","));
}

MoreColumns named_columns(std::string_view text, const std::string& source) {
    for (const bool tilt : {false, true}) {
        for (const bool touching : {false, true}) {
            if (text.starts_with(equilibria_header({tilt, touching}))) {
                return {tilt, touching};
            }
        }
    }
    throw Error(ErrorKind::bad_input, fmt::format("{}:1: the names of the columns are not those of this program: "
                                                  "expected {}",
                                                  source, equilibria_header()));
}

std::string equilibrium_row(const EquilibriumRecord<2>& record, const State<2>& state, int previous, MoreColumns more) {
    const auto loaded = static_cast<std::size_t>(state.load.loaded_axis);
    const auto other = static_cast<std::size_t>(state.load.other_axis());
    std::string row = fmt::format("{},{},{},{},{}", record.number, previous, record.segment, record.stress,
                                  record.stress / record.sigma1);
    row += fmt::format(",{},{},{},{},{}", record.strain[other], record.strain[loaded], record.length[other],
                       record.length[loaded], state.packing.solid_fraction());
    row += fmt::format(",{},{},{},{},{},{},{},{},{}", record.arcs, record.rattlers, record.backbone, record.dof_count,
                       record.contact_count, record.rank, record.hyperstaticity, record.mechanisms, record.held);
    row += fmt::format(",{},{},{},{}", record.stress_low, record.stress_high, two_columns(record.opens_low),
                       two_columns(record.opens_high));
    row += fmt::format(",{},{},{},{},{}", record.potential, record.min_force, two_columns(record.min_force_contact),
                       record.min_gap, two_columns(record.min_gap_contact));
    row += fmt::format(",{},{},{},{},{}", record.force_bound, record.sigma_min_bound, record.balance,
                       record.virtual_power, record.gap_residual);
    const int certified = !record.certified ? -1 : *record.certified == Verdict::proved ? 1 : 0;
    row += fmt::format(",{},{},{},{}", record.margin, static_cast<int>(record.decided_by),
                       record.verdict == Verdict::proved ? 1 : 0, certified);
    row += fmt::format(",{},{},{},{},{},{},{},{}", record.strain_bound[other], record.strain_bound[loaded],
                       record.length_bound[other], record.length_bound[loaded], record.stress_low_bound,
                       record.stress_high_bound, record.potential_bound, record.min_gap_bound);
    if (more.tilt) {
        const std::size_t third = 3 - other - loaded;
        row += fmt::format(",{},{},{},{}", record.strain[third], record.length[third], record.strain_bound[third],
                           record.length_bound[third]);
    }
    if (more.touching) {
        row += fmt::format(",{}", record.touching.value());
    }
    row += fmt::format(",{:.3f}\n", record.seconds); // last: runs are compared without it
    return row;
}

Json tally_json(const Tally& tally) {
    Json object;
    object["combinatorial"] = tally.combinatorial;
    object["double"] = tally.double_bound;
    object["double-double"] = tally.double_double;
    object["mpfr"] = tally.multiprecision;
    object["exact"] = tally.exact;
    object["undecided"] = tally.undecided;
    object["smallest_margin"] = json::or_null(tally.smallest_margin);
    for (std::size_t k = 0; k < decision_kinds; ++k) {
        Json& kind = object["kinds"][std::string(to_string(static_cast<DecisionKind>(k)))];
        for (std::size_t rung = 0; rung < tally.by_kind[k].size(); ++rung) {
            kind[std::string(to_string(static_cast<Rung>(rung)))] = tally.by_kind[k][rung];
        }
        kind["smallest_margin"] = json::or_null(tally.smallest_margin_of[k]);
    }
    object["ties"]["structural"] = tally.structural_ties;
    object["ties"]["other"] = tally.ties;
    for (std::size_t k = 0; k < decision_kinds; ++k) {
        object["ties"]["perturbed"][std::string(to_string(static_cast<DecisionKind>(k)))] = tally.perturbed[k];
    }
    if (tally.choices > 0) {
        object["ties"]["choices"] = tally.choices;
    }
    return object;
}

Json state_tally_json(const StateTally& tally) {
    Json object;
    object["proved"] = tally.proved;
    object["refuted"] = tally.refuted;
    object["undecided"] = tally.undecided;
    object["seconds"] = tally.seconds;
    return object;
}

Json arc_tally_json(const ArcTally& tally) {
    Json object;
    object["certified"] = tally.certified;
    object["undecided"] = tally.undecided;
    object["power_undecided"] = tally.power_undecided;
    object["pieces"] = tally.pieces;
    object["centres"] = tally.factorisations;
    object["tube_margin"] = tally.tube_margin;
    object["gap_margin"] = tally.gap_margin;
    object["seconds"] = tally.seconds;
    return object;
}

Json counters_json(const RunCounters& counters) {
    Json object;
    object["arcs"] = counters.steps;
    object["equilibria"] = counters.equilibria;
    object["seconds"] = counters.seconds;
    object["decisions"] = tally_json(counters.tally);
    object["certified_states"] = state_tally_json(counters.states);
    object["certified_arcs"] = arc_tally_json(counters.arcs);
    return object;
}

RunCounters counters_from(const json::Field& field) {
    RunCounters counters;
    counters.steps = counted(field.at("arcs"));
    counters.equilibria = field.at("equilibria").integer(0, std::numeric_limits<int>::max());
    counters.seconds = field.at("seconds").number();
    const json::Field tally = field.at("decisions");
    counters.tally.combinatorial = counted(tally.at("combinatorial"));
    counters.tally.double_bound = counted(tally.at("double"));
    counters.tally.double_double = counted(tally.at("double-double"));
    counters.tally.multiprecision = counted(tally.at("mpfr"));
    counters.tally.exact = counted(tally.at("exact"));
    counters.tally.undecided = counted(tally.at("undecided"));
    for (std::size_t k = 0; k < decision_kinds; ++k) {
        const json::Field kind = tally.at("kinds").at(std::string(to_string(static_cast<DecisionKind>(k))).c_str());
        for (std::size_t rung = 0; rung < counters.tally.by_kind[k].size(); ++rung) {
            counters.tally.by_kind[k][rung] = counted(kind.at(std::string(to_string(static_cast<Rung>(rung))).c_str()));
        }
        counters.tally.smallest_margin_of[k] = kind.at("smallest_margin").number();
    }
    counters.tally.structural_ties = counted(tally.at("ties").at("structural"));
    counters.tally.ties = counted(tally.at("ties").at("other"));
    counters.tally.choices = tally.at("ties").has("choices") ? counted(tally.at("ties").at("choices")) : 0;
    for (std::size_t k = 0; k < decision_kinds; ++k) {
        counters.tally.perturbed[k] =
            counted(tally.at("ties").at("perturbed").at(std::string(to_string(static_cast<DecisionKind>(k))).c_str()));
    }
    counters.tally.smallest_margin = tally.at("smallest_margin").number();
    const json::Field states = field.at("certified_states");
    counters.states.proved = counted(states.at("proved"));
    counters.states.refuted = counted(states.at("refuted"));
    counters.states.undecided = counted(states.at("undecided"));
    counters.states.seconds = states.at("seconds").number();
    const json::Field arcs = field.at("certified_arcs");
    counters.arcs.certified = counted(arcs.at("certified"));
    counters.arcs.undecided = counted(arcs.at("undecided"));
    counters.arcs.power_undecided = counted(arcs.at("power_undecided"));
    counters.arcs.pieces = counted(arcs.at("pieces"));
    counters.arcs.factorisations = counted(arcs.at("centres"));
    counters.arcs.tube_margin = arcs.at("tube_margin").number();
    counters.arcs.gap_margin = arcs.at("gap_margin").number();
    counters.arcs.seconds = arcs.at("seconds").number();
    return counters;
}

} // namespace isostat
