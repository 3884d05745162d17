#include "io/files.hpp"
#include "io/record_text.hpp"

#include <isostat/core/error.hpp>
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

/// One row by the names of its columns.
class Fields {
  public:
    Fields(std::string_view content, std::string where, const std::vector<std::string>& columns)
        : columns_(columns), where_(std::move(where)) {
        for (std::size_t at = 0; at <= content.size();) {
            const std::size_t comma = std::min(content.find(',', at), content.size());
            fields_.push_back(content.substr(at, comma - at));
            at = comma + 1;
        }
        if (fields_.size() != columns_.size()) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: {} columns: expected {}", where_, fields_.size(), columns_.size()));
        }
    }
    [[nodiscard]] double number(const char* name) const {
        const auto index = std::find(columns_.begin(), columns_.end(), name) - columns_.begin();
        return column(name, fields_[static_cast<std::size_t>(index)], where_);
    }
    [[nodiscard]] int integer(const char* name) const {
        constexpr double largest = std::numeric_limits<int>::max();
        const double value = number(name);
        if (!(std::abs(value) <= largest) || value != std::trunc(value)) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: {} is {}: expected an integer", where_, name, value));
        }
        return static_cast<int>(value);
    }

  private:
    const std::vector<std::string>& columns_;
    std::string where_;
    std::vector<std::string_view> fields_;
};

EquilibriumRow row_of(const Fields& fields) {
    EquilibriumRow row;
    row.number = fields.integer("number");
    row.previous = fields.integer("previous");
    row.segment = fields.integer("segment");
    row.stress = fields.number("sigma2");
    row.ratio = fields.number("ratio");
    row.strain1 = fields.number("eps1");
    row.strain2 = fields.number("eps2");
    row.solid_fraction = fields.number("solid_fraction");
    row.arcs = fields.integer("arcs");
    row.rattlers = fields.integer("rattlers");
    row.backbone = fields.integer("backbone");
    row.hyperstaticity = fields.integer("h");
    row.stress_low = fields.number("sigma2_low");
    row.stress_high = fields.number("sigma2_high");
    row.min_force = fields.number("min_force");
    row.min_gap = fields.number("min_gap");
    row.margin = fields.number("margin");
    row.proved = fields.integer("proved") == 1;
    return row;
}

} // namespace

std::vector<EquilibriumRow> read_equilibria(const std::filesystem::path& path) {
    if (std::filesystem::exists(path) && std::filesystem::file_size(path) == 0) {
        return {}; // columns are named with the first row
    }
    const std::string content_of_file = read_text(path);
    const std::string_view text = without_byte_order_mark(content_of_file);
    std::vector<EquilibriumRow> rows;
    std::vector<std::string> columns;
    std::size_t begin = 0;
    for (int line = 1; begin < text.size(); ++line) {
        const std::size_t end = text.find('\n', begin);
        if (end == std::string::npos) {
            break; // a row still being written by a run that was killed
        }
        const std::string_view content = text.substr(begin, end - begin);
        begin = end + 1;
        if (line > 1) {
            rows.push_back(row_of(Fields(content, fmt::format("{}:{}", path.string(), line), columns)));
        } else {
            columns = equilibria_columns(named_columns(text, path.string()));
        }
    }
    return rows;
}

} // namespace isostat
