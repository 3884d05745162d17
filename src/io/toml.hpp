#pragma once
/// \file
/// TOML documents: scenes and crafted packings.

#include <toml++/toml.h>

#include <string>
#include <string_view>

namespace isostat {

/// Parses a document. Throws `Error(bad_input)` with the line when it is not valid TOML, or when a dotted name
/// ("a.b.c", also of a table) has more than 64 parts: each part is a table in a table, and functions that walk a
/// document call themselves (the library has a limit for nested values only, 256). \pre no byte order mark: positions
/// in the document are those of the text.
toml::table parse_toml(std::string_view text, const std::string& source);

} // namespace isostat
