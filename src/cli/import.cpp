#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/read_packing.hpp"
#include "contact/words.hpp"
#include "crafted/peeling.hpp"
#include "io/json.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/error.hpp>
#include <isostat/crafted/inspection.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/io/files.hpp>
#include <isostat/io/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace isostat::cli {

namespace {

/// A packing must be this near to touching, in smallest radii: overlaps, and gaps at every wall.
constexpr double nearly_touching = 0.1;

/// The contacts that the vertex must have.
struct Wanted {
    bool any = false; ///< whatever the vertex has
    std::vector<Contact> contacts;
    std::string words; ///< where they come from
};

/// What was found, or why nothing was.
struct Imported {
    State<2> state;
    std::vector<double> from; ///< coordinates of the file
    std::string contacts;     ///< words
    Certification truth;
};

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
    throw Error(ErrorKind::bad_input, file + ": " + what);
}

/// Stresses and kind of load of a state, which were not stated anew.
void keep_load(ImportArguments& a) {
    const State<2> state = read_state<2>(a.file).state;
    if (!state.load.disk_force.empty() || state.load.loaded_axis != 1) {
        refuse(a.file, "has forces on disks or another loaded axis than 1: expected a load on the walls alone");
    }
    if (a.stress.empty()) {
        a.stress = fmt::format("{},{}", state.load.stress[0], state.load.stress[1]);
    }
    if (a.load.empty()) {
        a.load = state.load.kind == LoadKind::nominal ? "nominal" : "true";
    }
}

std::array<double, 2> stresses_of(const ImportArguments& a) {
    if (a.stress.empty()) {
        return {1, 1};
    }
    const std::vector<std::string> words = parse_list(a.stress);
    std::array<double, 2> stress{};
    bool good = words.size() == 2;
    for (std::size_t k = 0; good && k < 2; ++k) {
        const char* const end =
            words[k].data() + words[k].size(); // NOLINT(cppcoreguidelines-pro-bounds-pointer-arithmetic)
        const auto [stop, error] = std::from_chars(words[k].data(), end, stress[k]);
        good = error == std::errc() && stop == end && stress[k] > 0 && std::isfinite(stress[k]);
    }
    if (!good) {
        throw Error(ErrorKind::usage, fmt::format("--stress is '{}': expected S1,S2, two positive numbers", a.stress));
    }
    return stress;
}

/// Every wall near a disk, no overlap deep: else the file is no packing of nearly rigid disks in these walls.
void check_nearness(const std::string& file, const Packing<2>& packing) {
    const double near = nearly_touching * packing.min_radius();
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (int axis = 0; axis < 2; ++axis) {
            double nearest = HUGE_VAL;
            for (int i = 0; i < packing.disk_count(); ++i) {
                nearest = std::min(nearest, gap<2>(packing, {kind, i, axis}));
            }
            if (nearest > near) {
                const std::string name = to_string<2>({kind, 0, axis}).substr(2);
                refuse(file,
                       fmt::format("no disk is near the {} wall, the nearest gap is {:.3g}: expected the "
                                   "positions of the walls, --box XLO:XHI,YLO:YHI (bounds of a file often are not "
                                   "those)",
                                   name, nearest));
            }
        }
    }
    const double deepest = crafted::plateau(packing, {near}).deepest_overlap;
    if (deepest < -near) {
        refuse(file, fmt::format("two grains overlap by {:.3g}: expected at most {:.3g}, {} of the smallest radius",
                                 -deepest, near, nearly_touching));
    }
}

/// The contacts of the widest range of thresholds with an isostatic backbone, or at the threshold given.
Result<Wanted> wanted_below(const ImportArguments& a, const Packing<2>& packing) {
    const double largest = a.threshold.value_or(nearly_touching * packing.min_radius());
    if (a.threshold) {
        const crafted::PlateauStep step = crafted::plateau(packing, {largest}).steps.front();
        if (step.backbone.isostatic != Verdict::proved) {
            return failed(step.backbone.isostatic == Verdict::refuted ? FailureKind::not_isostatic
                                                                      : FailureKind::undecided,
                          "at the threshold {} the backbone has N_f = {}, N = {}, h = {}, k = {}: expected "
                          "an isostatic one",
                          largest, step.backbone.dof_count, step.backbone.contact_count, step.backbone.hyperstaticity,
                          step.backbone.mechanisms);
        }
        return Wanted{false, crafted::backbone_at(packing, largest), fmt::format("gaps up to {}", largest)};
    }
    const double deepest = std::min(crafted::plateau(packing, {largest}).deepest_overlap, largest);
    const crafted::Plateau plateau = crafted::plateau(packing, deepest, largest, 1);
    if (plateau.ranges.empty()) {
        return failed(plateau.special.empty() ? FailureKind::not_isostatic : FailureKind::undecided,
                      "the backbone is isostatic at no threshold up to {:.6g}: isostat plateau shows the "
                      "counts, --contacts nearest takes the vertex downhill whatever its contacts",
                      largest);
    }
    const auto range =
        *std::max_element(plateau.ranges.begin(), plateau.ranges.end(),
                          [](const auto& x, const auto& y) { return x.last - x.first < y.last - y.first; });
    return Wanted{
        false, crafted::backbone_at(packing, range.first),
        fmt::format("isostatic backbone at every threshold from {:.6g} to {:.6g}, proved", range.first, range.last)};
}

/// Those that can carry a force by the positions of the normals: soft rattlers touch now and then.
std::vector<Contact> backbone_of(const Packing<2>& packing, const std::vector<Contact>& contacts) {
    const std::vector<int> from = crafted::peel(packing, contacts).contact_from;
    std::vector<Contact> out;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (from[l] <= static_cast<int>(contacts.size())) {
            out.push_back(contacts[l]);
        }
    }
    return out;
}

/// Pairs with a force, and the walls that a disk overlaps.
Wanted wanted_by_forces(const ImportArguments& a, const ReadPacking& file) {
    const std::vector<std::string> columns = parse_list(a.contact_columns);
    if (columns.size() != 3) {
        throw Error(ErrorKind::usage,
                    fmt::format("--contact-columns is '{}': expected I,J,FORCE, names of columns of {}",
                                a.contact_columns, a.contacts));
    }
    if (file.ids.empty()) {
        refuse(a.file, "has no column id: expected one, the contacts speak of ids");
    }
    std::optional<long> frame;
    if (a.foreign.frame != "last") {
        frame = std::stol(a.foreign.frame); // read once already
    }
    Wanted wanted;
    wanted.contacts = read_local_dump(a.contacts, {columns[0], columns[1], columns[2]}, file.ids, frame);
    const std::size_t pairs = wanted.contacts.size();
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (int i = 0; i < file.packing.disk_count(); ++i) {
            for (int axis = 0; axis < 2; ++axis) {
                if (gap<2>(file.packing, {kind, i, axis}) <= 0) {
                    wanted.contacts.push_back({kind, i, axis});
                }
            }
        }
    }
    wanted.words = fmt::format("{} pairs with a force in {}, {} overlaps with walls, without rattlers", pairs,
                               a.contacts, wanted.contacts.size() - pairs);
    std::sort(wanted.contacts.begin(), wanted.contacts.end());
    wanted.contacts = backbone_of(file.packing, wanted.contacts);
    return wanted;
}

std::string names_of(const std::vector<Contact>& contacts) {
    constexpr std::size_t most = 8;
    std::string text;
    for (std::size_t k = 0; k < std::min(most, contacts.size()); ++k) {
        text += " " + to_string<2>(contacts[k]);
    }
    return contacts.empty()         ? " none"
           : contacts.size() > most ? fmt::format("{} and {} more", text, contacts.size() - most)
                                    : text;
}

/// The contacts of a state that carry a force, as its certificate says.
std::vector<Contact> carrying(const State<2>& state, const Certification& truth) {
    std::vector<Contact> out;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        if (truth.structural_zero.size() != state.contacts.size() || truth.structural_zero[l] == 0) {
            out.push_back(state.contacts[l]);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// Words on the contacts of the vertex against those wanted; a failure where they must be the same and are not.
Result<std::string> compared(const Wanted& wanted, const std::vector<Contact>& found) {
    if (wanted.any) {
        return fmt::format("{} carry a force, as the nearest vertex has them", found.size());
    }
    std::vector<Contact> lost, added;
    std::set_difference(wanted.contacts.begin(), wanted.contacts.end(), found.begin(), found.end(),
                        std::back_inserter(lost));
    std::set_difference(found.begin(), found.end(), wanted.contacts.begin(), wanted.contacts.end(),
                        std::back_inserter(added));
    if (lost.empty() && added.empty()) {
        return fmt::format("{} carry a force, those of the file: {}", found.size(), wanted.words);
    }
    return failed(FailureKind::not_isostatic,
                  "the vertex downhill has other contacts than the file ({}): without{}; with{}; expected "
                  "the same, or --contacts nearest",
                  wanted.words, names_of(lost), names_of(added));
}

/// The vertex downhill of a packing of another program.
Result<Imported> from_foreign(const ImportArguments& a, ReadPacking& file) {
    const std::array<double, 2> stress = stresses_of(a);
    check_nearness(a.file, file.packing);
    Wanted wanted{true, {}, ""};
    if (a.threshold || a.contacts == "plateau") {
        auto below = wanted_below(a, file.packing);
        if (!below.ok()) {
            return below.failure();
        }
        wanted = below.value();
    } else if (a.contacts != "nearest") {
        wanted = wanted_by_forces(a, file);
    }
    Imported out;
    out.from = file.packing.q;
    file.packing.radius = with_jitter(file.packing.radius, a.jitter, a.seed);
    PreparationOptions options;
    options.seed = a.seed;
    options.stress = stress[0];
    options.ratio = stress[1] / stress[0];
    options.load = a.load == "true" ? LoadKind::true_stress : LoadKind::nominal;
    PreparationReport<2> report;
    auto vertex = find_vertex<2>(file.packing, options, report);
    if (!vertex.ok() && !report.candidate) {
        return vertex.failure();
    }
    out.state = vertex.ok() ? std::move(vertex.value()) : *report.candidate;
    out.truth = isostat::certify(out.state);
    auto words = compared(wanted, carrying(out.state, out.truth));
    if (!words.ok()) {
        return words.failure();
    }
    out.contacts = words.value();
    return out;
}

/// A crafted packing as it is: exact contacts, doubles next to its numbers, its load.
Result<Imported> from_crafted(const ImportArguments& a, const std::string& text) {
    const crafted::PackingFile file = crafted::parse_packing(text, a.file);
    const auto inspection = crafted::inspect(file.packing);
    if (!inspection.ok()) {
        return inspection.failure();
    }
    const crafted::Inspection& exact = inspection.value();
    if (exact.hyperstaticity != 0 || exact.mechanisms != 0) {
        return failed(exact.rank_exact == Verdict::proved ? FailureKind::not_isostatic : FailureKind::undecided,
                      "h = {}, k = {}: expected an isostatic packing, whose contacts determine it",
                      exact.hyperstaticity, exact.mechanisms);
    }
    Imported out;
    State<2>& state = out.state;
    state.packing = crafted::approximate(file.packing);
    state.contacts = exact.contacts;
    state.load.stress = stresses_of(a);
    state.load.kind = a.load == "true" ? LoadKind::true_stress : LoadKind::nominal;
    for (std::size_t b = 0; b < 2; ++b) {
        state.load.reference_length[b] = state.packing.length(static_cast<int>(b));
    }
    if (file.packing.load) {
        for (std::size_t b = 0; b < 2; ++b) {
            const double length = state.load.reference_length[1 - b];
            state.load.stress[b] = length > 0 ? file.packing.load->wall[b].to_double() / length : 0;
        }
        for (const exact::Number& force : file.packing.load->disk) {
            state.load.disk_force.push_back(force.to_double());
        }
    }
    out.from = state.packing.q;
    out.truth = isostat::certify(state);
    out.contacts = "those of the crafted packing, exactly";
    return out;
}

/// How far the true vertex may be from a place in the file: per disk, and at most for walls, backbone and rattlers.
struct Moves {
    std::vector<double> disk;
    std::vector<unsigned char> rattler;
    double walls = 0, backbone = 0, rattlers = 0;
};

Moves moves_of(const Imported& found) {
    const Packing<2>& packing = found.state.packing;
    const double radius = found.truth.claims.vertex ? found.truth.claims.vertex->radius : HUGE_VAL;
    constexpr double up = 1 + 0x1p-49; // of a difference, a sum and a hypotenuse, each rounded
    const auto way = [&](std::size_t k) { return (std::abs(packing.q[k] - found.from[k]) + radius) * up; };
    Moves moves;
    const std::size_t n = packing.radius.size();
    moves.rattler.assign(n, 1);
    for (const Contact& c : carrying(found.state, found.truth)) {
        moves.rattler[static_cast<std::size_t>(c.i)] = 0;
        if (c.kind == ContactKind::disk_disk) {
            moves.rattler[static_cast<std::size_t>(c.j)] = 0;
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        moves.disk.push_back(std::hypot(way(2 * i), way(2 * i + 1)) * up);
        double& largest = moves.rattler[i] != 0 ? moves.rattlers : moves.backbone;
        largest = std::max(largest, moves.disk[i]);
    }
    moves.walls = std::max(way(2 * n), way(2 * n + 1));
    return moves;
}

std::string moves_csv(const Imported& found, const Moves& moves) {
    std::string text = "disk,x,y,moved,rattler\n";
    for (std::size_t i = 0; i < moves.disk.size(); ++i) {
        text += fmt::format("{},{},{},{},{}\n", i, found.state.packing.q[2 * i], found.state.packing.q[2 * i + 1],
                            rounded_up(moves.disk[i], 6), moves.rattler[i]);
    }
    return text;
}

Json provenance_of(const ImportArguments& a, const std::string& format, const Imported& found, const Moves& moves) {
    Json out;
    out["program"] = program_name();
    out["command"] = a.common.command;
    out["imported_from"] = a.file;
    out["file_format"] = format;
    out["contacts"] = found.contacts;
    out["seed"] = a.seed;
    out["jitter"] = a.jitter;
    out["moved"] = {
        {"backbone", number(moves.backbone)}, {"rattlers", number(moves.rattlers)}, {"walls", number(moves.walls)}};
    return out;
}

void print_import(const ImportArguments& a, const ReadPacking& file, const Imported& found, const Moves& moves) {
    const State<2>& state = found.state;
    fmt::print("file      {} ({})\n", a.file, file.format);
    for (const std::string& note : file.notes) {
        fmt::print("          {}\n", note);
    }
    const auto rattlers = std::count(moves.rattler.begin(), moves.rattler.end(), 1);
    fmt::print("contacts  {}\n", found.contacts);
    fmt::print("moved     disks with a force at most {}, walls {}", rounded_up(moves.backbone, 3),
               rounded_up(moves.walls, 3));
    fmt::print("{}\n", rattlers == 0 ? ""
                                     : fmt::format(", {} rattlers, which rest on infinitesimal loads, {}", rattlers,
                                                   rounded_up(moves.rattlers, 3)));
    fmt::print("load      sigma = ({}, {}), {}\n", state.load.stress[0], state.load.stress[1],
               state.load.kind == LoadKind::nominal ? "nominal" : "true stresses");
    fmt::print("{:<9} {}: {} disks, {} contacts, solid fraction {:.6f}\n", to_string(found.truth.verdict), a.output,
               state.packing.disk_count(), state.contacts.size(), state.packing.solid_fraction());
}

} // namespace

int import(const ImportArguments& arguments) {
    ImportArguments a = arguments;
    const std::string text = read_text(a.file);
    const std::string format = a.foreign.format.empty() ? recognise_format(text) : a.foreign.format;
    const bool own = format == "state" || format == "vertex";
    if (own && a.jitter == 0) {
        refuse(a.file, fmt::format("is a {} of this program: expected a packing of another one, or --jitter; isostat "
                                   "convert copies it",
                                   format));
    }
    if (own) {
        keep_load(a);
    }
    const bool crafted = format == "packing";
    if (crafted && a.jitter != 0) {
        refuse(a.file,
               fmt::format("is a crafted packing, whose contacts are those of its exact radii: expected no --jitter, "
                           "it is {}",
                           a.jitter));
    }
    if (!crafted && !own && a.foreign.walls.empty()) {
        a.foreign.walls = "box";
    }
    if (!crafted && !own && a.foreign.walls != "box") {
        throw Error(ErrorKind::usage,
                    fmt::format("--walls is '{}': expected box, two fixed and two movable walls", a.foreign.walls));
    }
    ReadPacking file = read_any_packing(a.file, a.foreign);
    auto found = crafted ? from_crafted(a, text) : from_foreign(a, file);
    const bool refuted = found.ok() && found.value().truth.verdict == Verdict::refuted;
    if (!found.ok() || refuted) {
        const std::string why = found.ok() ? found.value().truth.refuted.front() : found.failure().message();
        fmt::print(stderr, "isostat: {}: {}\n", a.file, why);
        return refuted ? failed : status_of(found.failure().kind);
    }
    Imported& imported = found.value();
    const Moves moves = moves_of(imported);
    const Json provenance = provenance_of(a, format, imported, moves);
    imported.state.provenance = json::dumped(provenance);
    if (imported.truth.verdict != Verdict::proved) {
        fmt::print(stderr, "isostat: {}: {}\n", a.file, fmt::join(imported.truth.claims.undecided, "; "));
    }
    if (!imported.truth.claims.vertex || !imported.truth.claims.forces) {
        return undecided;
    }
    write_state<2>(a.output, imported.state);
    if (!a.moved.empty()) {
        write_atomically(a.moved, moves_csv(imported, moves));
    }
    if (a.common.json) {
        Json object = provenance;
        object["state"] = a.output;
        object["notes"] = file.notes;
        object["disks"] = imported.state.packing.disk_count();
        object["verdict"] = to_string(imported.truth.verdict);
        print_json(object);
    } else {
        print_import(a, file, imported, moves);
    }
    return status_of(imported.truth.verdict);
}

} // namespace isostat::cli
