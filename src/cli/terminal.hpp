#pragma once
/// \file
/// The only functions that print: texts from files, names and options pass `text::shown`.

#include "io/text.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace isostat::cli {

/// Prints like `fmt::print`; only the format may break a line or move the cursor.
template <class... Values> void say(std::FILE* out, fmt::format_string<Values...> format, Values&&... values) {
    fmt::print(out, "{}", text::filled(format, std::forward<Values>(values)...));
}
template <class... Values> void say(fmt::format_string<Values...> format, Values&&... values) {
    say(stdout, format, std::forward<Values>(values)...);
}

/// Prints text of several lines, which ends with a line break.
inline void say_lines(const std::string& text, std::FILE* out = stdout) {
    fmt::print(out, "{}", text::shown_lines(text));
}

/// Prints JSON, which its library wrote, on standard output.
inline void say_json(const std::string& document) {
    fmt::print("{}", text::json(document));
}

} // namespace isostat::cli
