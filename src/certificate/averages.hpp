#pragma once
/// \file
/// Averages over the contacts of a state that people compare with other programs.

#include <isostat/certificate/certify.hpp>

#include <array>
#include <utility>
#include <vector>

namespace isostat {

/// Z = (2 pairs + wall contacts) / grains, an own image counting as a pair with both ends on one grain.
struct Coordination {
    double all = 0;      ///< of all listed contacts and all grains
    double carrying = 0; ///< of the contacts that carry a finite force and the grains that have one
};
/// \pre `truth` knows the finite forces, one for each contact
Coordination coordination(const State& state, const Certification& truth, int rattlers);

/// Listed contacts of each grain, with others and with walls, an own image twice; held coordinates are none.
std::vector<int> contacts_of_grains(const State& state);

/// Over the force-carrying contacts, from the middles of the proved forces and the stored coordinates, as computed.
struct ForceAverages {
    using Tensor = std::array<PerAxis<double>, most_axes>;
    /// (1/V) sum f n n^T l, l = R_i + R_j, at a wall R, V the product of the lengths: compression is positive. In an
    /// equilibrium the stress on the walls: sigma_aa = F_a L_a / V.
    Tensor stress{};
    double pressure = 0; ///< trace of the stress / d
    Tensor fabric{};     ///< mean of n n^T over pairs of grains; 0 without pairs
    double mean_force = 0;
};
/// \pre as above
ForceAverages force_averages(const State& state, const Certification& truth);

/// P(f / <f>) over the force-carrying contacts, walls too: centres of bins of 1/4 up to the largest force, densities
/// that integrate to 1. Empty without forces. \pre as above
std::vector<std::pair<double, double>> force_distribution(const State& state, const Certification& truth);

} // namespace isostat
