#pragma once
/// \file
/// Whole files in and out.

#include <filesystem>
#include <string>
#include <string_view>

namespace isostat {

/// The bytes of a file. Throws `Error(bad_input)` naming the file when it cannot be read or is blank.
std::string read_text(const std::filesystem::path& path);

/// The text after a UTF-8 byte order mark, which some programs write at the start of a file: all of it when there is
/// none. Every reader of text begins with this.
std::string_view without_byte_order_mark(std::string_view text);

/// Replaces or makes a file in one step: the text goes to `path` + ".part" beside it, reaches the disk (fsync), and is
/// then renamed. At every instant `path` is absent, the old file or the complete new one, also after a kill or a full
/// disk. Throws `Error(cannot_write)` naming the file and the system's reason; nothing is left behind then.
void write_atomically(const std::filesystem::path& path, const std::string& text);

/// A folder that was made for `first`, and was left before that file was complete: a lock is there, and nothing else
/// but what a kill leaves of `first`, and empty folders.
bool holds_only_a_lock(const std::filesystem::path& first);

/// Makes a directory and its parents. Throws `Error(cannot_write)` naming the directory and the reason.
void make_directory(const std::filesystem::path& path);

} // namespace isostat
