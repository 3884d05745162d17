#pragma once
/// \file
/// The folders that the program writes. The names in them are a fixed set: under other names nothing is written, read
/// or removed there.

#include "io/descriptor.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace isostat {

enum class FolderMode; // isostat/io/run_directory.hpp

/// One kind of folder.
struct FolderKind {
    const char* words;              ///< "a run"
    const char* mark;               ///< the file that says what the folder is
    const char* format;             ///< what it says
    std::vector<std::string> names; ///< of files, from the folder on; k '#' are a number of at least k digits

    /// A file of this kind has this name.
    [[nodiscard]] bool owns(std::string_view name) const;
    /// Files of this kind may stand in a folder of this name.
    [[nodiscard]] bool owns_folder(std::string_view name) const;
};

extern const FolderKind run_folder, ensemble_folder, report_folder, comparison_folder;

/// Of a run: "states/eq_000012.json", "certificates/eq_000012.json".
std::string state_name(int equilibrium);
std::string certificate_name(int equilibrium);
/// "states/last.json".
inline constexpr const char* last_state = "states/last.json";

/// What stands in a folder, as names from it on.
struct FolderContent {
    std::vector<std::string> files;     ///< of the kind
    std::vector<std::string> folders;   ///< of the kind, each before those in it
    std::vector<std::string> leftovers; ///< temporary files of writers that were killed
    std::vector<std::string> others;    ///< of somebody else
};

/// Throws `Error(bad_input)` where a name of the kind is no regular file or no folder: links lead elsewhere, pipes and
/// devices do not end.
FolderContent content_of(const std::filesystem::path& folder, const FolderKind& kind);

/// "states/notes.json is no file of a run and was left alone", or nothing.
std::vector<std::string> notes_on(const FolderContent& content, const FolderKind& kind);

/// A folder that was taken for output.
struct TakenFolder {
    Descriptor lock;      ///< held as long as this lives
    bool begun = false;   ///< `resume`: its mark is there
    FolderContent before; ///< `resume`: what was there
};

/// Takes a folder, which is made if need be, for a run or an ensemble. `fresh`: it does not exist, or is empty;
/// `force`: or it is of this kind, and then what such a folder holds by its fixed names is removed, nothing else;
/// `resume`: it is of this kind, or was left before its mark was written. Otherwise throws `Error(usage)`, or
/// `Error(bad_input)` on resume, and nothing was changed; `Error(cannot_write)`: a running program holds it.
TakenFolder take_folder(const std::filesystem::path& folder, const FolderKind& kind, FolderMode mode);

/// Throws `Error(bad_input)` unless the mark says that the folder is of this kind, in the version that is written now.
void check_mark(const std::filesystem::path& folder, const FolderKind& kind);

/// For output that is written over: the folder does not exist, is empty, or is of this kind. Otherwise throws
/// `Error(usage)`.
void check_folder_for(const std::filesystem::path& folder, const FolderKind& kind);
/// The same, and it is made.
void make_folder_for(const std::filesystem::path& folder, const FolderKind& kind);

/// Removes the files and then the folders that are empty.
void remove_files(const std::filesystem::path& folder, const std::vector<std::string>& files,
                  const std::vector<std::string>& folders = {});

} // namespace isostat
