#include "cli/common.hpp"

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "io/json.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace isostat::cli {

std::string program_name() {
    return "isostat " ISOSTAT_VERSION;
}

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

void print_json(const Json& object) {
    fmt::print("{}\n", json::dumped(object));
}

int status_of(FailureKind kind) {
    switch (kind) {
    case FailureKind::tie:
    case FailureKind::undecided: return undecided;
    case FailureKind::interrupted: return interrupted;
    default: return failed;
    }
}

int status_of(Verdict verdict) {
    switch (verdict) {
    case Verdict::proved: return done;
    case Verdict::refuted: return failed;
    case Verdict::undecided: return undecided;
    }
    return undecided;
}

State<2> load_start(const Scene& scene) {
    const std::string source = scene.start.string();
    State<2> state = read_state<2>(scene.start).state;
    if (scene.load_kind) {
        state.load.kind = *scene.load_kind;
    }
    if (scene.infinitesimal_seed) {
        state.load.infinitesimal = generic_infinitesimal<2>(state.packing.radius, *scene.infinitesimal_seed);
    }
    state.equilibrium = 0;
    state.perturbation.reset(); // a run has its own
    snap_to_grid(state.packing);
    for (std::size_t a = 0; a < 2; ++a) {
        if (!(state.load.stress[a] > 0)) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: load.stress[{}] is {}: expected a positive stress",
                                                          source, a, state.load.stress[a]));
        }
    }
    check_start(state, source, scene.run.ties == TiePolicy::perturb);
    const auto loaded = static_cast<std::size_t>(state.load.loaded_axis);
    check_programme(scene, state.load.stress[loaded] / state.load.stress[1 - loaded]);
    return state;
}

Result<State<2>> prepare_start(const Scene& scene, const std::string& command, bool quiet,
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
            fmt::print("preparation: {}\n", stage);
            std::fflush(stdout);
        }
        line.show(fmt::format("preparation: {}: {:3.0f} % {}", progress.stage, 100 * progress.fraction, progress.text));
    };
    PreparationReport<2> report;
    Result<State<2>> prepared = isostat::prepare<2>(options, report);
    line.clear();
    if (!quiet) {
        fmt::print("{:<22} {:>9} {:>10} {:>9} {:>10} {:>10}\n", "stage", "seconds", "iterations", "contacts", "phi",
                   "residual");
        for (const PreparationStage& done : report.stages) {
            fmt::print("{:<22} {:>9.2f} {:>10} {:>9} {:>10.6f} {:>10.2e}{}\n", done.name, done.seconds, done.iterations,
                       done.contacts, done.solid_fraction, done.residual, done.completed ? "" : "  (goal not reached)");
        }
        std::fflush(stdout);
    }
    if (!prepared.ok()) {
        const std::string last_stage = report.stages.empty() ? "the start" : report.stages.back().name;
        std::string message = fmt::format("preparation failed at {}: {}: {}", last_stage,
                                          to_string(prepared.failure().kind), prepared.failure().message);
        if (report.last) {
            write_packing<2>(failed_path, *report.last, message);
            message += fmt::format(" (what was reached is in {})", failed_path.string());
        }
        return Failure{prepared.failure().kind, message};
    }
    Json provenance;
    provenance["program"] = program_name();
    provenance["command"] = command;
    provenance["scene_file"] = scene.file;
    provenance["settings"] = Json::parse(settings_json(scene));
    provenance["infinitesimal_seed"] = report.infinitesimal_seed;
    provenance["linear_programmes"] = report.programmes;
    provenance["pivots"] = report.pivots;
    prepared.value().provenance = json::dumped(provenance);
    return prepared;
}

} // namespace isostat::cli
