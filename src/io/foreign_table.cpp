// Rows of numbers under names: x y r text, CSV.
#include "io/foreign_source.hpp"
#include "packing/words.hpp"

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

std::vector<std::string> names_of(const TextLine& line) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < line.size(); ++k) {
        names.emplace_back(line.field(k));
    }
    return names;
}

/// "# x y r", "# x y r; words", "#format x_y_z_r": the names in a comment, or nothing.
std::vector<std::string> names_in_comment(std::string_view line, int number, const std::string& source) {
    line.remove_prefix(line.find('#') + 1);
    std::vector<std::string> names = names_of(TextLine(line, number, &source, separator_of(line)));
    if (const std::size_t end = line.find(';'); end != std::string_view::npos && find_column(names, "x") < 0) {
        names = names_of(TextLine(line.substr(0, end), number, &source, blanks_or_commas)); // words come after them
    }
    if (names.size() == 2 && names[0] == "format") {
        std::string fields = names[1];
        std::replace(fields.begin(), fields.end(), '_', ' ');
        names = names_of(TextLine(fields, number, &source));
    }
    const auto has = [&](const char* name) { return std::find(names.begin(), names.end(), name) != names.end(); };
    return has("x") && has("y") ? names : std::vector<std::string>();
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
bool is_row_of_names(const TextLine& line) {
    for (std::size_t k = 0; k < line.size(); ++k) {
        if (is_value(line.field(k))) {
            return false;
        }
    }
    return line.size() > 0;
}

/// The last comment before the first row that names columns.
TableNames names_in_comments(TextLines& lines) {
    TableNames out;
    while (!lines.at_end() && is_no_row(lines.peek())) {
        const std::string_view line = lines.take("a row");
        if (line.find('#') != std::string_view::npos) {
            if (auto found = names_in_comment(line, lines.number(), lines.source()); !found.empty()) {
                out.names = std::move(found);
                out.line = lines.number();
            }
        }
    }
    return out;
}

} // namespace

TableNames read_table_names(TextLines& lines, const ForeignOptions& options, Raw& raw) {
    TableNames out = names_in_comments(lines);
    if (lines.at_end()) {
        lines.fail("the file ends here: expected rows of numbers");
    }
    out.separator = separator_of(lines.peek());
    const TextLine first(lines.peek(), lines.number() + 1, &lines.source(), out.separator);
    if (is_row_of_names(first)) {
        out.names = names_of(first);
        (void)lines.take("names");
        out.line = lines.number();
    }
    if (!options.columns.empty()) {
        if (!out.names.empty()) {
            raw.notes.push_back(fmt::format("line {} ({}) is taken for names of columns; those stated are used",
                                            out.line, fmt::join(out.names, " ")));
        }
        out.names = options.columns;
    }
    if (out.names.empty()) {
        first.fail(
            first.text(), "first row",
            "names of the columns before it (a row of names, or '# x y r'; where one table is read, --columns x,y,r): "
            "nothing says which column is what");
    }
    for (std::string& name : out.names) {
        name = name == "-" ? "" : name;
    }
    refuse_twice(out.names, out.line == 0 ? lines.source() : fmt::format("{}:{}", lines.source(), out.line));
    return out;
}

Raw read_table(const std::string& text, const std::string& source, const ForeignOptions& options) {
    if (options.frame.value_or(0) != 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: frame {} was asked for: expected frame 0, a table has one",
                                                      source, *options.frame));
    }
    TextLines lines(text, source);
    Raw raw;
    const TableNames header = read_table_names(lines, options, raw);
    const std::string where = header.line == 0 ? source : fmt::format("{}:{}", source, header.line);
    Columns columns;
    for (std::size_t a = 0; a < most_axes; ++a) {
        columns.at[a] = find_column(header.names, axis_names[a]);
    }
    columns.id = find_column(header.names, "id");
    if (columns.at[0] < 0 || columns.at[1] < 0) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: no columns x and y: expected them in the header", where));
    }
    find_size(columns, header.names, options, where, raw);
    find_selection(columns, header.names, options, where);
    Rows rows(columns, source);
    while (lines.find_row()) {
        const TextLine line = lines.next("a row", header.separator);
        line.require_size(header.names.size(), "one value per column");
        rows.add(line, raw);
    }
    rows.finish(raw);
    if (raw.centre.empty()) {
        lines.fail("the file ends here: expected rows of numbers after the names");
    }
    return raw;
}

} // namespace isostat::foreign
