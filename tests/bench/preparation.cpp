// Seconds by stage of the preparation, with what it made: bench_preparation [n ...]. Default sizes 100, 400, 1936.

#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <cstdlib>

int main(int argc, char** argv) {
    std::vector<int> sizes;
    for (int k = 1; k < argc; ++k) {
        sizes.push_back(std::atoi(argv[k]));
    }
    if (sizes.empty()) {
        sizes = {100, 400, 1936};
    }
    int failures = 0;
    for (const int n : sizes) {
        isostat::PreparationOptions options;
        options.disks = n;
        isostat::PreparationReport<2> report;
        const auto result = isostat::prepare<2>(options, report);
        fmt::print("n = {}: {}\n", n, result.ok() ? "proved vertex" : result.failure().message);
        double total = 0;
        fmt::print("  {:<22}{:>9}{:>9}{:>11}{:>9}{:>10}{:>10}\n", "stage", "wall s", "cpu s", "iterations", "phi",
                   "contacts", "residual");
        for (const isostat::PreparationStage& stage : report.stages) {
            fmt::print("  {:<22}{:>9.3f}{:>9.3f}{:>11}{:>9.4f}{:>10}{:>10.1e}{}\n", stage.name, stage.seconds,
                       stage.cpu_seconds, stage.iterations, stage.solid_fraction, stage.contacts, stage.residual,
                       stage.completed ? "" : "  (not completed)");
            total += stage.seconds;
        }
        fmt::print("  total {:.2f} s; {} programmes, {} pivots; phi {:.4f}, rattlers {} ({:.1f} %), smallest force "
                   "{:.2e}, smallest gap {:.2e}, "
                   "sigma_min >= {:.1e}\n",
                   total, report.programmes, report.pivots, report.solid_fraction, report.rattlers,
                   100.0 * report.rattlers / n, report.min_force, report.min_gap, report.sigma_min_bound);
        failures += result.ok() ? 0 : 1;
    }
    return failures == 0 ? 0 : 1;
}
