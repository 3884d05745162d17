// What a file is, by its content.
#include "io/files.hpp"
#include "io/lines.hpp"
#include "io/numbers.hpp"

#include <isostat/io/state_file.hpp>

#include <algorithm>
#include <vector>

namespace isostat {

namespace {

/// Three rows with one number each: in XYZ the third one has a place at least.
bool begins_with_centres(const std::vector<TextLine>& start) {
    return start.size() >= 3 && std::all_of(start.begin(), start.begin() + 3, [](const TextLine& line) {
               return line.size() == 1 && finite_number(line.field(0));
           });
}

} // namespace

std::string recognise_format(const std::string& marked) {
    const std::string_view text = without_byte_order_mark(marked);
    const std::string source;
    TextLines lines(text, source);
    const auto blank = [](std::string_view line) { return line.find_first_not_of(" \t\r") == std::string_view::npos; };
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) {
        return "";
    }
    if (text[first] == '{') {
        return "state";
    }
    if (text.compare(first, 5, "ITEM:") == 0) {
        return "lammps-dump";
    }
    // Vertex texts and XYZ start with a number of rows; the next row tells them apart.
    TextLines rows = lines;
    std::vector<TextLine> start;
    while (!rows.at_end() && start.size() < 3) {
        const std::string_view line = rows.take("");
        if (start.empty() && (blank(line) || line[line.find_first_not_of(" \t\r")] == '#')) {
            continue;
        }
        start.emplace_back(line, rows.number(), &source);
    }
    const auto is_count = [](const TextLine& line) {
        return line.size() >= 1 && line.field(0).find_first_not_of("0123456789") == std::string_view::npos;
    };
    if (!start.empty() && is_count(start[0]) && start[0].size() > 1 && start[0].field(1) == "x") {
        return "vertex";
    }
    if (!start.empty() && start[0].text().find("L1=") != std::string_view::npos && start[0].size() > 1 &&
        start[0].field(0) == "N") {
        return "braces";
    }
    if (begins_with_centres(start)) {
        return "centres";
    }
    if (start.size() >= 2 && is_count(start[0]) && start[0].size() == 1) {
        const bool numbers = start[1].size() == 5 && finite_number(start[1].field(0)).has_value();
        return numbers || (!start[1].text().empty() && start[1].text().starts_with('#')) ? "vertex" : "xyz";
    }
    constexpr int header_lines = 60;
    for (int k = 0; k < header_lines && !lines.at_end(); ++k) {
        const TextLine line = lines.next("");
        if (line.size() >= 2 && finite_number(line.field(0)) && line.field(1) == "atoms") {
            return "lammps-data";
        }
        const std::string_view word = line.size() > 0 ? line.field(0) : std::string_view();
        if ((word == "format" || word.starts_with("format=")) &&
            line.text().find("isostat-packing") != std::string_view::npos) {
            return "packing";
        }
    }
    return "table";
}

} // namespace isostat
