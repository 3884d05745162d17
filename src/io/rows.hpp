#pragma once
/// \file
/// Text files of rows of numbers, read with messages that name file, line, value and what was expected.

#include <string>
#include <string_view>
#include <vector>

namespace isostat {

/// One line that is neither empty nor a comment, split at blanks.
class Row {
  public:
    Row(std::string_view line, int number, const std::string* source);

    /// Throws `Error(bad_input)`: "FILE:LINE: NAME is 'VALUE': expected WHAT".
    [[noreturn]] void fail(std::size_t field, const std::string& name, const std::string& expected) const;
    /// A finite number, all of the field. \pre field < size()
    [[nodiscard]] double number(std::size_t field, const std::string& name) const;
    [[nodiscard]] long integer(std::size_t field, const std::string& name, long lowest, long highest) const;
    [[nodiscard]] std::string_view text(std::size_t field) const { return fields_[field]; }
    [[nodiscard]] std::size_t size() const { return fields_.size(); }

  private:
    std::vector<std::string_view> fields_;
    int number_;
    const std::string* source_;
};

/// Walks through the rows of a text, after its byte order mark if it has one; lines that start with '#' are comments.
/// \pre text and source outlive the reader and its rows.
class RowReader {
  public:
    RowReader(const std::string& text, const std::string& source);

    /// The next row, which must have `fields` fields (0: any number). Throws when the file ends before; `what` says
    /// what was expected.
    Row next(const std::string& what, std::size_t fields);
    /// True when only comments and empty lines are left.
    bool at_end();
    /// Throws when a row is left.
    void finish(const std::string& what);

  private:
    /// Moves to the next row without taking it; its line, or an empty view at the end.
    std::string_view peek();
    std::string_view text_;
    const std::string* source_;
    int line_ = 0; ///< number of the line peeked
    std::string_view peeked_;
};

} // namespace isostat
