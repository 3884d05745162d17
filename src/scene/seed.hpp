#pragma once
/// \file
/// The same scene with another seed: how samples of an ensemble differ.

#include <cstdint>
#include <filesystem>
#include <string>

namespace isostat {

/// The text of a scene whose `seed` in [packing] is `seed`: the number is replaced where it stands (or a line is added
/// below [packing] when the scene has none), comments and everything else stay. In the place of `radii_file` stand the
/// radii, since the new text may be kept in another folder. `source` starts messages, `folder` is that of the file.
/// \post parse_scene(result).preparation.seed == seed; the same arguments give the same text.
/// Throws `Error(bad_input)` for a text that is no scene, for one that reads its packing from a file (it has no seed:
/// all samples would be the same), for a seed above 2^63 - 1, which TOML does not have.
std::string with_seed(const std::string& text, std::uint64_t seed, const std::string& source,
                      const std::filesystem::path& folder);

} // namespace isostat
