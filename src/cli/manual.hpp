#pragma once
/// \file
/// The texts of `--help`, for `man` and for the shell.

#include <CLI/CLI.hpp>

#include <string>

namespace isostat::cli {

/// isostat(1), in the macros of man(7): every command with its options. `version`: name and version of the program.
std::string man_page(const CLI::App& app, const std::string& version);

/// Completion of commands, of their options, of the words that
/// options take, and of file names, for "bash", "zsh", "fish".
std::string shell_completion(const CLI::App& app, const std::string& shell);

} // namespace isostat::cli
