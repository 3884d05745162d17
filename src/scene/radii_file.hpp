#pragma once
/// \file
/// Radii from a text file.

#include <filesystem>
#include <vector>

namespace isostat {

/// One radius per line; '#' starts a comment line. Throws `Error(bad_input)` with file and line.
std::vector<double> read_radii(const std::filesystem::path& path);

} // namespace isostat
