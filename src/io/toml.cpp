#include "core/refuse.hpp"
#include "io/section.hpp"
#include "io/text.hpp"

#include <isostat/core/machine.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

constexpr int most_parts = 64;

/// The end of a string that begins at `at`: after its closing quotes, or at the end of the text (an error that the
/// parser finds).
std::size_t end_of_string(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const std::string three(3, quote);
    const bool long_string = text.substr(at, 3) == three;
    const std::size_t size = long_string ? 3 : 1;
    for (std::size_t k = at + size; k < text.size(); ++k) {
        if (text[k] == '\\' && quote == '"') {
            ++k;
        } else if (text[k] == '\n' && !long_string) {
            return k;
        } else if (text.substr(k, size) == std::string_view(three).substr(0, size)) {
            k += size;
            for (int more = 0; more < 2 && long_string && text.substr(k, 1) == three.substr(0, 1); ++more) {
                ++k; // one or two quotes may stand before the closing three
            }
            return k;
        }
    }
    return text.size();
}

bool is_of_a_bare_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '+' || static_cast<unsigned char>(c) >= 0x80;
}

/// Line of the first dotted name with too many parts, or 0. Names are found by their letters only: whatever joins
/// words by points counts, numbers too (one point).
int line_of_long_name(std::string_view text) {
    int parts = 0;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (c == '#') {
            at = std::min(text.find('\n', at), text.size());
            parts = 0;
        } else if (c == '"' || c == '\'') {
            at = end_of_string(text, at);
        } else if (c == '.') {
            if (++parts >= most_parts) {
                return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
            }
            ++at;
        } else {
            parts = is_of_a_bare_name(c) || c == ' ' || c == '\t' ? parts : 0;
            ++at;
        }
    }
    return 0;
}

} // namespace

toml::table parse_toml(std::string_view text, const std::string& source) {
    require_floating_point();
    if (const int line = line_of_long_name(text)) {
        refuse(ErrorKind::bad_input, "{}:{}: a dotted name has more than {} parts: expected fewer", source, line,
               most_parts);
    }
    try {
        return toml::parse(text, source);
    } catch (const toml::parse_error& error) {
        refuse(ErrorKind::bad_input, "{}:{}: not valid TOML: {}", source, error.source().begin.line,
               error.description());
    }
}

std::string toml_text(double value) {
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string toml_text(const std::string& value) {
    // A basic string with the escapes that JSON has too, because records of a run contain this string.
    std::string quoted = "\"";
    for (const char c : value) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            quoted += '\\';
            quoted += c;
        } else if (code < 0x20 || code == 0x7f) {
            quoted += fmt::format("\\u{:04X}", code);
        } else {
            quoted += c;
        }
    }
    return text::json(quoted + "\"");
}

TomlLines::TomlLines(std::string_view text) : text_(text), begin_{0} {
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (text[k] == '\n') {
            begin_.push_back(k + 1);
        }
    }
}

std::size_t TomlLines::offset(const toml::source_position& position) const {
    std::size_t at = begin_[position.line - 1];
    for (std::uint32_t column = 1; column < position.column; ++column) {
        do {
            ++at;
        } while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0U) == 0x80U);
    }
    return at;
}

std::string TomlLines::slice(const toml::source_region& region) const {
    const std::size_t begin = offset(region.begin);
    return text_.substr(begin, offset(region.end) - begin);
}

} // namespace isostat
