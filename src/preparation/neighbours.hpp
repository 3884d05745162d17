#pragma once
/// \file
/// The disks and walls near each other, of soft packings too.

#include <isostat/contact/state.hpp>

#include <vector>

namespace isostat::preparation {

/// Pairs of disks and lower walls with gap < `reach`, upper walls with gap <
/// `upper_reach`, sorted. In a cell also pairs with images of another disk, those with
/// gap < `reach` + `upper_reach`, because a period moves as far as an upper wall.
std::vector<Contact> near_contacts(const Packing& packing, double reach, double upper_reach);

} // namespace isostat::preparation
