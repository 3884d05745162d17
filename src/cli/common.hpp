#pragma once
/// \file
/// Functions that several subcommands share.

#include "answers/answer.hpp"
#include "cli/commands.hpp"
#include "cli/terminal.hpp"
#include "contact/words.hpp"
#include "core/decimal.hpp"
#include "io/json.hpp"

#include <isostat/core/result.hpp>
#include <isostat/io/run_directory.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/scene/scene.hpp>

#include <filesystem>
#include <string>

namespace isostat::cli {

using json::Json;
using json::or_null;

/// Prints the lines of an answer, or with --json its object; `format` ("isostat-plateau 1"): it begins with that, the
/// program and the command line.
void print(answers::Answer answer, const Common& common, const char* format = nullptr);

/// Prints an object as one line on standard output.
void print_json(const Json& object);

/// Exit status of a domain failure: 2 for ties and undecided signs, 130 when the user stopped it, 1 otherwise.
int status_of(FailureKind kind);

/// 0 proved, 1 refuted, 2 undecided.
inline int status_of(Verdict verdict) {
    return static_cast<int>(verdict);
}

/// The folder mode that the options of a command ask for.
template <class Arguments> FolderMode mode_of(const Arguments& arguments) {
    return arguments.resume ? FolderMode::resume : arguments.force ? FolderMode::force : FolderMode::fresh;
}

/// Prepares the packing of a scene with progress on the terminal. After
/// a failure `failed` holds the last configuration (written atomically).
Result<State> prepare_start(const Scene& scene, const std::string& command, bool quiet,
                            const std::filesystem::path& failed);

} // namespace isostat::cli
