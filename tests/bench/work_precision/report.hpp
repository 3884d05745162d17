#pragma once
// What the parts of bench_work_precision share: settings, tables in Markdown and CSV, statistics of a few numbers.

#include "bench/shared/report.hpp"

#include <isostat/contact/state.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace work_precision {

struct Settings {
    bench::Program* program = nullptr; ///< gets every table that is written
    std::filesystem::path folder = ".";
    std::vector<int> sizes;           ///< disks
    std::vector<std::uint64_t> seeds; ///< of small displacements; events use the first
    int equilibria = 20;              ///< of the reference trajectory
    int drift_equilibria = 40;        ///< of the trajectories with linear gaps
    bool quick = false;
};

double cpu_seconds();

/// Column heads, then rows of the same length; `name` of the files.
class Table {
  public:
    Table(std::string name, std::string caption, std::vector<std::string> heads)
        : name_(std::move(name)), caption_(std::move(caption)), heads_(std::move(heads)) {}
    void add(std::vector<std::string> row);
    /// NAME.csv in the folder; the table in Markdown appended to `tables.md` and printed; handed to the program.
    void write(const Settings& settings) const;
    /// NAME.csv only: for figures.
    void write_csv(const std::filesystem::path& folder) const;

  private:
    std::string name_, caption_;
    std::vector<std::string> heads_;
    std::vector<std::vector<std::string>> rows_;
};

/// NaN for an empty list.
double median(std::vector<double> x);
double largest(const std::vector<double>& x);
double mean(const std::vector<double>& x);
/// "1.2e-07"; "–" for NaN.
std::string number(double x);
/// "12.3" with three significant digits; "–" for NaN.
std::string plain(double x);

isostat::State prepared(int disks, std::uint64_t seed);

/// Each part fills its tables; false when a check of the part fails (an error above its proved bound...).
bool events_and_stresses(const Settings& settings);
bool small_displacements(const Settings& settings);

/// Runs gnuplot on a script in the folder.
void draw(const std::filesystem::path& folder, const std::string& name, const std::string& script);

} // namespace work_precision
