#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/terminal.hpp"
#include "io/json.hpp"

#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace isostat::cli {

int convert(const ConvertArguments& arguments) {
    StateFile<2> file = read_state<2>(arguments.input);
    Json provenance = file.state.provenance.empty() ? Json::object() : Json::parse(file.state.provenance);
    if (!provenance.contains("program")) {
        provenance["program"] = program_name();
        provenance["command"] = arguments.common.command;
    }
    file.state.provenance = json::dumped(provenance);
    write_state<2>(arguments.output, file.state, file.forces);
    const int disks = file.state.packing.disk_count();
    if (arguments.common.json) {
        print_json(Json{{"state", arguments.output}, {"disks", disks}, {"contacts", file.state.contacts.size()}});
    } else {
        say("{}: {} disks, {} contacts\n", arguments.output, disks, file.state.contacts.size());
    }
    return done;
}

} // namespace isostat::cli
