#pragma once
/// \file
/// Statistics of a sequence of equilibria.

#include <isostat/io/run_directory.hpp>

#include <string>
#include <vector>

namespace isostat {

/// Increments between equilibria, loading and unloading apart. All values are positive.
struct Increments {
    std::vector<double> loading, unloading;
};

/// |sigma_2' - sigma_2| / sigma_1 between successive rearrangements of one segment (paper, figure 4). A segment's first
/// rearrangement and a stress reached inside a supported interval are not between two rearrangements and do not count.
Increments stress_increments(const std::vector<EquilibriumRow>& rows);

/// |eps_2' - eps_2| of every rearrangement (paper, figure 5). Loading and unloading tell the direction of sigma_2.
Increments strain_increments(const std::vector<EquilibriumRow>& rows);

/// Points (x, share of the values that are >= x) of the complementary distribution, x increasing: no bins, no free
/// parameter.
std::vector<std::pair<double, double>> complementary_distribution(std::vector<double> values);

/// Histogram density: `bins` equal bins over [low, high], (centre, density); densities integrate to the share of values
/// inside.
std::vector<std::pair<double, double>> histogram(const std::vector<double>& values, double low, double high, int bins);

/// The path from the start to equilibrium `number`, both included, in order.
std::vector<EquilibriumRow> path_to(const std::vector<EquilibriumRow>& rows, int number);

double mean(const std::vector<double>& values);

} // namespace isostat
