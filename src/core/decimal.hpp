#pragma once
/// \file
/// Decimal texts of bounds, rounded outwards.

#include <string>

namespace isostat {

/// Decimal number with this many digits that is at least (at most) the value.
std::string rounded_up(double value, int digits);
std::string rounded_down(double value, int digits);

/// "value +- bound", which contains the interval. 12 digits, or more where the interval is narrower.
std::string with_bound(double lower, double upper);

} // namespace isostat
