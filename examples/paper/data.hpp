#pragma once
// The samples of every size, from the folders of their runs.

#include "inference.hpp"
#include "report/statistics.hpp"

#include <isostat/io/run_directory.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace paper {

/// Unloading to sigma2 = sigma1.
struct Cycle {
    int from = 0;         ///< equilibrium where it began; 0: the end of the loading
    double amplitude = 0; ///< sigma2/sigma1 there - 1
    double peak = 0;      ///< eps2 there
    double left = 0;      ///< eps2 back at sigma2 = sigma1
};

struct Sample {
    unsigned long seed = 0;
    bool completed = false;
    std::string status;
    std::vector<isostat::EquilibriumRow> rows;
    std::vector<isostat::RearrangementRow> loading;
    std::vector<double> stress, strain, arcs; ///< of the loading
    std::vector<Cycle> cycles;

    /// Rearrangements of the loading at a ratio of at most `end`.
    [[nodiscard]] double rearrangements_below(double end) const;
    /// Reached in the loading.
    [[nodiscard]] double highest_ratio() const;
    /// The equilibrium of that number, when it was reached by loading.
    [[nodiscard]] const isostat::EquilibriumRow* last_of_loading(int number) const;
};

struct Size {
    int disks = 0;
    std::vector<Sample> samples; ///< by seed
    [[nodiscard]] std::size_t completed() const;
};

/// ENSEMBLES/n100, n225, ...: those that hold a sample with at least its start, by size.
std::vector<Size> read_sizes(const std::filesystem::path& ensembles);

} // namespace paper
