#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "core/refuse.hpp"
#include "core/work.hpp"
#include "io/files.hpp"
#include "io/json.hpp"
#include "report/run_report.hpp"

#include <isostat/io/run_directory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace isostat::cli {

namespace {

constexpr std::array exit_statuses{done, failed, undecided, interrupted}; ///< of `RunStatus`

/// The start of the run: the stored one, a file or a preparation.
Result<State> start_of(const Scene& scene, const std::optional<State>& from_file, RunDirectory& directory,
                       const std::string& command, bool quiet) {
    if (const auto stored = directory.start()) {
        return *stored;
    }
    if (from_file) {
        directory.store_start(*from_file);
        return *from_file;
    }
    auto prepared = prepare_start(scene, command, quiet, directory.path() / "preparation_failed.json");
    if (prepared.ok()) {
        directory.store_start(prepared.value());
    }
    return prepared;
}

/// The distance by which `start_from_file` moved the start.
double moved_to_grid(const State& start) {
    const Json provenance = start.provenance.empty() ? Json::object() : Json::parse(start.provenance);
    return provenance.is_object() ? provenance.value("moved_to_grid", 0.0) : 0.0;
}

/// work.json: the work of this process, added to that of earlier processes on the same run.
void record_work(const std::filesystem::path& path) {
    Json counts = Json::object();
    if (std::filesystem::exists(path)) {
        const Json old = Json::parse(read_text(path), nullptr, false);
        if (old.is_object() && old.contains("counts") && old["counts"].is_object()) {
            counts = old["counts"];
        }
    }
    const auto work = work_done();
    for (std::size_t k = 0; k < work_kinds; ++k) {
        const char* name = to_string(static_cast<Work>(k));
        constexpr long most = 1L << 53; // the file may hold any number
        const long said = counts.contains(name) && counts[name].is_number_integer() ? counts[name].get<long>() : 0;
        const long before = said >= 0 && said < most ? said : 0;
        counts[name] = before + work[k];
    }
    Json object;
    object["format"] = "isostat-work";
    object["version"] = 1;
    object["counts"] = counts;
    write_atomically(path, json::dumped(object, 2) + "\n");
}

/// Results that were requested and neither proved nor refuted, in words; empty: none.
std::string left_open(const RunCounters& counters) {
    std::string words;
    const auto add = [&words](long count, const char* what) {
        if (count > 0) {
            words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, what);
        }
    };
    add(counters.states.undecided, "of the certificates of equilibria are undecided");
    add(counters.arcs.undecided, "of the certificates of arcs are undecided");
    return words;
}

void draw(const Scene& scene, const RunDirectory& directory, bool quiet) {
    ReportOptions options;
    options.vtk = scene.vtk;
    options.pictures = scene.pictures;
    const ReportResult report = report_run(directory.path(), directory.path() / "figures", options);
    if (quiet) {
        return;
    }
    say_lines("\n" + report.text + "\n");
    for (const std::string& note : report.notes) {
        if (std::ranges::count(directory.notes(), note) == 0) {
            say("{}\n", note);
        }
    }
    say("figures: {}\n", (directory.path() / "figures").string());
}

/// Prints notes on the start of a run.
void announce(const std::optional<State>& from_file) {
    if (const double moved = from_file ? moved_to_grid(*from_file) : 0; moved > 0) {
        say("start: coordinates of what can move are put on a grid, each moved by at most {}\n", rounded_up(moved, 3));
    }
}

/// The last line that a run prints.
std::string last_line(const SceneEnding& ending, const RunCounters& counters) {
    return fmt::format("{}{}{}: {} arcs, {} equilibria, {}", to_string(ending.status),
                       ending.reason.empty() ? "" : ": ", ending.reason, counters.steps, counters.equilibria,
                       clock_text(counters.seconds));
}

/// Prints what was not as requested, on standard error. `open`: from `left_open`.
void complain(const RunArguments& arguments, const SceneEnding& ending, const std::string& open) {
    if (!open.empty()) {
        say(stderr, "isostat: {}: {}\n", arguments.output, open);
    }
    if (ending.status != RunStatus::completed) {
        say(stderr, "isostat: {}: {}: {}\n", arguments.output, to_string(ending.status), ending.reason);
    }
    if (ending.status == RunStatus::interrupted) {
        say(stderr, "isostat: to go on: isostat run {} -o {} --resume\n", arguments.scene, arguments.output);
    }
}

} // namespace

int run(const RunArguments& arguments) {
    const Scene scene = read_scene(arguments.scene);
    if (scene.programme.empty()) {
        refuse(arguments.scene, "has no [[programme]]: expected at least one segment to run");
    }
    const bool quiet = arguments.common.quiet || arguments.common.json;
    std::optional<State> from_file;
    if (!scene.start.empty() && !arguments.resume) {
        from_file = start_from_file(scene); // bad input leaves no folder
    }
    catch_interrupts(); // until here a signal ends the program, even while it waits for an input pipe
    RunCounters counters;
    RunDirectory directory(arguments.output, header_of(scene, program_name(), arguments.common.command),
                           mode_of(arguments), counters);
    if (!scene.start.empty() && !from_file && !directory.start()) {
        from_file = start_from_file(scene);
    }
    if (!quiet && arguments.resume) {
        const auto& point = directory.checkpoint();
        say("resuming {} (it was {}) {}\n", arguments.output, directory.previous_status(),
            point ? fmt::format("after equilibrium {}", point->state.equilibrium) : "from its start");
    }
    for (const std::string& note : directory.notes()) {
        say(stderr, "isostat: {}: {}\n", arguments.output, note);
    }
    const auto start = start_of(scene, from_file, directory, arguments.common.command, quiet);
    if (!quiet) {
        announce(from_file);
    }
    SceneEnding ending;
    if (start.ok()) {
        RunTable table(scene.programme, quiet);
        ending = play_scene(scene, start.value(), directory, program_name(), counters, stop_flag(), table);
        table.end();
    } else {
        ending = ending_of(start.failure(), "", scene.preparation.dimension);
    }
    directory.finish(ending.status, ending.reason);
    if (arguments.common.json) {
        say_json(directory.summary());
    } else if (!quiet) {
        say("{}\n", last_line(ending, counters));
    }
    const std::string open = left_open(counters);
    complain(arguments, ending, open);
    if ((scene.pictures || scene.vtk) && ending.status != RunStatus::interrupted && start.ok()) {
        draw(scene, directory, quiet);
    }
    record_work(directory.path() / "work.json");
    return ending.status == RunStatus::completed && !open.empty()
               ? undecided
               : exit_statuses.at(static_cast<std::size_t>(ending.status));
}

} // namespace isostat::cli
