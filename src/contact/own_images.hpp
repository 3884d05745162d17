#pragma once
/// \file
/// Disks that touch themselves through a period that does not move.

#include <isostat/contact/state.hpp>

#include <vector>

namespace isostat {

/// A disk and an own image at gap 0, exactly, between which no part of the cell moves (`can_move`). Such a pair is no
/// contact of a list and bears no load, but the other strains of the cell can close it.
std::vector<Contact> touching_own_images(const Packing& packing);

} // namespace isostat
