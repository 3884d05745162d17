#pragma once
/// \file
/// Text that somebody else wrote (names, titles, words of files), made harmless for whoever reads it. Each language has
/// one function; no such text goes into a file or to the screen without that of its language. JSON has its library.

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace isostat::text {

/// For people: one line of UTF-8 that commands no terminal and no reader. A control character becomes \xNN (ESC \x1b, a
/// line feed \x0a, C1 and DEL too), a byte that is not UTF-8 as well; what reverses or breaks lines in Unicode \u202e.
std::string shown(std::string_view text);

/// The same for text of several lines that is put together from such pieces: line feeds stay.
std::string shown_lines(std::string_view text);

/// Numbers as they are; all else is text that may be foreign.
template <class T> auto safe(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
        return value;
    } else {
        return shown(value);
    }
}
/// Like `fmt::format`; only the format may break a line or move the cursor.
template <class... Values> std::string filled(fmt::format_string<Values...> format, Values&&... values) {
    return fmt::vformat(format, fmt::make_format_args(safe(values)...));
}
/// The same at the end of a text.
template <class... Values> void say(std::string& text, fmt::format_string<Values...> format, Values&&... values) {
    text += filled(format, std::forward<Values>(values)...);
}

/// Whether the text is one line that is shown as it is.
bool is_plain_line(std::string_view text);

/// A string of gnuplot. Quotes, backquotes and what else may mean something are octal numbers: a quote in quotes is not
/// always one character to gnuplot.
std::string gnuplot(std::string_view text);

/// A field of a CSV table, quoted where it must be. A spreadsheet takes none for a formula.
std::string csv(std::string_view text);

/// Between two tags of SVG or HTML, or in the value of an attribute.
std::string markup(std::string_view text);

/// JSON of its library for a terminal: it leaves DEL, C1 and what turns lines as they are, here they are \uNNNN.
std::string json(std::string_view document);

/// JSON that may stand in a script element of HTML: no "<", ">" or "&", which only its strings can hold.
std::string in_script(std::string_view document);

/// Lines of a manual page.
std::string man(std::string_view text);

/// A word of a POSIX shell.
std::string shell(std::string_view word);

} // namespace isostat::text
