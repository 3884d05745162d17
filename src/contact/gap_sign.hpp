#pragma once
// Exact sign of a gap.

#include <isostat/contact/state.hpp>

namespace isostat {

/// Sign (-1, 0, 1) of gap + allowance over the reals, for the stored doubles: by an interval (CGAL::Interval_nt), and
/// where that contains 0 by rationals (CGAL::Exact_rational). \pre finite coordinates and radii; not a
/// held coordinate.
int gap_sign(const Packing& packing, const Contact& contact, double allowance);

} // namespace isostat
