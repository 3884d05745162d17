#pragma once
/// \file
/// What people compare with other programs: averages over the contacts of a state, the contacts as a table, singular
/// values as computed. No proof looks at these.

#include "rigidity/isostatic.hpp"

#include <isostat/certificate/certify.hpp>

#include <array>
#include <string>
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

/// The unit normal from the first grain to the second one, or to the wall.
PerAxis<double> outward(const State& state, const Contact& contact);

/// CSV, one row per contact in the order of the state: `contact` (its name), `i`, `j` (of a wall its name), the image
/// `mx`, `my`, `mz` of j, the point on the surface of i `x`, `y`, `z`, the unit normal from i to j `nx`, `ny`, `nz`,
/// the gap of the stored coordinates `gap`, the finite force `force` with proved ends `force_low`, `force_high` (empty
/// where they are not known, 0 where the force is exactly 0) and `force_infinitesimal` where that is claimed. In the
/// plane without the columns of z. Lengths in the unit of the file, forces in stress times length, in space times
/// length squared.
std::string contact_table(const State& state, const Certification& truth);

/// What the text begins with.
inline constexpr const char* contact_table_mark = "contact,i,j,mx,my";

/// The smallest singular values of H at the stored coordinates, ascending, `count` of them or all there are: subspace
/// iteration with H^-1 and its transpose until no value changes by more than a ten-thousandth, at most 200 times. Cost:
/// some tens of iterations of 2 (count + 10) solves.
std::vector<double> smallest_singular_values(const IsostaticStructure& structure, int count);

} // namespace isostat
