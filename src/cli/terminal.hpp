#pragma once
/// \file
/// The terminal: the only functions that print (texts from files, names and options pass `text::shown`), and Ctrl-C and
/// SIGTERM.

#include "io/text.hpp"

#include <fmt/format.h>

#include <atomic>
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

/// From now on SIGINT and SIGTERM set a flag: the work stops at its next safe point and leaves valid files. A second
/// signal ends the program at once (files are still valid up to the last record). Only for commands that test the flag:
/// the others end at the first signal.
void catch_interrupts();

/// From now on SIGINT and SIGTERM end the program as usual, after a line. For long commands without a safe point, which
/// write their files as a whole or not at all.
void end_at_interrupts();

/// At a limit of the file size writing fails with its message, instead of a signal.
void ignore_file_size_signals();

/// The flag, for options that take one.
const std::atomic<bool>& stop_flag();

} // namespace isostat::cli
