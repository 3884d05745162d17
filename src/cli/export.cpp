#include "certificate/averages.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/folders.hpp"
#include "report/picture.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <filesystem>

namespace isostat::cli {

namespace {

namespace fs = std::filesystem;

/// Text in the first lines of a file of this format.
std::string mark_of(const std::string& format, int dimension) {
    return format == "xyz"   ? "\nLattice=\""
           : format == "csv" ? (dimension == plane ? "\nid,x,y,r" : "\nid,x,y,z,r")
                             : " of isostat ";
}

std::string format_of(const ExportArguments& a) {
    if (!a.format.empty()) {
        return a.format;
    }
    const std::string end = fs::path(a.output).extension().string();
    for (const auto& [extension, format] : {std::pair{".data", "lammps-data"},
                                            {".lmp", "lammps-data"},
                                            {".xyz", "xyz"},
                                            {".csv", "csv"},
                                            {".vtk", "vtk"}}) {
        if (end == extension) {
            return format;
        }
    }
    refuse(ErrorKind::usage, "--output is '{}': expected a name that ends in .data, .xyz, .csv or .vtk, or --format",
           a.output);
}

/// The stored states of a run in their order, or the one state.
std::vector<fs::path> states_of(const std::string& input) {
    if (!fs::is_directory(input)) {
        return {input};
    }
    std::vector<fs::path> files;
    for (const std::string& name : content_of(input, run_folder).files) {
        if (name.starts_with("states/eq_")) {
            files.push_back(fs::path(input) / name);
        }
    }
    if (files.empty()) {
        refuse(input, "has no states/eq_*.json: expected the folder of a run, or a state");
    }
    return files;
}

std::string series_text(const std::vector<fs::path>& files) {
    std::string text;
    std::vector<double> first;
    for (const fs::path& file : files) {
        const State state = read_any_state(file, Dimensions::any).state;
        const Packing& packing = state.packing;
        if (first.empty()) {
            first = packing.q;
        }
        std::vector<double> displacement;
        for (std::size_t k = 0; files.size() > 1 && k < first.size() && k < packing.q.size(); ++k) {
            displacement.push_back(packing.q[k] - first[k]);
        }
        text += xyz_text(packing, displacement, contacts_of_grains(state));
    }
    return text;
}

/// The forces in the file, or the proved ones if it has none; empty if neither is known.
std::vector<double> forces_of(const StateFile& file) {
    std::vector<double> forces = file.forces;
    if (forces.empty()) {
        for (const Interval& f : certify(file.state).finite) {
            forces.push_back(0.5 * f.lower + 0.5 * f.upper);
        }
    }
    return forces;
}

} // namespace

int export_states(const ExportArguments& arguments) {
    const std::string format = format_of(arguments);
    std::vector<fs::path> files = states_of(arguments.input);
    const StateFile last = read_any_state(files.back(), Dimensions::any);
    const std::string mark = mark_of(format, last.state.packing.dimension);
    for (const fs::path& file : files) {
        check_output(arguments.output, mark, {file});
    }
    std::string text;
    if (format == "xyz") {
        text = series_text(files);
    } else {
        files = {files.back()};
        const std::string title = fmt::format("{} of {}", files.front().filename().string(), program_name());
        text = format == "csv"   ? csv_text(last.state.packing, contacts_of_grains(last.state))
               : format == "vtk" ? vtk_text(last.state, forces_of(last), title)
                                 : lammps_data_text(last.state.packing, title);
    }
    write_output(arguments.output, text, mark);
    if (arguments.common.json) {
        print_json(Json{{"file", arguments.output}, {"format", format}, {"states", files.size()}});
    } else {
        say("{}: {}, {} state{}{}\n", arguments.output, format, files.size(), files.size() == 1 ? "" : "s",
            fs::is_directory(arguments.input) ? ", of those that are stored (states_every = 1 in a scene stores all)"
                                              : "");
    }
    return done;
}

} // namespace isostat::cli
