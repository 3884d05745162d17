#pragma once
/// \file
/// Radii from a text file, and how small and large they may be.

#include <filesystem>
#include <vector>

namespace isostat {

/// Of radii and diameters that a packing is prepared from: the box of many is far below `longest_length`.
inline constexpr double smallest_size = 1e-140;
inline constexpr double largest_size = 1e140;

/// One radius per line; '#' starts a comment line. Throws `Error(bad_input)` with file and line.
std::vector<double> read_radii(const std::filesystem::path& path);

} // namespace isostat
