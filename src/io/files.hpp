#pragma once
/// \file
/// Whole files in and out.

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace isostat {

/// The bytes of a file. Throws `Error(bad_input)` naming the file when it cannot be read or is blank.
std::string read_text(const std::filesystem::path& path);

/// The same of a file that may be packed with gzip: its content, of at most 4 GiB. Throws too where a packed file is
/// damaged or cut.
std::string read_packed_text(const std::filesystem::path& path);

/// The text after a UTF-8 byte order mark, which some programs write at the start of a file: all of it when there is
/// none. Every reader of text begins with this.
std::string_view without_byte_order_mark(std::string_view text);

/// Replaces or makes a file in one step: the text goes to a new file beside it (`name_of_temporary`), reaches the disk
/// (fsync), and is then renamed. At every instant `path` is absent, the old file or the complete new one, also after a
/// kill or a full disk. Throws `Error(cannot_write)` naming the file and the system's reason; nothing is left behind
/// then.
void write_atomically(const std::filesystem::path& path, const std::string& text);

/// "x.json" of "x.json.0123456789abcdef.part", a file that `write_atomically` makes beside x.json and that stays after
/// a kill ("x.json.part" of earlier versions); empty for other names.
std::string name_of_temporary(const std::string& name);

/// The first 300 bytes of a file contain this text.
bool is_marked(const std::filesystem::path& path, const std::string& text);

/// Throws `Error(usage)` when a file that is to be written is one of `inputs`, by whatever name, or holds something
/// else than what would be written: it is not empty, and `is_marked` says no.
void check_output(const std::filesystem::path& path, const std::string& mark,
                  std::initializer_list<std::filesystem::path> inputs = {});

/// `check_output` and `write_atomically`: for every file whose name the user chooses.
void write_output(const std::filesystem::path& path, const std::string& text, const std::string& mark);

/// Throws `Error(cannot_write)` unless a file can be made beside `path`; it is removed again.
void check_directory_of(const std::filesystem::path& path);

/// Makes a directory and its parents. Throws `Error(cannot_write)` naming the directory and the reason.
void make_directory(const std::filesystem::path& path);

} // namespace isostat
