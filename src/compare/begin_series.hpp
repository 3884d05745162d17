#pragma once
/// \file
/// A manifest to begin with.

#include <filesystem>
#include <string>

namespace isostat::compare {

/// The texts of a manifest for a file of frames, and of its table of frames. What the file does not say is left to fill
/// in: loads, and walls, as the bounds of a dump are none.
struct BegunSeries {
    std::string manifest, frames;
};

/// \p disks: of the frames. \p frames: name of the table in the manifest. Throws `Error(bad_input)` for the file.
BegunSeries begin_series(const std::filesystem::path& disks, const std::string& name, const std::string& frames);

} // namespace isostat::compare
