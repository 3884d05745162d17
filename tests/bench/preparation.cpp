// CPU and wall-clock time by stage of the preparation, with what it made, and the growth of the whole with n. The whole
// in units of one KLU analysis + factorisation of the matrix it ends with. The status is 1 when a vertex was not
// proved. Usage:
//   bench_preparation [--json FILE] [--repeats R] [--seed S] [n ...]        default: 3 repeats, 100 400 1936
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"

#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

using namespace isostat;
using bench::Sample;

namespace {

struct Stage {
    Sample wall, cpu;
    PreparationStage last;
};

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sizes{"100", "400", "1936"};
    int repeats = 3, seed = 1;
    bench::Program program("bench_preparation", "seconds of the preparation, stage by stage");
    program.option("--repeats", repeats, "preparations of each size");
    program.option("--seed", seed, "of radii and positions");
    program.words("sizes", sizes, "numbers of disks");
    program.parse(argc, argv);
    bench::Table stages("stages", "Stages, median (range):",
                        {{"n", "n", ""},
                         {"stage", "stage", ""},
                         {"wall", "wall, s", "s wall", "{:.3f}"},
                         {"cpu", "CPU, s", "s, all threads", "{:.3f}"},
                         {"iterations", "iterations", ""},
                         {"solid_fraction", "φ", "", "{:.4f}"},
                         {"contacts", "contacts", ""},
                         {"residual", "residual", "", "{:.1e}"},
                         {"completed", "completed", ""}});
    bench::Table table("preparation", "From random disks to the proved vertex, median (range):",
                       {{"n", "n", ""},
                        {"wall", "wall, s", "s wall", "{:.2f}"},
                        {"cpu", "CPU, s", "s, all threads", "{:.2f}"},
                        {"per_disk", "CPU per disk, ms", "ms", "{:.3f}"},
                        {"klu", "CPU / KLU analysis + factorisation", "KLU", "{:.0f}"},
                        {"exponent", "CPU grows as n to the power of", "", "{:.2f}"},
                        {"programmes", "linear programmes", ""},
                        {"pivots", "pivots", ""},
                        {"solid_fraction", "φ", "", "{:.4f}"},
                        {"rattlers", "rattlers, %", "%", "{:.1f}"},
                        {"min_force", "smallest force", "", "{:.1e}"},
                        {"min_gap", "smallest gap", "", "{:.1e}"},
                        {"sigma_min", "σ_min at least", "", "{:.1e}"}});
    bool good = true;
    double before = 0;
    int size_before = 0;
    for (const std::string& word : sizes) {
        const int n = std::atoi(word.c_str());
        PreparationOptions options{.disks = n, .seed = static_cast<std::uint64_t>(seed)};
        PreparationReport report;
        std::vector<Stage> seen;
        Sample wall, cpu;
        double klu = 0;
        for (int repeat = 0; repeat < repeats; ++repeat) {
            report = {};
            const double wall_begin = bench::wall_milliseconds();
            const double begin = bench::process_milliseconds(); // the preparation may use both cores
            const auto result = prepare(options, report);
            cpu.add(1e-3 * (bench::process_milliseconds() - begin));
            wall.add(1e-3 * (bench::wall_milliseconds() - wall_begin));
            if (!result.ok()) {
                fmt::print(stderr, "{} disks: {}\n", n, result.failure().message());
                good = false;
            } else if (repeat == 0) {
                const auto matrix = bench::matrix_of(result.value());
                klu = bench::milliseconds([&] { bench::klu(matrix); }).median();
            }
            seen.resize(report.stages.size());
            for (std::size_t k = 0; k < seen.size(); ++k) {
                seen[k].wall.add(report.stages[k].seconds);
                seen[k].cpu.add(report.stages[k].cpu_seconds);
                seen[k].last = report.stages[k];
            }
        }
        for (const Stage& stage : seen) {
            stages.add({static_cast<long>(n), stage.last.name, stage.wall, stage.cpu, stage.last.iterations,
                        stage.last.solid_fraction, static_cast<long>(stage.last.contacts), stage.last.residual,
                        stage.last.completed});
        }
        bench::Cell exponent;
        if (size_before > 0) {
            exponent = std::log(cpu.median() / before) / std::log(static_cast<double>(n) / size_before);
        }
        before = cpu.median();
        size_before = n;
        table.add({static_cast<long>(n), wall, cpu, cpu.over(1e-3 * n), cpu.over(1e-3 * klu), exponent,
                   static_cast<long>(report.programmes), report.pivots, report.solid_fraction,
                   100.0 * report.rattlers / n, report.min_force, report.min_gap, report.sigma_min_bound});
    }
    program.show(stages);
    program.show(table);
    return program.finish(good);
}
