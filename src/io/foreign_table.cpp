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

} // namespace

Raw read_table(const std::string& text, const std::string& source, const ForeignOptions& options) {
    if (options.frame.value_or(0) != 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: frame {} was asked for: expected frame 0, a table has one",
                                                      source, *options.frame));
    }
    Lines lines(text, source);
    std::vector<std::string> names;
    int header = 0;
    for (; !lines.at_end() && (is_blank(lines.peek()) || is_comment(lines.peek()));) {
        const std::string_view line = lines.take("a row");
        if (is_comment(line)) {
            if (auto found = names_in_comment(line, lines.number(), source); !found.empty()) {
                names = std::move(found);
                header = lines.number();
            }
        }
    }
    if (lines.at_end()) {
        lines.fail("the file ends here: expected rows of numbers");
    }
    const char separator = separator_of(lines.peek());
    const Line first(lines.peek(), lines.number() + 1, &source, separator);
    Raw raw;
    if (is_row_of_names(first)) {
        names = names_of(first);
        (void)lines.take("names");
        header = lines.number();
    }
    if (!options.columns.empty()) {
        if (!names.empty()) {
            raw.notes.push_back(fmt::format("line {} ({}) is taken for names of columns; those stated are used", header,
                                            fmt::join(names, " ")));
        }
        names = options.columns;
    }
    if (names.empty()) {
        first.fail(first.text(), "first row",
                   "names of the columns before it ('# x y r' or a row of names), or --columns x,y,r: nothing says "
                   "which column is what");
    }
    const std::string where = header == 0 ? source : fmt::format("{}:{}", source, header);
    for (std::string& name : names) {
        name = name == "-" ? "" : name;
    }
    Columns columns;
    columns.x = find_column(names, "x", where);
    columns.y = find_column(names, "y", where);
    columns.z = find_column(names, "z", where);
    columns.id = find_column(names, "id", where);
    if (columns.x < 0 || columns.y < 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: no columns x and y: expected them in the header", where));
    }
    find_size(columns, names, options, where, raw);
    Rows rows(columns, source);
    while (!lines.at_end()) {
        if (is_blank(lines.peek()) || is_comment(lines.peek())) {
            (void)lines.take("a row");
            continue;
        }
        const Line line = lines.next("a row", separator);
        line.require_size(names.size(), "one value per column");
        rows.add(line, raw);
    }
    rows.finish();
    if (raw.x.empty()) {
        lines.fail("the file ends here: expected rows of numbers after the names");
    }
    return raw;
}

} // namespace isostat::foreign
