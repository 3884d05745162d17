#pragma once
/// \file
/// Exact signs of gaps, and disks that touch themselves through a period that does not move.

#include <isostat/contact/state.hpp>

#include <vector>

namespace isostat {

/// Sign (-1, 0, 1) of gap + allowance over the reals, for the stored doubles: by an interval (CGAL::Interval_nt), and
/// where that contains 0 by rationals (CGAL::Exact_rational). \pre finite coordinates and radii, allowance >= 0; not a
/// held coordinate.
int gap_sign(const Packing& packing, const Contact& contact, double allowance);

/// A disk and an own image at gap 0, exactly, between which no part of the cell moves (`can_move`). Such a pair is no
/// contact of a list and bears no load, but the other strains of the cell can close it.
std::vector<Contact> touching_own_images(const Packing& packing);

} // namespace isostat
