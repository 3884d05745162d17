#pragma once
/// \file
/// The only way to the terminal: what files, names and options say passes `text::shown`.

#include "io/text.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <type_traits>

namespace isostat::cli {

namespace terminal {

/// Numbers as they are; all else is text that may be foreign.
template <class T> auto safe(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
        return value;
    } else {
        return text::shown(value);
    }
}

} // namespace terminal

/// Prints like `fmt::print`; only the format may break a line or move the cursor.
template <class... Values> void say(std::FILE* out, fmt::format_string<Values...> format, Values&&... values) {
    fmt::vprint(out, format, fmt::make_format_args(terminal::safe(values)...));
}
template <class... Values> void say(fmt::format_string<Values...> format, Values&&... values) {
    say(stdout, format, std::forward<Values>(values)...);
}

/// Prints text of several lines; the last one ends itself.
inline void say_lines(const std::string& text, std::FILE* out = stdout) {
    fmt::print(out, "{}", text::shown_lines(text));
}

/// Prints JSON, which its library wrote, on standard output.
inline void say_json(const std::string& document) {
    fmt::print("{}", text::json(document));
}

} // namespace isostat::cli
