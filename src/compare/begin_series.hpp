#pragma once
/// \file
/// A first manifest for a series.

#include <filesystem>
#include <string>

namespace isostat::compare {

/// The texts of a manifest for a file of frames, and of its table of frames. Loads and walls, which the file does not
/// have (the bounds of a dump are no walls), are left for the user to fill in.
struct BegunSeries {
    std::string manifest, frames;
};

/// \p disks: file of the frames. \p frames: name of the table in the manifest. Throws `Error(bad_input)` for the file.
BegunSeries begin_series(const std::filesystem::path& disks, const std::string& name, const std::string& frames);

} // namespace isostat::compare
