#pragma once
/// \file
/// Radii from a text file, and bounds of their sizes.

#include <filesystem>
#include <vector>

namespace isostat {

/// Smallest radius or diameter for a preparation; the largest is such that a box of many stays below `longest_length`.
inline constexpr double smallest_size = 1e-140;
inline constexpr double largest_size = 1e140;

/// One radius per line; '#' starts a comment line. Throws `Error(bad_input)` with file and line.
std::vector<double> read_radii(const std::filesystem::path& path);

} // namespace isostat
