#include "cli/common.hpp"

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "io/json.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace isostat::cli {

std::string program_name() {
    return "isostat " ISOSTAT_VERSION;
}

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

void print_json(const Json& object) {
    say_json(json::dumped(object) + "\n");
}

namespace {

std::string rounded(double value, int digits, const char* format) {
    if (!std::isfinite(value)) {
        return fmt::format("{}", value);
    }
    mpfr_t exact;
    mpfr_init2(exact, 53);
    mpfr_set_d(exact, value, MPFR_RNDN);
    char* text = nullptr;
    mpfr_asprintf(&text, format, digits, exact);
    std::string result(text);
    mpfr_free_str(text);
    mpfr_clear(exact);
    return result;
}

} // namespace

std::string rounded_up(double value, int digits) {
    return rounded(value, digits, "%.*RUg");
}

std::string rounded_down(double value, int digits) {
    return rounded(value, digits, "%.*RDg");
}

std::string with_bound(double lower, double upper) {
    constexpr int enough = 17; // tells every double
    const double middle = 0.5 * lower + 0.5 * upper;
    for (int digits = 12;; ++digits) {
        const std::string shown = fmt::format("{:.{}g}", middle, digits);
        const double value = std::strtod(shown.c_str(), nullptr);
        // The text itself is off its double by half a unit of the last place.
        const double off = std::abs(value) * 0x1p-53;
        const double bound = (std::max(upper - value, value - lower) + off) * (1 + 0x1p-50);
        if (digits == enough || bound <= 0.75 * (upper - lower)) {
            return fmt::format("{} +- {}", shown, rounded_up(bound, 2));
        }
    }
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
            say("preparation: {}\n", stage);
            std::fflush(stdout);
        }
        line.show(fmt::format("preparation: {}: {:3.0f} % {}", progress.stage, 100 * progress.fraction, progress.text));
    };
    PreparationReport<2> report;
    Result<State<2>> prepared = isostat::prepare<2>(options, report);
    line.clear();
    std::string tied; // what the run has to settle, as far as doubles know
    const bool settles = scene.run.at_first_order() && !scene.programme.empty();
    if (!prepared.ok() && prepared.failure().kind == FailureKind::tie && report.candidate && settles) {
        tied = prepared.failure().message();
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
        std::string message = fmt::format("preparation failed at {}: {}: {}", last_stage,
                                          to_string(prepared.failure().kind), prepared.failure().message());
        if (report.last) {
            message += advice(scene, prepared.failure(), *report.last);
            write_packing<2>(failed_path, *report.last, message);
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
