#pragma once
/// \file
/// What a file is, for messages about the wrong one.

#include <filesystem>
#include <string>

namespace isostat::cli {

/// Empty, or a sentence for a message: the file or folder is of a kind that this command does not take, and which
/// commands do. By its content, not by its name. Throws nothing.
std::string other_use(const std::string& command, const std::filesystem::path& file);

} // namespace isostat::cli
