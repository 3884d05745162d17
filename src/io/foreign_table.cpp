// Rows of numbers under names: x y r text, CSV.
#include "io/foreign_source.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace isostat::foreign {

namespace {

char separator_of(std::string_view line) {
    for (const char c : {';', ',', '\t'}) {
        if (line.find(c) != std::string_view::npos) {
            return c;
        }
    }
    return ' ';
}

std::vector<std::string> names_of(const Line& line) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < line.size(); ++k) {
        names.emplace_back(line.field(k));
    }
    return names;
}

/// "# x y r", "#format x_y_z_r": the names in a comment, or nothing.
std::vector<std::string> names_in_comment(std::string_view line, int number, const std::string& source) {
    line.remove_prefix(line.find('#') + 1);
    std::vector<std::string> names = names_of(Line(line, number, &source, separator_of(line)));
    if (names.size() == 2 && names[0] == "format") {
        std::string fields = names[1];
        std::replace(fields.begin(), fields.end(), '_', ' ');
        names = names_of(Line(fields, number, &source));
    }
    const auto has = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
    return has("x") && has("y") ? names : std::vector<std::string>();
}

bool is_blank(std::string_view line) {
    return line.find_first_not_of(" \t\r") == std::string_view::npos;
}
bool is_comment(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    return first != std::string_view::npos && line[first] == '#';
}

/// A number, or what stands for one that is missing or that other programs write: not a name of a column.
bool is_value(std::string_view field) {
    std::string word(field.substr(field.find_first_not_of("+-") == 1 ? 1 : 0));
    std::transform(word.begin(), word.end(), word.begin(),
                   [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    static constexpr std::array<std::string_view, 7> missing{"nan", "inf", "infinity", "na", "n/a", "null", "none"};
    const bool digit = !word.empty() && (std::isdigit(static_cast<unsigned char>(word[0])) != 0 || word[0] == '.');
    return digit || std::find(missing.begin(), missing.end(), word) != missing.end();
}

/// A row without any value is taken for names; all others are disks.
bool is_row_of_names(const Line& line) {
    for (std::size_t k = 0; k < line.size(); ++k) {
        if (is_value(line.field(k))) {
            return false;
        }
    }
    return line.size() > 0;
}

/// Names of columns, and the line they stand in; 0: no line of the file names them.
struct Header {
    std::vector<std::string> names;
    int line = 0;
};

/// From the comments before the first row, a row of names, or the options; reads up to the first row of numbers.
Header read_header(Lines& lines, const std::string& source, const ForeignOptions& options, char separator_of_rows,
                   Raw& raw, Header header) {
    const Line first(lines.peek(), lines.number() + 1, &source, separator_of_rows);
    if (is_row_of_names(first)) {
        header.names = names_of(first);
        (void)lines.take("names");
        header.line = lines.number();
    }
    if (!options.columns.empty()) {
        if (!header.names.empty()) {
            raw.notes.push_back(fmt::format("line {} ({}) is taken for names of columns; those stated are used",
                                            header.line, fmt::join(header.names, " ")));
        }
        header.names = options.columns;
    }
    if (header.names.empty()) {
        first.fail(first.text(), "first row",
                   "names of the columns before it ('# x y r' or a row of names), or --columns x,y,r: nothing says "
                   "which column is what");
    }
    for (std::string& name : header.names) {
        name = name == "-" ? "" : name;
    }
    return header;
}

/// The last comment before the first row that names columns.
Header header_in_comments(Lines& lines, const std::string& source) {
    Header header;
    while (!lines.at_end() && (is_blank(lines.peek()) || is_comment(lines.peek()))) {
        const std::string_view line = lines.take("a row");
        if (is_comment(line)) {
            if (auto found = names_in_comment(line, lines.number(), source); !found.empty()) {
                header = {std::move(found), lines.number()};
            }
        }
    }
    return header;
}

} // namespace

Raw read_table(const std::string& text, const std::string& source, const ForeignOptions& options) {
    if (options.frame.value_or(0) != 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: frame {} was asked for: expected frame 0, a table has one",
                                                      source, *options.frame));
    }
    Lines lines(text, source);
    Header header = header_in_comments(lines, source);
    if (lines.at_end()) {
        lines.fail("the file ends here: expected rows of numbers");
    }
    const char separator = separator_of(lines.peek());
    Raw raw;
    header = read_header(lines, source, options, separator, raw, std::move(header));
    const std::string where = header.line == 0 ? source : fmt::format("{}:{}", source, header.line);
    Columns columns;
    columns.x = find_column(header.names, "x", where);
    columns.y = find_column(header.names, "y", where);
    columns.z = find_column(header.names, "z", where);
    columns.id = find_column(header.names, "id", where);
    if (columns.x < 0 || columns.y < 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: no columns x and y: expected them in the header", where));
    }
    find_size(columns, header.names, options, where, raw);
    find_selection(columns, header.names, options, where);
    Rows rows(columns, source);
    while (!lines.at_end()) {
        if (is_blank(lines.peek()) || is_comment(lines.peek())) {
            (void)lines.take("a row");
            continue;
        }
        const Line line = lines.next("a row", separator);
        line.require_size(header.names.size(), "one value per column");
        rows.add(line, raw);
    }
    rows.finish(raw);
    if (raw.x.empty()) {
        lines.fail("the file ends here: expected rows of numbers after the names");
    }
    return raw;
}

} // namespace isostat::foreign
