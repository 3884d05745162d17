#pragma once
/// \file
/// Whole files in and out.

#include <filesystem>
#include <string>

namespace isostat {

/// The content of a file. Throws `Error(bad_input)` naming the file when it cannot be read or is empty.
std::string read_text(const std::filesystem::path& path);

/// Replaces or makes a file in one step: the text goes to `path` + ".part" beside it, reaches the disk (fsync), and is
/// then renamed. At every instant `path` is absent, the old file or the complete new one, also after a kill or a full
/// disk. Throws `Error(cannot_write)` naming the file and the system's reason; nothing is left behind then.
void write_atomically(const std::filesystem::path& path, const std::string& text);

/// Makes a directory and its parents. Throws `Error(cannot_write)` naming the directory and the reason.
void make_directory(const std::filesystem::path& path);

} // namespace isostat
