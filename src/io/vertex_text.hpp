#pragma once
/// \file
/// The plain text format of a vertex in the box with two fixed and two movable walls.

#include <isostat/contact/state.hpp>

#include <string>

namespace isostat {

/// Reads a vertex from text. Lines that start with '#' and empty lines do not count; then
/// \code
///   n x y r gx gy         (the number of disks, and these words)
///   x y r gx gy           (n rows; g = infinitesimal load of the disk)
///   Lx Ly
///   number of contacts
///   type i j              (one row per contact; disks from 0; type 0: disk i - disk j, 1 left, 2 bottom, 3 right, 4
///   top wall; j = -1 or
///                          anything for walls)
/// \endcode
/// The older order is read too: a first row with the number alone stands before rows `radius x y gx gy`.
/// The load is nominal with sigma_1 = sigma_2 = 1 and reference lengths Lx, Ly; contacts come out sorted.
/// `source` (a file name) starts every message. Throws `Error(bad_input)` with file, line, value and what was expected.
/// As `parse_state`, it does not look at the geometry.
State parse_vertex_text(const std::string& text, const std::string& source);

} // namespace isostat
