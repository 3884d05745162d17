#pragma once
/// \file
/// Files that are named in other files.

#include <filesystem>
#include <string>

namespace isostat {

/// The file that another one in `folder` names: beside it or below it. Throws `Error(bad_input)`, `where` first, for a
/// name that leads elsewhere (absolute, with "..", through a link) and for what is no regular file: a device or a pipe
/// may never end. A file that does not exist is left to its reader. An empty `folder` is the current one.
std::filesystem::path named_input(const std::filesystem::path& folder, const std::string& name,
                                  const std::string& where);

} // namespace isostat
