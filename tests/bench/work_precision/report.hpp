#pragma once
// What the parts of bench_work_precision share: settings, the heads and files of tables, starts, figures.

#include "bench/shared/report.hpp"

#include <isostat/contact/state.hpp>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace work_precision {

using bench::Sample;
using bench::Table;

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Settings {
    bench::Program* program = nullptr; ///< gets every table that is written
    std::filesystem::path folder = ".";
    std::vector<int> sizes;           ///< disks
    std::vector<std::uint64_t> seeds; ///< of small displacements; events use the first
    int equilibria = 20;              ///< of the reference trajectory
    int drift_equilibria = 40;        ///< of the trajectories with linear gaps
    bool quick = false;
};

inline double cpu_seconds() {
    return 1e-3 * bench::cpu_milliseconds();
}

/// Columns whose heads are their keys. Behind a "~" an error: one digit and the power of ten; else three digits.
std::vector<bench::Column> columns(const std::vector<std::string>& heads);

/// NAME.csv in the folder; the table in Markdown appended to `tables.md` and printed; handed to the program.
void write(const Table& table, const Settings& settings);

isostat::State prepared(int disks, std::uint64_t seed);

/// Each part fills its tables; false when a check of the part fails (an error above its proved bound...).
bool events_and_stresses(const Settings& settings);
bool small_displacements(const Settings& settings);

/// Runs gnuplot on a script in the folder.
void draw(const std::filesystem::path& folder, const std::string& name, const std::string& script);

} // namespace work_precision
