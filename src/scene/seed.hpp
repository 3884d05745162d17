#pragma once
/// \file
/// A scene with another seed, for the samples of an ensemble.

#include <cstdint>
#include <filesystem>
#include <string>

namespace isostat {

/// The text of a scene with `seed` as its `seed` in [packing]: only the number is replaced (or a line is added below
/// [packing] when the scene has none); comments and everything else stay. The radii replace `radii_file`, because the
/// new text may be kept in another folder. `source` starts messages, `folder` is that of the file. \post
/// parse_scene(result).preparation.seed == seed; the same arguments give the same text. Throws `Error(bad_input)` for a
/// text that is no scene, for one that reads its packing from a file (all samples would be equal, as it has no seed),
/// for a seed above 2^63 - 1, which TOML does not have.
std::string with_seed(const std::string& text, std::uint64_t seed, const std::string& source,
                      const std::filesystem::path& folder);

} // namespace isostat
