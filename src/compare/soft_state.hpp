#pragma once
/// \file
/// Soft grains and the forces that are said of them.

#include <isostat/compare/snap.hpp>
#include <isostat/io/state_file.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

struct SoftForces {
    SoftState soft;
    std::vector<double> forces; ///< of its contacts; NaN, or an empty list: not said
};

/// The contacts of a state that can carry a force, with its load. Throws `Error(bad_input)`, which begins with
/// `source`: expected a box with two fixed and two movable walls or a periodic cell, no fixed disk and no force on a
/// disk.
SoftForces soft_grains(const StateFile& file, const std::string& source);

/// Forces of linear contacts where none are said.
void add_law(SoftForces& grains, double stiffness);

} // namespace isostat::compare
