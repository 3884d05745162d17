#include "cli/common.hpp"

#include "cli/commands.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "io/json.hpp"

#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace isostat::cli {

std::string program_name() {
    return "isostat " ISOSTAT_VERSION;
}

void print(answers::Answer answer, const Common& common, const char* format) {
    if (!common.json) {
        say_lines(answer.text);
        return;
    }
    Json object = Json::object();
    if (format != nullptr) {
        object = {{"format", format}, {"program", program_name()}, {"command", common.command}};
    }
    for (auto&& [key, value] : answer.json.items()) { // `update` would copy
        object[key] = std::move(value);
    }
    print_json(object);
}

void print_json(const Json& object) {
    say_json(json::dumped(object) + "\n");
}

int status_of(FailureKind kind) {
    switch (kind) {
    case FailureKind::tie:
    case FailureKind::undecided: return undecided;
    case FailureKind::interrupted: return interrupted;
    default: return failed;
    }
}

Result<State> prepare_start(const Scene& scene, const std::string& command, bool quiet,
                            const std::filesystem::path& failed_path) {
    StatusLine line(quiet);
    PreparationOptions options = scene.preparation;
    options.stop = &stop_flag();
    std::string stage;
    options.progress = [&](const PreparationProgress& progress) {
        if (quiet) {
            return;
        }
        if (progress.stage != stage) {
            stage = progress.stage;
            line.clear();
            say("preparation: {}\n", stage);
            std::fflush(stdout);
        }
        line.show(fmt::format("preparation: {}: {:3.0f} % {}", progress.stage, 100 * progress.fraction, progress.text));
    };
    PreparationReport report;
    Result<State> prepared = isostat::prepare(options, report);
    line.clear();
    std::string tied; // ties that the run has to settle, judged in double
    const bool settles = scene.run.at_first_order() && !scene.programme.empty();
    if (!prepared.ok() && prepared.failure().kind == FailureKind::tie && report.candidate && settles) {
        tied = prepared.failure().message(options.dimension);
        prepared = std::move(*report.candidate);
    }
    if (!quiet) {
        say("{:<22} {:>9} {:>10} {:>9} {:>10} {:>10}\n", "stage", "seconds", "iterations", "contacts", "phi",
            "residual");
        for (const PreparationStage& done : report.stages) {
            say("{:<22} {:>9.2f} {:>10} {:>9} {:>10.6f} {:>10.2e}{}\n", done.name, done.seconds, done.iterations,
                done.contacts, done.solid_fraction, done.residual, done.completed ? "" : "  (goal not reached)");
        }
        std::fflush(stdout);
    }
    if (!prepared.ok()) {
        const std::string last_stage = report.stages.empty() ? "the start" : report.stages.back().name;
        std::string message =
            fmt::format("preparation failed at {}: {}: {}", last_stage, to_string(prepared.failure().kind),
                        prepared.failure().message(options.dimension));
        if (report.last) {
            message += advice(scene, prepared.failure(), *report.last);
            write_packing(failed_path, *report.last, message);
            message += fmt::format(" (what was reached is in {})", failed_path.string());
        }
        return Failure{prepared.failure().kind, message};
    }
    Json provenance = Json::parse(provenance_of(scene, program_name(), command, report));
    if (!tied.empty()) {
        provenance["ties_left_to_the_run"] = tied;
    }
    prepared.value().provenance = provenance.dump();
    return prepared;
}

} // namespace isostat::cli
