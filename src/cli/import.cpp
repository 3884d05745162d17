#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/import_moves.hpp"
#include "cli/import_source.hpp"
#include "cli/read_packing.hpp"
#include "io/json.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/files.hpp>
#include <isostat/io/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace isostat::cli {

namespace {

/// What the arguments leave open, by what the file is. Refuses what would do nothing, or cannot be done.
void complete(ImportArguments& a, const std::string& format) {
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
    complete(a, format);
    ReadPacking file = read_any_packing(a.file, a.foreign);
    auto found = format == "packing" ? from_crafted(a, text) : from_foreign(a, file);
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
