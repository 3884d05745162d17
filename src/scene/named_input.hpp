#pragma once
/// \file
/// Files that are named in other files.

#include <filesystem>
#include <string>

namespace isostat {

/// The file that a file in `folder` names, beside or below it. Throws `Error(bad_input)`, beginning with `where`, for a
/// name that leads elsewhere (absolute, with "..", through a link) and for a file that is not regular, because a device
/// or a pipe may never end. The reader reports a missing file. An empty `folder` is the current one.
std::filesystem::path named_input(const std::filesystem::path& folder, const std::string& name,
                                  const std::string& where);

} // namespace isostat
