#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/terminal.hpp"
#include "core/refuse.hpp"
#include "io/files.hpp"

#include <isostat/io/state_file.hpp>

#include <cstdio>

namespace isostat::cli {

namespace {

/// Checks before a long computation that its output, and the file of a failure next to it, can be written.
void check_writable(const PrepareArguments& a) {
    check_output(a.output, "\"isostat-state\"", {a.scene});
    check_output(a.output + ".failed.json", "\"isostat-packing\"", {a.scene});
    check_directory_of(a.output);
}

} // namespace

int prepare(const PrepareArguments& arguments) {
    const Scene scene = read_scene(arguments.scene);
    if (!scene.start.empty()) {
        refuse(arguments.scene,
               "file in [packing] is {}: there is nothing to prepare, expected disks, radii or radii_file, or spheres",
               scene.start.string());
    }
    check_writable(arguments);
    catch_interrupts();
    const bool quiet = arguments.common.quiet || arguments.common.json;
    const auto prepared = prepare_start(scene, arguments.common.command, quiet, arguments.output + ".failed.json");
    if (!prepared.ok()) {
        say(stderr, "isostat: {}\n", prepared.failure().message(scene.preparation.dimension));
        if (arguments.common.json) {
            print_json(Json{{"status", to_string(prepared.failure().kind)},
                            {"reason", prepared.failure().message(scene.preparation.dimension)}});
        }
        return status_of(prepared.failure().kind);
    }
    const State& state = prepared.value();
    write_state(arguments.output, state);
    if (arguments.common.json) {
        Json object;
        object["status"] = "completed";
        object["state"] = arguments.output;
        object["disks"] = state.packing.disk_count();
        object["contacts"] = state.contacts.size();
        for (int a = 0; a < state.packing.dimension; ++a) {
            object["length"].push_back(state.packing.length(a));
        }
        object["solid_fraction"] = or_null(state.packing.solid_fraction());
        print_json(object);
    } else if (!quiet) {
        say("{}: {} {}, {} contacts, solid fraction {:.6f}\n", arguments.output, state.packing.disk_count(),
            state.packing.dimension == plane ? "disks" : "spheres", state.contacts.size(),
            state.packing.solid_fraction());
    }
    return done;
}

} // namespace isostat::cli
