#include "io/rows.hpp"

#include "io/files.hpp"
#include "io/numbers.hpp"

#include <isostat/core/error.hpp>
#include <isostat/core/machine.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

constexpr std::string_view blanks = " \t\r,";
constexpr std::size_t longest_quote = 60; ///< characters of a bad line that a message repeats

} // namespace

Row::Row(std::string_view line, int number, const std::string* source) : number_(number), source_(source) {
    for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
        fields_.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(blanks, end);
    }
}

void Row::fail(std::size_t field, const std::string& name, const std::string& expected) const {
    throw Error(ErrorKind::bad_input,
                fmt::format("{}:{}: {} is '{}': expected {}", *source_, number_, name, fields_[field], expected));
}

double Row::number(std::size_t field, const std::string& name) const {
    const auto value = finite_number(fields_[field]);
    if (!value) {
        fail(field, name, "a finite number");
    }
    return *value;
}

long Row::integer(std::size_t field, const std::string& name, long lowest, long highest) const {
    const auto value = plain_integer(fields_[field]);
    if (!value || *value < lowest || *value > highest) {
        fail(field, name, fmt::format("an integer from {} to {}", lowest, highest));
    }
    return *value;
}

RowReader::RowReader(const std::string& text, const std::string& source)
    : text_(without_byte_order_mark(text)), source_(&source) {
    require_floating_point();
}

std::string_view RowReader::peek() {
    while (peeked_.empty() && !text_.empty()) {
        const std::size_t end = std::min(text_.find('\n'), text_.size());
        const std::string_view line = text_.substr(0, end);
        text_.remove_prefix(std::min(end + 1, text_.size()));
        ++line_;
        const std::size_t first = line.find_first_not_of(blanks);
        if (first != std::string_view::npos && line[first] != '#') {
            peeked_ = line;
        }
    }
    return peeked_;
}

bool RowReader::at_end() {
    return peek().empty();
}

Row RowReader::next(const std::string& what, std::size_t fields) {
    if (at_end()) {
        throw Error(ErrorKind::bad_input, fmt::format("{}:{}: the file ends here: expected {}", *source_, line_, what));
    }
    Row row(peeked_, line_, source_);
    if (fields != 0 && row.size() != fields) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{}:{}: {} values in '{}': expected {} ({} values)", *source_, line_, row.size(),
                                peeked_.substr(0, longest_quote), what, fields));
    }
    peeked_ = {};
    return row;
}

void RowReader::finish(const std::string& what) {
    if (!at_end()) {
        throw Error(ErrorKind::bad_input, fmt::format("{}:{}: more rows than announced: '{}': expected {}", *source_,
                                                      line_, peeked_.substr(0, longest_quote), what));
    }
}

} // namespace isostat
