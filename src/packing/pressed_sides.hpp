#pragma once
/// \file
/// The lengths that a stress presses on.

#include <isostat/packing/load.hpp>

#include <string>

namespace isostat {

/// Throws `Error(bad_input)` where a wall, or a period, is pressed over the length of a side that has no length: one of
/// its walls is absent, whose place means nothing. That is so of true stresses, and of nominal ones where the reference
/// lengths are not stated (`stated`): then they would be the present ones.
void require_pressed_sides(const Packing& packing, const Load& load, bool stated, const std::string& source);

} // namespace isostat
