#pragma once
/// \file
/// Statistics of a sequence of equilibria.

#include <isostat/io/run_directory.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// The step from one equilibrium to the next: a change of sigma_2 at constant structure, then a rearrangement.
struct RearrangementRow {
    int segment = 0;
    int number = 0;    ///< number of the equilibrium reached
    int direction = 1; ///< +1: sigma_2 increased, -1: decreased
    double ratio = 0;  ///< sigma_2 / sigma_1 at which it happened
    int arcs = 0;
    /// |sigma_2' - sigma_2| / sigma_1 since the previous rearrangement of the segment (paper, figure 4); absent for the
    /// first one of a segment, which has no previous one, and when nothing changed.
    std::optional<double> stress_increment;
    /// |eps_2' - eps_2| (paper, figure 5); absent when only rattlers moved.
    std::optional<double> strain_increment;
};

/// The rearrangements of a run in the order of the rows, without stresses reached inside a supported interval.
std::vector<RearrangementRow> rearrangements(const std::vector<EquilibriumRow>& rows);

/// Increments between equilibria, separately for loading and unloading. All values are positive.
struct Increments {
    std::vector<double> loading, unloading;
};

/// |sigma_2' - sigma_2| / sigma_1 between successive rearrangements of one segment (paper, figure 4). A segment's first
/// rearrangement and a stress reached inside a supported interval are not between two rearrangements and do not count.
Increments stress_increments(const std::vector<EquilibriumRow>& rows);

/// |eps_2' - eps_2| of every rearrangement (paper, figure 5). Loading and unloading are the directions of sigma_2.
Increments strain_increments(const std::vector<EquilibriumRow>& rows);

/// Points (x, share of the values that are >= x) of the complementary distribution, x
/// increasing: no bins, no free parameter.
std::vector<std::pair<double, double>> complementary_distribution(std::vector<double> values);

/// Histogram density: `bins` equal bins over [low, high], (centre, density); densities integrate
/// to the share of values inside.
std::vector<std::pair<double, double>> histogram(const std::vector<double>& values, double low, double high, int bins);

/// The path from the start to equilibrium `number`, both included, in order.
std::vector<EquilibriumRow> path_to(const std::vector<EquilibriumRow>& rows, int number);

/// The path of a segment of the programme: the equilibrium that it starts from, then its own.
struct SegmentPath {
    std::string title;
    std::vector<EquilibriumRow> rows;
    bool has_start = false; ///< the first row is of another segment
};
/// By their numbers, those without an equilibrium left out. `names`: names of the segments.
std::map<int, SegmentPath> segment_paths(const std::vector<EquilibriumRow>& rows,
                                         const std::vector<std::string>& names);

double mean(const std::vector<double>& values);

} // namespace isostat
