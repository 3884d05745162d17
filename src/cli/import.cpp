#include "answers/state.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/read_packing.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "io/lines.hpp"
#include "packing/bodies.hpp"
#include "packing/load_faults.hpp"
#include "packing/words.hpp"
#include "snap/nearest_vertex.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/result.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace isostat::cli {

namespace {

/// What was found, or the reason why nothing was.
struct Imported : compare::NearestVertex {
    std::vector<double> from; ///< coordinates of the file
    compare::Untold untold;   ///< undecided because of the rounding of the file
    bool load_of_file = false;
    bool copy = false;      ///< also undecided because of the jitter: the state is of a copy
    bool as_listed = false; ///< the list is written, whatever is proved
    bool held = false;      ///< no load can act on a degree of freedom: no equilibrium is required
    [[nodiscard]] Verdict verdict() const { return withheld(untold, truth.verdict); }
};

/// Takes over the stresses and the kind of load of a state, if not stated anew.
void keep_load(ImportArguments& a) {
    const State state = read_any_state(a.file).state;
    if (!state.load.disk_force.empty() || state.load.loaded_axis != 1) {
        refuse(a.file, "has forces on disks or another loaded axis than 1: expected a load on the walls alone");
    }
    if (a.stress.empty()) {
        a.stress = fmt::format("{},{}", state.load.stress[0], state.load.stress[1]);
    }
    if (a.load.empty()) {
        a.load = word_of(state.load.kind, load_kind_words);
    }
}

Load load_of(const ImportArguments& a, const Packing& packing) {
    Load load;
    load.dimension = packing.dimension;
    load.kind = value_of(a.load, load_kind_words).value_or(LoadKind::nominal);
    load.stress = parse_stress(a.stress, packing.dimension);
    load.loaded_axis = packing.dimension - 1;
    load.refer_to(packing);
    return load;
}

/// True for spheres and clumps: the contacts are the gaps within the rounding, or those up to a threshold.
bool by_digits(const Packing& packing) {
    return packing.dimension != plane || !packing.bars.empty();
}

/// Such grains, and disks in walls or a cell none of which moves, are written with the contacts that they have, because
/// no load determines a vertex, or no motion downhill leads to one.
bool as_listed(const ImportArguments& a, const Packing& packing) {
    return by_digits(packing) || a.foreign.walls == "fixed" || a.cell == "fixed";
}

/// Imports with the contacts of `plateau` (`by_digits`: gaps within the rounding), of a threshold or of a list.
Imported from_list(const ImportArguments& a, const ForeignPacking& file) {
    const bool digits = by_digits(file.packing);
    if (a.jitter != 0 || (digits ? !a.contacts.empty() : a.contacts == "nearest")) {
        refuse(ErrorKind::usage,
               "{} is a packing of {}: expected no --jitter and no --contacts{} (--threshold T lists the pairs with "
               "that gap or less)",
               a.file,
               !file.packing.bars.empty() ? "clumps"
               : digits                   ? "spheres"
                                          : "disks in walls or a cell that stays",
               digits ? ", which are of disks so far" : " nearest");
    }
    Imported out;
    out.from = file.packing.q;
    compare::SoftState listed{file.packing, {}, load_of(a, file.packing)};
    compare::SoftList list =
        digits || a.threshold     ? compare::list_up_to(file.packing, a.threshold.value_or(file.rounding))
        : a.contacts == "plateau" ? compare::list_of_plateau(file.packing, file.rounding)
                                  : stated_list(a.file, file, a.foreign.frame, a.contacts, a.contact_columns);
    list.words += digits && !a.threshold ? ", which the digits of the file leave open" : "";
    listed.contacts = std::move(list.contacts);
    out.as_listed = true;
    out.held = !digits;
    if (out.held) {
        out.state.packing = file.packing;
        out.state.contacts = std::move(listed.contacts);
        out.state.load = listed.load;
        out.contacts = fmt::format("{}, {}", out.state.contacts.size(), list.words);
    } else {
        static_cast<compare::NearestVertex&>(out) = compare::vertex_as_listed(listed, list.words, a.seed);
    }
    return out;
}

/// The vertex of a packing of another program.
Result<Imported> from_foreign(const ImportArguments& a, ForeignPacking& file) {
    const Load load = load_of(a, file.packing);
    compare::check_nearness(a.file, file.packing);
    if (as_listed(a, file.packing)) {
        return from_list(a, file);
    }
    std::optional<compare::SoftList> wanted;
    if (a.threshold || a.contacts == "plateau") {
        auto below = compare::list_below(file.packing, a.threshold, file.rounding);
        if (!below.ok()) {
            return below.failure();
        }
        wanted = std::move(below.value());
    } else if (a.contacts != "nearest") {
        wanted = stated_list(a.file, file, a.foreign.frame, a.contacts, a.contact_columns);
    }
    Imported out;
    out.from = file.packing.q;
    file.packing.radius = with_jitter(file.packing.radius, a.jitter, a.seed);
    auto found = wanted ? compare::vertex_of_list({file.packing, wanted->contacts, load}, wanted->words, a.seed)
                        : compare::vertex_downhill({file.packing, {}, load}, a.seed);
    if (!found.ok()) {
        return found.failure();
    }
    static_cast<compare::NearestVertex&>(out) = std::move(found.value());
    return out;
}

void set_cell(ImportArguments& a, bool own, Packing& packing) {
    a.contacts = !a.contacts.empty() || by_digits(packing) ? a.contacts : a.cell == "fixed" ? "plateau" : "nearest";
    const Cell before = packing.cell;
    take_cell({a.file, a.cell}, packing);
    if (own && a.cell.empty()) { // a state says which coordinates move
        packing.cell.tilt_moves = before.tilt_moves;
        if (before.keeps_shape) {
            packing.cell.keep_shape();
        }
    }
    validate(packing, a.file);
}

/// Reads the file, with walls unless the packing is periodic.
ForeignPacking read_imported(ImportArguments& a, bool crafted, bool own) {
    if (!crafted && !own && a.foreign.walls.empty()) {
        a.foreign.walls = "box";
        a.foreign.options.walls_unless_periodic = true;
    }
    a.foreign.options.cells = !crafted;
    a.foreign.spheres = true;
    a.foreign.clumps = !own;
    ForeignPacking file = read_any_packing(a.file, a.foreign);
    const bool spheres = file.packing.dimension != plane;
    if (a.foreign.walls == "none" && !crafted && !own && !spheres) {
        throw Error(ErrorKind::usage, "--walls is 'none': expected box, two fixed and two movable walls; square, whose "
                                      "size alone moves; or fixed");
    }
    if (a.foreign.walls == "square" && (a.contacts == "nearest" || a.jitter != 0)) {
        throw Error(ErrorKind::usage,
                    "--walls square has no way downhill: expected no --jitter, and --contacts plateau, "
                    "a file, or --threshold");
    }
    if (own && spheres) {
        refuse(a.file, "is a state of spheres: expected one of disks, which --jitter takes only so far");
    }
    if (crafted && !a.cell.empty()) {
        refuse(ErrorKind::usage,
               "--cell is '{}' and {} is a crafted packing, which says what moves: expected no --cell", a.cell, a.file);
    }
    if (file.packing.cell.any() && !crafted) {
        set_cell(a, own, file.packing);
    } else {
        if (!crafted) { // a crafted packing says which coordinates move
            take_cell({a.file, a.cell}, file.packing);
        }
        a.contacts = a.contacts.empty() && !by_digits(file.packing) ? "plateau" : a.contacts;
    }
    return file;
}

/// A vertex text with its own contacts and load.
Result<Imported> from_vertex_text(const ImportArguments& a) {
    if (!a.contacts.empty() || a.threshold || !a.stress.empty() || !a.load.empty() || !a.cell.empty() ||
        !a.foreign.walls.empty()) {
        refuse(a.file, "is a vertex text, which has its contacts, its walls and its load: expected no --contacts, "
                       "--threshold, --stress, --load, --walls or --cell");
    }
    Imported out;
    out.state = read_any_state(a.file).state;
    out.from = out.state.packing.q;
    out.truth = isostat::certify(out.state);
    out.contacts = "those of the vertex text";
    out.load_of_file = true;
    return out;
}

/// A crafted packing with its exact contacts and load, and the doubles next to its numbers.
Result<Imported> from_crafted(const ImportArguments& a, const std::string& text) {
    const crafted::PackingFile file = crafted::parse_packing(text, a.file);
    const auto inspection = crafted::inspect_file(file, a.file);
    if (!inspection.ok()) {
        return inspection.failure();
    }
    const crafted::Inspection& exact = inspection.value();
    if (exact.hyperstaticity != 0 || exact.mechanisms != 0) {
        return Failure{exact.rank_exact == Verdict::proved ? FailureKind::not_isostatic : FailureKind::undecided,
                       fmt::format("h = {}, k = {}: expected an isostatic packing, whose contacts determine it",
                                   exact.hyperstaticity, exact.mechanisms)};
    }
    Imported out;
    State& state = out.state;
    state.packing = crafted::approximate(file.packing);
    state.contacts = exact.contacts;
    state.load = load_of(a, state.packing);
    out.load_of_file = file.packing.load.has_value();
    if (file.packing.load) {
        const auto per_area = [&](const exact::Number& force, std::size_t axis) {
            double area = 1; // the lengths of the other axes
            for (std::size_t b = 0; b < state.packing.axes(); ++b) {
                area *= b == axis ? 1 : state.load.reference_length[b];
            }
            return area > 0 ? force.to_double() / area : 0;
        };
        for (std::size_t b = 0; b < state.packing.axes(); ++b) {
            state.load.stress[b] = per_area(file.packing.load->wall[b], b);
            for (std::size_t c = 0; c < b && file.packing.cell.any(); ++c) {
                state.load.shear[Cell::tilt(c, b)] = per_area(file.packing.load->tilt[Cell::tilt(c, b)], b);
            }
        }
        for (const exact::Number& force : file.packing.load->disk) {
            state.load.disk_force.push_back(force.to_double());
        }
        if (const auto rest = unbalanced<mpq_class>(state.load.disk_force, state.packing.cell)) {
            return Failure{
                FailureKind::undecided,
                fmt::format("the forces on the disks, rounded to doubles, do not sum to 0 along {}: expected "
                            "numbers that are doubles",
                            axis_names[rest->first])};
        }
    }
    out.from = state.packing.q;
    out.truth = isostat::certify(state);
    out.contacts = "those of the crafted packing, exactly";
    return out;
}

/// Notes where a disk moved by more than a tenth of its radius. Throws `Error(bad_input)` where it moved by more than
/// one and the user did not allow this: then the vertex is not that of the file.
void judge_moves(const ImportArguments& a, const Imported& found, const compare::Moves& moves,
                 std::vector<std::string>& notes) {
    constexpr double far = 0.1;
    std::size_t disk = 0; // the disk with a force that moved most, in its radii
    double radii = 0;
    for (std::size_t i = 0; i < moves.disk.size(); ++i) {
        if (const double moved = moves.disk[i] / found.state.packing.radius[i];
            moves.rattler[i] == 0 && moved > radii) {
            disk = i;
            radii = moved;
        }
    }
    const std::string words = fmt::format("disk {} moved by {} of its radius", disk, rounded_up(radii, 3));
    if (radii > 1 && !a.far && std::isfinite(radii)) {
        refuse(a.file, words + ": expected at most one on the way to the vertex (are the sizes wrong by a factor, or "
                               "the box? --far takes it)");
    }
    if (radii > far) {
        notes.push_back(words + ", more than a tenth: the vertex may not be that of the file");
    }
}

compare::Moves moves_of(const Imported& found) {
    if (!found.held) {
        return compare::moves_to(found.state, found.truth, found.from);
    }
    compare::Moves at_rest;
    at_rest.disk.assign(found.state.packing.radius.size(), 0);
    at_rest.rattler.assign(at_rest.disk.size(), 0);
    for (const int rattler : rattlers_by_coordination(found.state.packing, found.state.contacts)) {
        at_rest.rattler[static_cast<std::size_t>(rattler)] = 1;
    }
    return at_rest;
}

constexpr const char* moves_mark = ",moved,rattler\n";

std::string moves_csv(const Imported& found, const compare::Moves& moves) {
    const Packing& packing = found.state.packing;
    const std::size_t d = packing.axes();
    std::string text = (d == 2 ? "disk,x,y" : "sphere,x,y,z") + std::string(moves_mark);
    for (std::size_t i = 0; i < moves.disk.size(); ++i) {
        text += fmt::format("{},{},{},{}\n", i, fmt::join(&packing.q[d * i], &packing.q[d * i] + d, ","),
                            rounded_up(moves.disk[i], 6), moves.rattler[i]);
    }
    return text;
}

Json provenance_of(const ImportArguments& a, const std::string& format, const Imported& found,
                   const compare::Moves& moves) {
    Json out;
    out["program"] = program_name();
    out["command"] = a.common.command;
    out["imported_from"] = a.file;
    out["file_format"] = format;
    out["contacts"] = found.contacts;
    out["seed"] = a.seed;
    out["jitter"] = a.jitter;
    out["jitter_matters"] = found.copy;
    out["rounding"] = or_null(found.untold.rounding);
    out["moved"] = {
        {"backbone", or_null(moves.backbone)}, {"rattlers", or_null(moves.rattlers)}, {"walls", or_null(moves.walls)}};
    return out;
}

/// The load, and which of its parts the user did not state.
void add_load(answers::Answer& out, const ImportArguments& a, const Imported& found) {
    const Load& load = found.state.load;
    const std::vector<double> stress(load.stress.begin(), load.stress.begin() + load.dimension);
    const bool no_stress = a.stress.empty() && !found.load_of_file;
    const bool no_kind = a.load.empty() && !found.load_of_file;
    out.item("load",
             {{"stress", stress},
              {"kind", word_of(load.kind, load_kind_words)},
              {"by_default", {{"stress", no_stress}, {"kind", no_kind}}}},
             "load", "sigma = ({}), {}{}", fmt::format("{}", fmt::join(stress, ", ")),
             load.kind == LoadKind::nominal ? "nominal" : "true stresses",
             no_stress && no_kind ? " (taken by default: --stress, --load)"
             : no_stress          ? " (stresses taken by default: --stress)"
             : no_kind            ? " (its kind taken by default: --load)"
                                  : "");
}

/// \p provenance: of the state, with which the values begin.
answers::Answer import_answer(const ImportArguments& a, const ForeignPacking& file, const Imported& found,
                              const compare::Moves& moves, Json provenance) {
    const State& state = found.state;
    const Packing& packing = state.packing;
    const auto rattlers = std::ranges::count(moves.rattler, 1);
    const std::string grains = grain_word(packing.dimension) + std::string("s");
    answers::Answer out{.width = 9};
    out.json = std::move(provenance);
    out.line("file", "{} ({})", a.file, file.format);
    for (const std::string& note : file.notes) {
        out.line("", "{}", note);
    }
    out.line("contacts", "{}", found.contacts);
    out.item("state", a.output);
    out.item("notes", file.notes);
    out.item(grains, packing.disk_count());
    if (!packing.bars.empty()) {
        out.item("bodies", Bodies(packing).count());
    }
    if (found.held) {
        out.item("load", nullptr);
        out.item("verdict", nullptr, "written",
                 "{}: {} disks, {} rattlers by coordination, {} contacts, solid fraction {:.6f}; nothing moves "
                 "that a load presses on: isostat inspect says whether it is jammed",
                 a.output, packing.disk_count(), rattlers, state.contacts.size(), packing.solid_fraction());
        return out;
    }
    out.line("moved", "{} with a force at most {}, {} {}{}", grains, rounded_up(moves.backbone, 3),
             packing.cell.any() ? "cell" : "walls", rounded_up(moves.walls, 3),
             rattlers == 0
                 ? ""
                 : fmt::format(", {} {}, {}", rattlers,
                               packing.bars.empty() ? "rattlers, which rest on infinitesimal loads" : "without a force",
                               rounded_up(moves.rattlers, 3)));
    add_load(out, a, found);
    if (found.copy) {
        out.line("jitter", "this is a copy with other radii: gaps or forces are so small that h, the contacts and the "
                           "strict verdict may differ from those of the file");
    }
    answers::add_untold(out, found.untold, found.truth.verdict);
    out.item("verdict", to_string(found.verdict()), std::string(to_string(found.verdict())),
             "{}: {} {}, {} contacts, solid fraction {:.6f}{}", a.output, packing.disk_count(), grains,
             std::ranges::count_if(state.contacts, [](const Contact& c) { return c.is_unilateral(); }),
             packing.solid_fraction(),
             found.untold.any()
                 ? fmt::format("; {}; {} of the stored doubles", found.untold.words(), to_string(found.truth.verdict))
             : found.truth.claims.minimum ? "; not isostatic, stable along its mechanisms"
                                          : "");
    return out;
}

/// What the user may try where no vertex is proved. Empty: no advice.
std::string advice(const ImportArguments& a, bool crafted, const Packing& packing) {
    if (by_digits(packing)) {
        return "";
    }
    if (a.foreign.walls == "square") {
        return "; isostat inspect says of exact numbers (a packing in TOML) whether they are jammed";
    }
    std::vector<double> radius = packing.radius;
    std::ranges::sort(radius);
    const bool equal = std::ranges::adjacent_find(radius) != radius.end();
    std::string out = a.contacts == "nearest" || crafted || a.contacts.empty()
                          ? ""
                          : "; --contacts nearest takes the vertex downhill whatever its contacts";
    return out + (equal && !crafted && a.jitter == 0 ? "; equal radii: try --jitter 1e-9 --contacts nearest (a copy, "
                                                       "whose h and strict verdict may be others)"
                                                     : "");
}

/// A state of this program is imported with a jitter, a crafted packing without.
void require_importable(const ImportArguments& a, bool own, bool crafted) {
    if (own && a.jitter == 0) {
        (void)read_any_state(a.file); // reports what is wrong with a bad file
        refuse(a.file, "is a state of this program: expected a packing of another one, or --jitter");
    }
    if (crafted && a.jitter != 0) {
        refuse(a.file,
               "is a crafted packing, whose contacts are those of its exact radii: expected no --jitter, it is {}",
               a.jitter);
    }
}

} // namespace

int import(const ImportArguments& arguments) {
    ImportArguments a = arguments;
    check_output(a.output, "\"isostat-state\"", {a.file, a.contacts});
    check_output(a.moved, moves_mark, {a.file, a.contacts});
    const std::string text = read_text(a.file);
    const std::string format = a.foreign.options.format.empty() ? recognise_format(text) : a.foreign.options.format;
    const bool listed = format == "vertex" && a.jitter == 0;
    const bool own = !listed && (format == "state" || format == "vertex");
    const bool crafted = format == "packing";
    require_importable(a, own, crafted);
    if (own) {
        keep_load(a);
    }
    ForeignPacking file = listed ? ForeignPacking{} : read_imported(a, crafted, own);
    file.format = listed ? format : file.format;
    auto found = listed ? from_vertex_text(a) : crafted ? from_crafted(a, text) : from_foreign(a, file);
    if (found.ok() && !crafted && !listed) {
        Imported& f = found.value();
        f.untold = compare::untold_by(file.rounding, f.state, f.truth);
        const double jitter = 2 * a.jitter * file.packing.max_radius();
        f.copy = a.jitter > 0 && compare::untold_by(jitter + file.rounding, f.state, f.truth).any();
    }
    const bool as_is = found.ok() && found.value().as_listed;
    const bool refuted = found.ok() && found.value().verdict() == Verdict::refuted;
    if (!found.ok() || (refuted && !as_is)) {
        const std::string why =
            found.ok() ? found.value().truth.refuted.front() : found.failure().message(file.packing.dimension);
        say(stderr, "isostat: {}: {}{}\n", a.file, why, advice(a, crafted, file.packing));
        return refuted ? failed : status_of(found.failure().kind);
    }
    Imported& imported = found.value();
    const compare::Moves moves = moves_of(imported);
    if (imported.truth.claims.vertex) {
        judge_moves(a, imported, moves, file.notes);
    }
    const Json provenance = provenance_of(a, format, imported, moves);
    imported.state.provenance = json::dumped(provenance);
    if (imported.truth.verdict != Verdict::proved && !imported.held) {
        say(stderr, "isostat: {}: {}{}\n", a.file, fmt::format("{}", fmt::join(imported.truth.claims.undecided, "; ")),
            advice(a, crafted, file.packing));
    }
    if (!as_is && (!imported.truth.claims.vertex || !imported.truth.claims.forces)) {
        return undecided;
    }
    write_state(a.output, imported.state);
    if (!a.moved.empty()) {
        write_output(a.moved, moves_csv(imported, moves), moves_mark);
    }
    print(import_answer(a, file, imported, moves, provenance), a.common);
    return imported.held ? 0 : status_of(imported.verdict());
}

} // namespace isostat::cli
