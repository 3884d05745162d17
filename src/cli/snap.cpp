#include "answers/state.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/read_packing.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "packing/words.hpp"
#include "snap/force_split.hpp"
#include "snap/soft_list.hpp"

#include <isostat/core/result.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/snap/snap.hpp>

#include <fmt/format.h>

#include <cmath>

namespace isostat::cli {

namespace {

struct Read : compare::SoftForces {
    std::string words;
    std::vector<std::string> notes;
    double rounding = 0; ///< of gaps
};

/// A state has its own contacts and load.
Read from_state(const SnapArguments& a) {
    if (!a.contacts.empty() || !a.stress.empty() || !a.load.empty() || !a.reference_length.empty()) {
        throw Error(ErrorKind::usage, a.file + " is a state, which says its contacts and its load: expected none of "
                                               "--contacts, --stress, --load, --reference-length");
    }
    const StateFile file = read_any_state(a.file, Dimensions::any);
    Read out;
    static_cast<compare::SoftForces&>(out) = compare::soft_grains(file, a.file);
    out.rounding = compare::imported_rounding(file.state);
    out.words = fmt::format("{} contacts of the state, those that can carry a force", file.state.contacts.size());
    return out;
}

Read from_foreign(const SnapArguments& a) {
    if (!a.reference_length.empty()) { // numbers are checked before the file is read
        (void)parse_lengths(a.reference_length, "--reference-length",
                            parse_list(a.reference_length).size() == 3 ? 3 : 2);
    }
    ForeignArguments foreign = a.foreign;
    foreign.options.walls_unless_periodic = foreign.walls.empty();
    foreign.options.cells = foreign.spheres = true;
    foreign.walls = foreign.walls.empty() ? "box" : foreign.walls;
    if (foreign.walls != "box") {
        refuse(ErrorKind::usage,
               "--walls is '{}': expected box, a fixed lower and a movable upper wall along each axis", foreign.walls);
    }
    ForeignPacking file = read_any_packing(a.file, foreign);
    take_cell({a.file, a.cell}, file.packing);
    compare::check_nearness(a.file, file.packing);
    compare::SoftList list = a.contacts.empty()
                                 ? compare::list_by_overlaps(file.packing)
                                 : stated_list(a.file, file, foreign.frame, a.contacts, a.contact_columns);
    Read out;
    out.words = list.words;
    out.forces = list.forces;
    out.notes = file.notes;
    out.rounding = file.rounding;
    out.soft.packing = file.packing;
    out.soft.contacts = std::move(list.contacts);
    out.soft.load.kind = value_of(a.load, load_kind_words).value_or(LoadKind::nominal);
    const int dimension = file.packing.dimension;
    out.soft.load.dimension = dimension;
    out.soft.load.loaded_axis = dimension - 1;
    out.soft.load.stress = parse_stress(a.stress, dimension);
    out.soft.load.refer_to(file.packing);
    if (!a.reference_length.empty()) {
        out.soft.load.reference_length = parse_lengths(a.reference_length, "--reference-length", dimension);
    }
    return out;
}

Json json_of(const SnapArguments& a, const Read& read, const compare::Snap& snap) {
    Json out;
    out["program"] = program_name();
    out["command"] = a.common.command;
    out["snapped_from"] = a.file;
    out["contacts"] = read.words;
    out["N_f"] = snap.counting.dof_count;
    out["N"] = snap.counting.contact_count;
    out["rank"] = snap.counting.rank;
    out["h"] = snap.counting.hyperstaticity;
    out["k"] = snap.counting.mechanisms;
    out["rattlers"] = snap.rattlers;
    out["outcome"] = to_string(snap.outcome);
    out["reason"] = snap.reason;
    out["distance"] = or_null(snap.distance);
    out["walls"] = or_null(snap.walls);
    if (!read.forces.empty() && snap.counting.hyperstaticity == 0 && snap.counting.mechanisms == 0) {
        const double mean = compare::mean_force(read.forces);
        const compare::ForceSplit split = compare::split_forces(read.soft, read.forces, mean, snap);
        const std::string units =
            split.rest > compare::force_agreement ? split.units.words(compare::force_agreement) : "";
        out["forces"] = {{"mean", or_null(mean)},
                         {"rest", or_null(split.rest)},
                         {"stiffness", or_null(split.stiffness)},
                         {"factor", or_null(split.units.factor)},
                         {"rest_in_units", or_null(split.units.left)},
                         {"units", units},
                         {"contact", std::isfinite(split.rest)
                                         ? Json(to_string(split.worst, read.soft.packing.dimension))
                                         : Json()}};
    }
    return out;
}

/// The state to write, with words on it; nothing: no state.
std::optional<State> state_of(const SnapArguments& a, const Read& read, const compare::Snap& snap, Json& report) {
    if (snap.outcome == compare::SnapOutcome::vertex) {
        auto state = compare::with_resting_rattlers(snap, a.seed);
        report["unique"] = true;
        report["reason"] = state.ok() ? "" : state.failure().message(read.soft.packing.dimension);
        return state.ok() ? std::optional(std::move(state.value())) : std::nullopt;
    }
    if (!a.exchange) {
        return std::nullopt;
    }
    const int dimension = read.soft.packing.dimension;
    auto found = compare::exchange(read.soft, a.seed);
    if (!found.ok() || found.value().truth.verdict != Verdict::proved) {
        report["reason"] = snap.reason + "; downhill: " +
                           (found.ok() ? "the vertex is not proved" : found.failure().message(dimension));
        return std::nullopt;
    }
    compare::Exchanged& e = found.value();
    report["unique"] = false;
    report["distance"] = or_null(e.distance);
    report["reason"] =
        fmt::format("{}; the vertex downhill is proved, not that it is the only one near: without{}; with{}",
                    snap.reason, compare::names_of(compare::without(read.soft.contacts, e.contacts), dimension),
                    compare::names_of(compare::without(e.contacts, read.soft.contacts), dimension));
    return std::move(e.state);
}

void print(const SnapArguments& a, const Read& read, const compare::Snap& snap, const Json& report, bool written) {
    for (const std::string& note : read.notes) {
        say("          {}\n", note);
    }
    say("contacts  {}: N_f = {}, N = {}, rank {}, h = {}, k = {}, {} rattlers\n", read.words, snap.counting.dof_count,
        snap.counting.contact_count, snap.counting.rank, snap.counting.hyperstaticity, snap.counting.mechanisms,
        snap.rattlers.size());
    say("snap      {}{}{}\n", to_string(snap.outcome), report["reason"].get<std::string>().empty() ? "" : ": ",
        report["reason"].get<std::string>());
    if (!report["distance"].is_null()) {
        say("distance  of a {} with a force from its true place at most {}\n", grain_word(read.soft.packing.dimension),
            rounded_up(report["distance"].get<double>(), 3));
    }
    if (const auto forces = report.find("forces"); forces != report.end() && !(*forces)["rest"].is_null()) {
        say("forces    of the file differ by at most {} mean forces from those that balance at its coordinates, "
            "in {}",
            rounded_up((*forces)["rest"].get<double>(), 2), (*forces)["contact"].get<std::string>());
        say("{}\n", (*forces)["stiffness"].is_null()
                        ? ""
                        : fmt::format("; those by at most {} from the ones at the vertex",
                                      rounded_up((*forces)["stiffness"].get<double>(), 2)));
        if (const std::string units = (*forces)["units"]; !units.empty()) {
            say("          {}\n", units);
        }
    }
    if (written) {
        say("written   {}\n", a.output);
    }
}

} // namespace

int snap(const SnapArguments& a) {
    check_output(a.output, "\"isostat-state\"", {a.file, a.contacts});
    const std::string text = read_text(a.file);
    const std::string format = a.foreign.options.format.empty() ? recognise_format(text) : a.foreign.options.format;
    Read read = format == "state" || format == "vertex" ? from_state(a) : from_foreign(a);
    if (a.stiffness > 0) {
        compare::add_law(read, {a.law == "hertz" ? compare::ForceLaw::hertz : compare::ForceLaw::linear, a.stiffness});
    }
    const compare::Snap snap = compare::snap(read.soft);
    Json report = json_of(a, read, snap);
    std::optional<State> state = state_of(a, read, snap, report);
    compare::Untold untold;
    if (state) {
        const Certification truth = certify(*state);
        untold = compare::untold_by(read.rounding, *state, truth);
        answers::add_untold(report, untold, truth.verdict);
        Json provenance = report;
        provenance["rounding"] = or_null(read.rounding);
        state->provenance = json::dumped(provenance);
        write_state(a.output, *state);
    }
    if (a.common.json) {
        report["state"] = state ? Json(a.output) : Json();
        print_json(report);
    } else {
        print(a, read, snap, report, state.has_value());
        if (untold.any()) {
            say("undecided {}\n", untold.words());
        }
    }
    return untold.any()                                                                                      ? undecided
           : state                                                                                           ? done
           : snap.outcome == compare::SnapOutcome::vertex || snap.outcome == compare::SnapOutcome::undecided ? undecided
                                                                                                             : failed;
}

} // namespace isostat::cli
