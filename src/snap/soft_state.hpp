#pragma once
/// \file
/// Soft grains and their given forces.

#include <isostat/io/state_file.hpp>
#include <isostat/snap/snap.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

struct SoftForces {
    SoftState soft;
    std::vector<double> forces; ///< one per contact; NaN, or an empty list: not given
};

/// A law with its stiffness.
struct ContactLaw {
    ForceLaw kind = ForceLaw::none;
    double stiffness = 0;
    /// The force; 0 without overlap.
    [[nodiscard]] double force(const Packing& packing, const Contact& contact) const;
    /// Bound of the error of that force from the rounding of a gap.
    [[nodiscard]] double rounding(const Packing& packing, const Contact& contact, double of_gap) const;
};

/// The contacts of a state that can carry a force, with its load. Throws
/// `Error(bad_input)`, beginning with `source`, unless each axis that is not periodic has
/// a fixed lower and a movable upper wall, no grain is fixed and no force acts on a grain.
SoftForces soft_grains(const StateFile& file, const std::string& source);

/// Adds forces of the law where none are given.
void add_law(SoftForces& grains, const ContactLaw& law);

} // namespace isostat::compare
