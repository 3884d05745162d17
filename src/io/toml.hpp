#pragma once
/// \file
/// TOML documents: scenes and crafted packings.

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

namespace isostat {

/// Parses a document. Throws `Error(bad_input)` with the line when it is not valid TOML, or when a dotted name
/// ("a.b.c", also of a table) has more than 64 parts: each part is a table in a table, and functions that walk a
/// document call themselves (the library has a limit for nested values only, 256). \pre no byte order mark: positions
/// in the document are those of the text.
toml::table parse_toml(std::string_view text, const std::string& source);

/// A value as TOML text.
std::string toml_text(double value);
std::string toml_text(const std::string& value);

/// Where the parser's positions are in the text: lines and columns from 1, columns in code points.
class TomlLines {
  public:
    explicit TomlLines(std::string_view text);
    /// In bytes.
    [[nodiscard]] std::size_t offset(const toml::source_position& position) const;
    [[nodiscard]] std::string slice(const toml::source_region& region) const;

  private:
    std::string text_;
    std::vector<std::size_t> begin_; ///< of the lines
};

} // namespace isostat
