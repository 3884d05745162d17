#pragma once
/// \file
/// Text read line by line, with messages that name file, line, value and what was expected.

#include "core/refuse.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace isostat {

/// A separator of fields that stands for blanks, tabs and commas.
inline constexpr char blanks_or_commas = '\0';

/// One line, split into fields.
class TextLine {
  public:
    /// At blanks and tabs, at `blanks_or_commas`, or at every `separator` (then fields may be empty, and are trimmed
    /// and unquoted).
    TextLine(std::string_view text, int number, const std::string* source, char separator = ' ');

    [[nodiscard]] std::string_view text() const { return text_; }
    /// "FILE:LINE".
    [[nodiscard]] std::string place() const;
    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] std::size_t size() const { return fields_.size(); }
    [[nodiscard]] std::string_view field(std::size_t k) const { return fields_[k]; }
    [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }

    /// Throws `Error(bad_input)`: "FILE:LINE: NAME is 'VALUE': expected WHAT".
    [[noreturn]] void fail(std::string_view value, const std::string& name, const std::string& expected) const;
    template <class... Values>
    [[noreturn]] void fail(std::string_view value, const std::string& name, fmt::format_string<Values...> expected,
                           Values&&... values) const {
        fail(value, name, fmt::format(expected, std::forward<Values>(values)...));
    }
    /// Throws when there are not `count` fields.
    void require_size(std::size_t count, const std::string& what) const;
    /// A `written_number`, all of the field. \pre k < size()
    [[nodiscard]] double number(std::size_t k, const std::string& name) const;
    /// The same, above 0.
    [[nodiscard]] double positive(std::size_t k, const std::string& name) const;
    [[nodiscard]] long integer(std::size_t k, const std::string& name, long lowest, long highest) const;

  private:
    std::string_view text_;
    std::vector<std::string_view> fields_;
    int number_;
    const std::string* source_;
};

/// Walks through a text line by line, after its byte order mark if it has one. \pre text and source outlive it and its
/// lines.
class TextLines {
  public:
    /// \p before: lines of the file before the text.
    TextLines(std::string_view text, const std::string& source, int before = 0);
    [[nodiscard]] bool at_end() const { return rest_.empty(); }
    /// True when only blank lines are left.
    [[nodiscard]] bool only_blanks() const { return rest_.find_first_not_of(" \t\r\n") == std::string_view::npos; }
    /// The next line without taking it; empty at the end.
    [[nodiscard]] std::string_view peek() const { return rest_.substr(0, rest_.find('\n')); }
    /// Throws at the end of the file; `what` says what was expected.
    std::string_view take(const std::string& what);
    TextLine next(const std::string& what, char separator = ' ') {
        const std::string_view text = take(what); // before number() is asked
        return {text, number_, source_, separator};
    }

    /// Passes over what `is_no_row`. False: nothing else is left.
    bool find_row(char separator = ' ');
    /// The next row, with so many fields between `blanks_or_commas` (0: any number, at least one).
    TextLine next_row(const std::string& what, std::size_t fields);
    /// Throws when a row is left.
    void finish(const std::string& what);

    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] const std::string& source() const { return *source_; }
    [[noreturn]] void fail(const std::string& message) const;
    template <class... Values> [[noreturn]] void fail(fmt::format_string<Values...> message, Values&&... values) const {
        fail(fmt::format(message, std::forward<Values>(values)...));
    }

  private:
    std::string_view rest_;
    const std::string* source_;
    int number_;
};

/// Without blanks, tabs and carriage returns at its ends.
std::string_view without_blanks(std::string_view text);

/// Blank, or a comment that begins with '#' or '%'. Commas are blank where they separate as blanks do.
bool is_no_row(std::string_view line, char separator = ' ');

} // namespace isostat
