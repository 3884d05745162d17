#include "io/record_text.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/files.hpp>
#include <isostat/io/run_directory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

/// Unlike `Row::number` it takes inf: an unbounded interval.
double column(const std::string& name, std::string_view field, const std::string& where) {
    double value = 0;
    const char* const end = field.data() + field.size();
    const auto [stop, error] = std::from_chars(field.data(), end, value);
    if (error != std::errc() || stop != end) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: {} is '{}': expected a number", where, name, field));
    }
    return value;
}

} // namespace

std::vector<EquilibriumRow> read_equilibria(const std::filesystem::path& path) {
    const std::string content_of_file = read_text(path);
    const std::string_view text = without_byte_order_mark(content_of_file);
    const std::vector<std::string>& columns = equilibria_columns();
    const auto index = [&](const char* name) {
        return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin());
    };
    std::vector<EquilibriumRow> rows;
    std::size_t begin = 0;
    for (int line = 1; begin < text.size(); ++line) {
        const std::size_t end = text.find('\n', begin);
        if (end == std::string::npos) {
            break; // a row still being written by a run that was killed
        }
        const std::string_view content = text.substr(begin, end - begin);
        begin = end + 1;
        if (line == 1) {
            if (std::string(content) + "\n" != equilibria_header()) {
                throw Error(ErrorKind::bad_input,
                            fmt::format("{}:{}: the names of the columns are not those of this program: expected {}",
                                        path.string(), line, equilibria_header()));
            }
            continue;
        }
        std::vector<std::string_view> fields;
        for (std::size_t at = 0; at <= content.size();) {
            const std::size_t comma = std::min(content.find(',', at), content.size());
            fields.push_back(content.substr(at, comma - at));
            at = comma + 1;
        }
        const std::string where = fmt::format("{}:{}", path.string(), line);
        if (fields.size() != columns.size()) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: {} columns: expected {}", where, fields.size(), columns.size()));
        }
        const auto number = [&](const char* name) { return column(name, fields[index(name)], where); };
        const auto integer = [&](const char* name) {
            constexpr double largest = std::numeric_limits<int>::max();
            const double value = number(name);
            if (!(std::abs(value) <= largest) || value != std::trunc(value)) {
                throw Error(ErrorKind::bad_input, fmt::format("{}: {} is {}: expected an integer", where, name, value));
            }
            return static_cast<int>(value);
        };
        EquilibriumRow& row = rows.emplace_back();
        row.number = integer("number");
        row.previous = integer("previous");
        row.segment = integer("segment");
        row.stress = number("sigma2");
        row.ratio = number("ratio");
        row.strain1 = number("eps1");
        row.strain2 = number("eps2");
        row.solid_fraction = number("solid_fraction");
        row.arcs = integer("arcs");
        row.rattlers = integer("rattlers");
        row.backbone = integer("backbone");
        row.hyperstaticity = integer("h");
        row.stress_low = number("sigma2_low");
        row.stress_high = number("sigma2_high");
        row.min_force = number("min_force");
        row.min_gap = number("min_gap");
        row.margin = number("margin");
        row.proved = integer("proved") == 1;
    }
    return rows;
}

} // namespace isostat
