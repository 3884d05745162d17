#pragma once
/// \file
/// Exact sign of a gap of stored (dyadic) coordinates: private to the room.

#include <isostat/contact/contact.hpp>

namespace isostat {

/// Sign (-1, 0, +1) of gap + allowance as a real number: double with a rounding bound first, rationals (GMP) when that
/// does not decide.
template <int Dim> int sign_of_gap_plus(const Packing<Dim>& packing, const Contact& contact, double allowance);

extern template int sign_of_gap_plus<2>(const Packing<2>&, const Contact&, double);

} // namespace isostat
