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

/// The forces of the file against those that balance there.
void add_forces(answers::Answer& out, const Read& read, const compare::Snap& snap) {
    if (read.forces.empty() || snap.counting.hyperstaticity != 0 || snap.counting.mechanisms != 0) {
        return;
    }
    const double mean = compare::mean_force(read.forces);
    const compare::ForceSplit split = compare::split_forces(read.soft, read.forces, mean, snap);
    const std::string units = split.rest > compare::force_agreement ? split.units.words(compare::force_agreement) : "";
    const std::string contact = std::isfinite(split.rest) ? to_string(split.worst, read.soft.packing.dimension) : "";
    out.item("forces", {{"mean", or_null(mean)},
                        {"rest", or_null(split.rest)},
                        {"stiffness", or_null(split.stiffness)},
                        {"factor", or_null(split.units.factor)},
                        {"rest_in_units", or_null(split.units.left)},
                        {"units", units},
                        {"contact", contact.empty() ? Json() : Json(contact)}});
    if (contact.empty()) {
        return;
    }
    out.line("forces",
             "of the file differ by at most {} mean forces from those that balance at its coordinates, in {}{}",
             rounded_up(split.rest, 2), contact,
             std::isfinite(split.stiffness)
                 ? fmt::format("; those by at most {} from the ones at the vertex", rounded_up(split.stiffness, 2))
                 : "");
    if (!units.empty()) {
        out.line("", "{}", units);
    }
}

/// The state to write, if any, with words on it.
struct Found {
    std::optional<State> state;
    std::string reason;
    double distance = 0;
    std::optional<bool> unique{}; ///< known where the list or the way downhill has a vertex
};

Found state_of(const SnapArguments& a, const Read& read, const compare::Snap& snap) {
    const int dimension = read.soft.packing.dimension;
    Found out{std::nullopt, snap.reason, snap.distance};
    if (snap.outcome == compare::SnapOutcome::vertex) {
        auto state = compare::with_resting_rattlers(snap, a.seed);
        out.unique = true;
        out.reason = state.ok() ? "" : state.failure().message(dimension);
        out.state = state.ok() ? std::optional(std::move(state.value())) : std::nullopt;
    } else if (a.exchange) {
        auto found = compare::exchange(read.soft, a.seed);
        if (!found.ok() || found.value().truth.verdict != Verdict::proved) {
            out.reason +=
                "; downhill: " + (found.ok() ? "the vertex is not proved" : found.failure().message(dimension));
            return out;
        }
        compare::Exchanged& e = found.value();
        out.unique = false;
        out.distance = e.distance;
        out.reason +=
            fmt::format("; the vertex downhill is proved, not that it is the only one near: without{}; with{}",
                        compare::names_of(compare::without(read.soft.contacts, e.contacts), dimension),
                        compare::names_of(compare::without(e.contacts, read.soft.contacts), dimension));
        out.state = std::move(e.state);
    }
    return out;
}

/// The values begin the provenance of the state.
answers::Answer snap_answer(const SnapArguments& a, const Read& read, const compare::Snap& snap, const Found& found) {
    const Counting& c = snap.counting;
    answers::Answer out{.width = 9};
    for (const std::string& note : read.notes) {
        out.line("", "{}", note);
    }
    out.json = {{"program", program_name()}, {"command", a.common.command}, {"snapped_from", a.file}};
    out.item("contacts", read.words, "contacts", "{}: N_f = {}, N = {}, rank {}, h = {}, k = {}, {} rattlers",
             read.words, c.dof_count, c.contact_count, c.rank, c.hyperstaticity, c.mechanisms, snap.rattlers.size());
    out.json.update(
        {{"N_f", c.dof_count}, {"N", c.contact_count}, {"rank", c.rank}, {"h", c.hyperstaticity}, {"k", c.mechanisms}});
    out.item("rattlers", snap.rattlers);
    out.item("outcome", to_string(snap.outcome), "snap", "{}{}{}", to_string(snap.outcome),
             found.reason.empty() ? "" : ": ", found.reason);
    out.item("reason", found.reason);
    out.item("distance", or_null(found.distance));
    if (std::isfinite(found.distance)) {
        out.line("distance", "of a {} with a force from its true place at most {}",
                 grain_word(read.soft.packing.dimension), rounded_up(found.distance, 3));
    }
    out.item("walls", or_null(snap.walls));
    add_forces(out, read, snap);
    if (found.unique) {
        out.item("unique", *found.unique);
    }
    return out;
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
    Found found = state_of(a, read, snap);
    answers::Answer answer = snap_answer(a, read, snap, found);
    compare::Untold untold;
    if (found.state) {
        const Certification truth = certify(*found.state);
        untold = compare::untold_by(read.rounding, *found.state, truth);
        answers::add_untold(answer, untold, truth.verdict);
        Json provenance = answer.json;
        provenance["rounding"] = or_null(read.rounding);
        found.state->provenance = json::dumped(provenance);
        write_state(a.output, *found.state);
        answer.line("written", "{}", a.output);
    }
    if (untold.any()) {
        answer.line("undecided", "{}", untold.words());
    }
    answer.item("state", found.state ? Json(a.output) : Json());
    print(std::move(answer), a.common);
    return untold.any()                                                                                      ? undecided
           : found.state                                                                                     ? done
           : snap.outcome == compare::SnapOutcome::vertex || snap.outcome == compare::SnapOutcome::undecided ? undecided
                                                                                                             : failed;
}

} // namespace isostat::cli
