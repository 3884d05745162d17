// Reads rows of numbers under names: x y r text, CSV.
#include "foreign/source.hpp"
#include "io/numbers.hpp"
#include "packing/words.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>

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
    return {line.fields().begin(), line.fields().end()};
}

/// The words of a comment such as "# x y r", "# x y r; words" or "#format x_y_z_r".
std::vector<std::string> words_of_comment(std::string_view line, int number, const std::string& source) {
    line.remove_prefix(line.find_first_of("#%") + 1);
    std::vector<std::string> names = names_of(TextLine(line, number, &source, separator_of(line)));
    if (const std::size_t end = line.find(';'); end != std::string_view::npos && find_column(names, "x") < 0) {
        names = names_of(TextLine(line.substr(0, end), number, &source, blanks_or_commas)); // other words follow
    }
    if (names.size() == 2 && names[0] == "format") {
        std::string fields = names[1];
        std::ranges::replace(fields, '_', ' ');
        names = names_of(TextLine(fields, number, &source));
    }
    return names;
}

/// Whether a field is a number, or a mark for a missing or infinite number, and so no name of a column.
bool is_value(std::string_view field) {
    std::string word(field.substr(field.find_first_not_of("+-") == 1 ? 1 : 0));
    std::ranges::transform(word, word.begin(),
                           [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    static constexpr std::array<std::string_view, 7> missing{"nan", "inf", "infinity", "na", "n/a", "null", "none"};
    const bool digit = !word.empty() && (std::isdigit(static_cast<unsigned char>(word[0])) != 0 || word[0] == '.');
    return digit || std::ranges::find(missing, word) != missing.end();
}

/// Whether a row without any value is one of names; every other row is a disk.
bool are_names(const std::vector<std::string>& words) {
    return !words.empty() && std::ranges::none_of(words, [](const auto& word) { return is_value(word); });
}

/// Takes the names in the last comment before the first row that has columns x and y. Otherwise, with `any` columns, it
/// takes the last comment if this has as many words as the row has fields.
void take_names_in_comments(TextLines& lines, bool any, TableNames& out) {
    std::vector<std::string> last;
    int line = 0;
    while (!lines.at_end() && is_no_row(lines.peek())) {
        const std::string_view comment = lines.take("a row");
        if (comment.find_first_of("#%") == std::string_view::npos) {
            continue;
        }
        last = words_of_comment(comment, lines.number(), lines.source());
        line = lines.number();
        if (find_column(last, "x") >= 0 && find_column(last, "y") >= 0) {
            out.names = last;
            out.line = line;
        }
    }
    const std::string_view row = lines.peek();
    if (any && out.names.empty() && are_names(last) &&
        last.size() == TextLine(row, line, &lines.source(), separator_of(row)).size()) {
        out.names = std::move(last);
        out.line = line;
    }
}

/// In characters; std::regex recurses for each character, and a longer line could overflow its stack.
constexpr std::size_t longest_header = 4096;

/// Reads "# box 0:4,0:2, tilt 0.5, periodic along xy", the first line of our own tables, and ignores other comments.
void take_box_of_comment(std::string_view line, int number, Raw& raw) {
    static const std::regex form(R"(# box ([^ ,:]+):([^ ,:]+),([^ ,:]+):([^ ,:]+)(?:,([^ ,:]+):([^ ,:]+))?)"
                                 R"((?:, tilt ([^ ,]+)(?: ([^ ,]+) ([^ ,]+))?, periodic along ([xyz]+))?[ \r]*)");
    std::match_results<std::string_view::const_iterator> found;
    if (line.size() > longest_header || !std::regex_match(line.begin(), line.end(), found, form)) {
        return;
    }
    Bounds out;
    std::array<double, 2 * most_axes + most_tilts> numbers{};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        const std::string word = found[static_cast<std::size_t>(k) + 1];
        const auto value = finite_number(word);
        if (!value && !word.empty()) {
            return;
        }
        numbers[k] = value.value_or(0);
        out.sides[0].see(word);
    }
    out.box.emplace();
    for (std::size_t a = 0; a < most_axes; ++a) {
        (*out.box)[a] = {numbers[2 * a], numbers[2 * a + 1]};
        out.sides[a] = out.sides[0];
        out.boundary[a] = found[2 * most_axes + most_tilts + 1].str().find(axis_names[a][0]) == std::string::npos
                              ? Boundary::open
                              : Boundary::periodic;
    }
    std::copy_n(numbers.begin() + 2 * most_axes, most_tilts, out.tilt.begin());
    out.place = fmt::format("line {}", number);
    static_cast<Bounds&>(raw) = out;
}

} // namespace

TableNames read_table_names(TextLines& lines, const ForeignOptions& options, Raw& raw, bool any) {
    TableNames out;
    take_box_of_comment(lines.peek(), lines.number() + 1, raw);
    take_names_in_comments(lines, any, out);
    if (lines.at_end()) {
        lines.fail("the file ends here: expected rows of numbers");
    }
    out.separator = separator_of(lines.peek());
    const TextLine first(lines.peek(), lines.number() + 1, &lines.source(), out.separator);
    if (std::vector<std::string> names = names_of(first); are_names(names)) {
        out.names = std::move(names);
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
        first.fail(first.text(), "first row",
                   "names of the columns before it (a row of names, or '# x y r'; where one table is read, --columns "
                   "x,y,r): nothing says which column is what");
    }
    return out;
}

Raw read_table(const std::string& text, const std::string& source, const ForeignOptions& options) {
    TextLines lines(text, source, static_cast<int>(options.skip));
    Raw raw;
    const TableNames header = read_table_names(lines, options, raw);
    Columns columns =
        find_columns(header.names, options, header.line == 0 ? source : fmt::format("{}:{}", source, header.line), raw);
    const std::size_t width = columns.names.size();
    Rows rows(std::move(columns), source);
    while (lines.find_row()) {
        const TextLine line = lines.next("a row", header.separator);
        line.require_size(width, "one value per column; --skip N passes over lines before them");
        rows.add(line, raw);
    }
    rows.finish(raw);
    if (raw.centre.empty()) {
        lines.fail("the file ends here: expected rows of numbers after the names");
    }
    return raw;
}

/// Reads N = 2 ,L1= { 4 , 0 } ,L2= { 0.5 , 2 } ,P = 0.1, then rows x , y , r , between braces (jambashbulk).
Raw read_braces(const std::string& text, const std::string& source, const ForeignOptions& options) {
    TextLines lines(text, source);
    Raw raw;
    (void)lines.find_row();
    const TextLine header = lines.next_row("N = .., L1= { .. }, L2= { .. }", 0);
    if (header.text().size() > longest_header) {
        header.fail(header.text().substr(0, 40), "header", "at most {} characters", longest_header);
    }
    static const std::regex vector(R"(L([12])\s*=\s*\{\s*([^\s,{}]+)\s*,\s*([^\s,{}]+)\s*\})");
    PerAxis<PerAxis<double>> periods{{{}, {}, {0, 0, 1}}};
    for (auto at = std::cregex_iterator(header.text().begin(), header.text().end(), vector);
         at != std::cregex_iterator(); ++at) {
        const std::string entries = (*at)[2].str() + " " + (*at)[3].str() + " 0";
        take_vector(TextLine(entries, header.number(), &source), periods[(*at)[1] == "1" ? 0 : 1], raw);
    }
    raw.take_vectors(periods, {});
    raw.boundary.fill(Boundary::periodic);
    Columns columns = find_columns({"x", "y", "r"}, options, header.place(), raw);
    const std::size_t width = columns.names.size();
    Rows rows(std::move(columns), source);
    lines.next_row("{", 1);
    for (TextLine row = lines.next_row("a row, or }", 0); row.text().find('}') == std::string_view::npos;
         row = lines.next_row("a row, or }", 0)) {
        row.require_size(width, "x , y , r");
        rows.add(row, raw);
    }
    static const std::regex number(R"(\bN\s*=\s*(\d+)\b)");
    std::cmatch announced;
    if (!std::regex_search(header.text().begin(), header.text().end(), announced, number) ||
        announced[1] != std::to_string(rows.seen())) {
        header.fail(header.text(), "header", "N = {}, so many rows there are", rows.seen());
    }
    rows.finish(raw);
    return raw;
}

} // namespace isostat::foreign
