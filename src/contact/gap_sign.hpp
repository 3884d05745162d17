#pragma once
// Exact sign of a gap.

#include <isostat/contact/contact.hpp>

namespace isostat {

/// Sign (-1, 0, 1) of gap + allowance over the reals, for the stored doubles: by an interval (CGAL::Interval_nt), and
/// where that contains 0 by rationals (CGAL::Exact_rational). \pre finite coordinates and radii, allowance >= 0; not a
/// held coordinate.
template <int Dim> int gap_sign(const Packing<Dim>& packing, const Contact& contact, double allowance);

extern template int gap_sign<2>(const Packing<2>&, const Contact&, double);

} // namespace isostat
