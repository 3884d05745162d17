#pragma once
/// \file
/// A packing from any file that the program reads.

#include "cli/commands.hpp"

#include <isostat/foreign/foreign.hpp>

#include <string>
#include <vector>

namespace isostat::cli {

/// States, vertex texts, crafted packings (rounded to doubles) and files of other programs. Throws `Error(usage)` for
/// statements that make no sense, `Error(bad_input)` for the file.
ForeignPacking read_any_packing(const std::string& file, const ForeignArguments& arguments);

/// The words between commas, or another separator.
std::vector<std::string> parse_list(const std::string& text, char at = ',');

/// "A:B" as two finite numbers, A <= B. Throws `Error(usage)` naming the option.
std::array<double, 2> parse_range(const std::string& text, const std::string& option);

} // namespace isostat::cli
