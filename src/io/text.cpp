#include "io/text.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace isostat::text {

namespace {

/// The character that a text begins with, and its bytes: 0 where they are not UTF-8.
struct Character {
    std::uint32_t code = 0;
    std::size_t bytes = 0;
};

Character first_of(std::string_view text) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned lead = byte(0);
    const std::size_t bytes = lead < 0x80   ? 1
                              : lead < 0xC2 ? 0
                              : lead < 0xE0 ? 2
                              : lead < 0xF0 ? 3
                              : lead < 0xF5 ? 4
                                            : 0;
    if (bytes < 2 || bytes > text.size()) {
        return {lead, bytes == 1 ? 1U : 0U};
    }
    std::uint32_t code = lead & (0x7FU >> bytes);
    for (std::size_t k = 1; k < bytes; ++k) {
        if ((byte(k) & 0xC0U) != 0x80) {
            return {lead, 0};
        }
        code = code << 6U | (byte(k) & 0x3FU);
    }
    constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000}; // NOLINT(*-avoid-c-arrays)
    const bool is_character = code >= least[bytes] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
    return {is_character ? code : lead, is_character ? bytes : 0};
}

/// Ends of lines and paragraphs, and what turns the direction of writing.
bool turns_or_breaks(std::uint32_t code) {
    return (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

/// `control` formats the number of a control character; `kept` is one that stays.
std::string harmless(std::string_view text, fmt::format_string<std::uint32_t&> control, char kept = '\0') {
    std::string safe;
    while (!text.empty()) {
        auto [code, bytes] = first_of(text);
        const bool controls = (code < 0x20 || (code >= 0x7F && code < 0xA0)) && !(kept != '\0' && text.front() == kept);
        if (bytes == 0 || controls) {
            safe += fmt::format(control, code);
        } else if (turns_or_breaks(code)) {
            safe += fmt::format("\\u{:04x}", code);
        } else {
            safe += text.substr(0, bytes);
        }
        text.remove_prefix(bytes == 0 ? 1 : bytes);
    }
    return safe;
}

/// Some characters by what stands for them.
template <class Replacement> std::string replaced(std::string_view text, const Replacement& replacement) {
    std::string safe;
    for (const char c : text) {
        const std::string_view by = replacement(c);
        safe += by.empty() ? std::string_view(&c, 1) : by;
    }
    return safe;
}

} // namespace

std::string shown(std::string_view text) {
    return harmless(text, "\\x{:02x}");
}

std::string shown_lines(std::string_view text) {
    return harmless(text, "\\x{:02x}", '\n');
}

bool is_plain_line(std::string_view text) {
    return shown(text) == text;
}

std::string gnuplot(std::string_view text) {
    return fmt::format("\"{}\"", replaced(shown(text), [](char c) {
                           return c == '"'    ? "\\042"
                                  : c == '$'  ? "\\044"
                                  : c == '\'' ? "\\047"
                                  : c == '@'  ? "\\100"
                                  : c == '\\' ? "\\134"
                                  : c == '`'  ? "\\140"
                                              : "";
                       }));
}

std::string csv(std::string_view text) {
    const std::string safe = fmt::format("{}{}", text.find_first_of("=+-@") == 0 ? "'" : "",
                                         replaced(shown(text), [](char c) { return c == '"' ? "\"\"" : ""; }));
    return safe.find_first_of(",;\"") == std::string::npos ? safe : fmt::format("\"{}\"", safe);
}

std::string markup(std::string_view text) {
    return replaced(shown(text), [](char c) {
        return c == '&'    ? "&amp;"
               : c == '<'  ? "&lt;"
               : c == '>'  ? "&gt;"
               : c == '"'  ? "&quot;"
               : c == '\'' ? "&#39;"
                           : "";
    });
}

std::string json(std::string_view document) {
    return harmless(document, "\\u{:04x}", '\n');
}

std::string in_script(std::string_view document) {
    return replaced(json(document), [](char c) {
        return c == '<' ? "\\u003c" : c == '>' ? "\\u003e" : c == '&' ? "\\u0026" : "";
    });
}

std::string man(std::string_view text) {
    bool begins = true; // of a line: "." and "'" would be macros
    std::string safe;
    for (const char c : shown_lines(text)) {
        safe += begins && (c == '.' || c == '\'') ? "\\&" : "";
        safe += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
        begins = c == '\n';
    }
    return safe;
}

std::string shell(std::string_view word) {
    const bool plain = !word.empty() && word.find_first_of(" \t\n'\"\\$`!*?[](){}<>|&;#~") == std::string_view::npos;
    return plain ? std::string(word)
                 : fmt::format("'{}'", replaced(word, [](char c) { return c == '\'' ? "'\\''" : ""; }));
}

} // namespace isostat::text
