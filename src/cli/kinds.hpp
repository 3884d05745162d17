#pragma once
/// \file
/// The kind of a file, for messages about a wrong one.

#include <filesystem>
#include <string>

namespace isostat::cli {

/// Empty, or a sentence for a message: the file or folder is of a kind that this command does not take, and the
/// commands that do. Judged by content, not by name. Throws nothing.
std::string other_use(const std::string& command, const std::filesystem::path& file);

} // namespace isostat::cli
