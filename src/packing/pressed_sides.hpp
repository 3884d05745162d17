#pragma once
/// \file
/// The lengths that a stress presses on.

#include <isostat/packing/load.hpp>

#include <string>

namespace isostat {

/// Throws `Error(bad_input)` where a wall, or a period, is pressed over the length of a side that has no length: one of
/// its walls is absent, whose place means nothing. That is so of true stresses, and of nominal ones where the reference
/// lengths are not stated (`stated`): then they would be the present ones.
template <int Dim>
void require_pressed_sides(const Packing<Dim>& packing, const Load<Dim>& load, bool stated, const std::string& source);

extern template void require_pressed_sides<2>(const Packing<2>&, const Load<2>&, bool, const std::string&);

} // namespace isostat
