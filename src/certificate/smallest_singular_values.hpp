#pragma once
/// \file
/// Singular values of a contact matrix as computed: for people, no proof looks at them.

#include "rigidity/isostatic.hpp"

#include <vector>

namespace isostat {

/// The smallest singular values of H at the stored coordinates, ascending, `count` of them or all there are: subspace
/// iteration with H^-1 and its transpose until no value changes by more than a ten-thousandth, at most 200 times. Cost:
/// some tens of iterations of 2 (count + 10) solves.
std::vector<double> smallest_singular_values(const IsostaticStructure& structure, int count);

} // namespace isostat
