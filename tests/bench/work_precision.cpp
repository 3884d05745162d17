// Error against run time of events, stresses and a usual shortcut (small displacements), against a certified reference
// of 320 bits. Static forces by rung of precision: bench_precision. Prints tables (Markdown);
// writes tables.md, one CSV per table and, with gnuplot, figures. The status is 1 when an error is above its proved
// bound.
//   bench_work_precision [--json FILE] [--quick] [--part events|small] [folder]      --quick: seconds, n = 36 and
//   64

#include "bench/work_precision/report.hpp"

#include <fmt/format.h>

#include <exception>

int main(int argc, char** argv) {
    work_precision::Settings settings;
    std::string part;
    std::string folder = ".";
    bench::Program program("bench_work_precision", "error against run time of events, stresses and a usual shortcut");
    program.flag("--quick", settings.quick, "seconds, n = 36 and 64");
    program.option("--part", part, "events or small: only that part");
    program.option("folder", folder, "for tables and figures");
    program.parse(argc, argv);
    settings.program = &program;
    settings.folder = folder;
    if (settings.quick) {
        settings.sizes = {36, 64};
        settings.seeds = {1};
        settings.equilibria = 5;
        settings.drift_equilibria = 8;
    } else {
        settings.sizes = {100, 400};
        settings.seeds = {1, 2, 3};
    }
    std::filesystem::create_directories(settings.folder);
    if (part.empty()) {
        std::filesystem::remove(settings.folder / "tables.md");
    }
    try {
        bool holds = true;
        const auto wanted = [&](const char* name) { return part.empty() || part == name; };
        holds = (!wanted("events") || work_precision::events_and_stresses(settings)) && holds;
        holds = (!wanted("small") || work_precision::small_displacements(settings)) && holds;
        return program.finish(holds);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
