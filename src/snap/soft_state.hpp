#pragma once
/// \file
/// Soft grains and the forces that are said of them.

#include <isostat/io/state_file.hpp>
#include <isostat/snap/snap.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

struct SoftForces {
    SoftState soft;
    std::vector<double> forces; ///< of its contacts; NaN, or an empty list: not said
};

/// A law with its stiffness.
struct ContactLaw {
    ForceLaw kind = ForceLaw::none;
    double stiffness = 0;
    /// 0 where nothing overlaps.
    [[nodiscard]] double force(const Packing& packing, const Contact& contact) const;
    /// What the rounding of an overlap does to that.
    [[nodiscard]] double rounding(const Packing& packing, const Contact& contact, double of_gap) const;
};

/// The contacts of a state that can carry a force, with its load. Throws `Error(bad_input)`, which begins with
/// `source`: expected a fixed lower and a movable upper wall along each axis that is not periodic, no fixed grain and
/// no force on a grain.
SoftForces soft_grains(const StateFile& file, const std::string& source);

/// Forces of the law where none are said.
void add_law(SoftForces& grains, const ContactLaw& law);

} // namespace isostat::compare
