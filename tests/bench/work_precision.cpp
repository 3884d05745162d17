// Error against run time of events, stresses and the two usual shortcuts (soft grains, small displacements), against a
// certified reference of 320 bits. Static forces by rung of precision: bench_precision. Prints tables (Markdown);
// writes tables.md, one CSV per table and, with gnuplot, figures. The status is 1 when an error is above its proved
// bound.
//   bench_work_precision [--quick] [--part events|soft|small] [folder]      --quick: seconds, n = 36 and 64

#include "bench/work_precision/report.hpp"

#include <fmt/format.h>

#include <exception>
#include <string>

int main(int argc, char** argv) {
    work_precision::Settings settings;
    std::string part;
    for (int k = 1; k < argc; ++k) {
        const std::string argument = argv[k];
        if (argument == "--quick") {
            settings.quick = true;
        } else if (argument == "--part" && k + 1 < argc) {
            part = argv[++k];
        } else if (argument.starts_with("-")) {
            fmt::print(stderr, "usage: bench_work_precision [--quick] [--part events|soft|small] [folder]\n");
            return 64;
        } else {
            settings.folder = argument;
        }
    }
    if (settings.quick) {
        settings.sizes = {36, 64};
        settings.seeds = {1};
        settings.equilibria = 5;
        settings.drift_equilibria = 8;
        settings.soft_equilibria = 3;
        settings.stiffness_ratios = {1e2, 1e3, 1e4};
    } else {
        settings.sizes = {100, 400};
        settings.seeds = {1, 2, 3};
        settings.stiffness_ratios = {1e2, 1e3, 1e4, 1e5, 1e6};
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
        holds = (!wanted("soft") || work_precision::soft_grains(settings)) && holds;
        return holds ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
