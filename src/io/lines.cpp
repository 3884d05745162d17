#include "io/lines.hpp"

#include "io/files.hpp"
#include "io/numbers.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

constexpr std::size_t longest_quote = 60; ///< characters of a bad line that a message repeats

std::string_view unquoted(std::string_view text) {
    return text.size() >= 2 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2) : text;
}

} // namespace

TextLine::TextLine(std::string_view text, int number, const std::string* source, char separator)
    : text_(text), number_(number), source_(source) {
    const bool commas = separator == blanks_or_commas;
    if (separator != ' ' && !commas) {
        while (true) {
            const std::size_t end = text.find(separator);
            fields_.push_back(unquoted(without_blanks(text.substr(0, end))));
            if (end == std::string_view::npos) {
                return;
            }
            text.remove_prefix(end + 1);
        }
    }
    const std::string_view blanks = commas ? " \t\r," : " \t\r";
    for (std::size_t at = text.find_first_not_of(blanks); at != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
        fields_.push_back(text.substr(at, end - at));
        at = text.find_first_not_of(blanks, end);
    }
}

std::string TextLine::place() const {
    return fmt::format("{}:{}", *source_, number_);
}

void TextLine::fail(std::string_view value, const std::string& name, const std::string& expected) const {
    refuse(ErrorKind::bad_input, "{}:{}: {} is '{}': expected {}", *source_, number_, name,
           value.substr(0, longest_quote), expected);
}

void TextLine::require_size(std::size_t count, const std::string& what) const {
    if (fields_.size() != count) {
        refuse(ErrorKind::bad_input, "{}:{}: {} values in '{}': expected {} ({} values)", *source_, number_,
               fields_.size(), text_.substr(0, longest_quote), what, count);
    }
}

double TextLine::number(std::size_t k, const std::string& name) const {
    const auto value = written_number(fields_[k]);
    if (!value) {
        std::string point(fields_[k]);
        std::ranges::replace(point, ',', '.');
        fail(fields_[k], name,
             finite_number(point) ? "a finite number, with a point (its comma reads as none)" : "a finite number");
    }
    return *value;
}

double TextLine::positive(std::size_t k, const std::string& name) const {
    const double value = number(k, name);
    if (!(value > 0)) {
        fail(fields_[k], name, "a positive number");
    }
    return value;
}

long TextLine::integer(std::size_t k, const std::string& name, long lowest, long highest) const {
    const auto value = plain_integer(fields_[k]);
    if (!value || *value < lowest || *value > highest) {
        fail(fields_[k], name, fmt::format("an integer from {} to {}", lowest, highest));
    }
    return *value;
}

TextLines::TextLines(std::string_view text, const std::string& source, int before)
    : rest_(without_byte_order_mark(text)), source_(&source), number_(before) {
    require_floating_point();
}

std::string_view TextLines::take(const std::string& what) {
    if (at_end()) {
        fail("the file ends here: expected " + what);
    }
    const std::string_view line = peek();
    rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
    ++number_;
    return line;
}

bool TextLines::find_row(char separator) {
    while (!at_end() && is_no_row(peek(), separator)) {
        (void)take("");
    }
    return !at_end();
}

TextLine TextLines::next_row(const std::string& what, std::size_t fields) {
    (void)find_row(blanks_or_commas);
    TextLine row = next(what, blanks_or_commas);
    if (fields != 0) {
        row.require_size(fields, what);
    }
    return row;
}

void TextLines::finish(const std::string& what) {
    if (find_row(blanks_or_commas)) {
        const std::string row(take("").substr(0, longest_quote));
        fail(fmt::format("more rows than announced: '{}': expected {}", row, what));
    }
}

void TextLines::fail(const std::string& message) const {
    refuse(ErrorKind::bad_input, "{}:{}: {}", *source_, number_, message);
}

std::string_view without_blanks(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view()
                                           : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool is_no_row(std::string_view line, char separator) {
    const std::size_t first = line.find_first_not_of(separator == blanks_or_commas ? " \t\r\n," : " \t\r\n");
    return first == std::string_view::npos || line[first] == '#' || line[first] == '%';
}

} // namespace isostat
