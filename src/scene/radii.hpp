#pragma once
/// \file
/// Radii of a scene: from a text file, or drawn as the keys of [packing] say.

#include "scene/settings.hpp"

#include <isostat/preparation/preparation.hpp>

#include <filesystem>
#include <vector>

namespace isostat {

/// Smallest radius or diameter for a preparation; the largest is such that a box of many stays below `longest_length`.
inline constexpr double smallest_size = 1e-140;
inline constexpr double largest_size = 1e140;

/// One radius per line; '#' starts a comment line. Throws `Error(bad_input)` with file and line.
std::vector<double> read_radii(const std::filesystem::path& path);

/// The law, with its defaults recorded. Throws `Error(bad_input)`
/// for keys of another law and for a law with a fault.
DiameterLaw read_law(SceneSection& section);

/// Reads every key of a law, so that all are known, and refuses
/// those that are present: "has no meaning with `source`".
void refuse_law(SceneSection& section, const std::string& source);

} // namespace isostat
