#include "io/files.hpp"
#include "io/numbers.hpp"
#include "io/record_text.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/run_directory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

/// Beyond it sums and differences of columns overflow; no run comes near.
constexpr double largest = 1e300;

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
    /// Finite.
    [[nodiscard]] double number(const char* name) const {
        const auto value = finite_number(field(name));
        if (!value || std::abs(*value) > largest) {
            fail(name, "a finite number");
        }
        return *value;
    }
    /// An interval may be unbounded, a smallest of nothing is inf.
    [[nodiscard]] double number_or_infinite(const char* name) const {
        const std::string_view text = field(name);
        return text == "inf" ? HUGE_VAL : text == "-inf" ? -HUGE_VAL : number(name);
    }
    [[nodiscard]] int integer(const char* name, int lowest) const {
        const auto value = plain_integer(field(name));
        if (!value || *value < lowest || *value > std::numeric_limits<int>::max()) {
            fail(name, fmt::format("an integer from {}", lowest));
        }
        return static_cast<int>(*value);
    }

  private:
    [[nodiscard]] std::string_view field(const char* name) const {
        const auto index = std::find(columns_.begin(), columns_.end(), name) - columns_.begin();
        return fields_[static_cast<std::size_t>(index)];
    }
    [[noreturn]] void fail(const char* name, const std::string& expected) const {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{}: {} is '{}': expected {}", where_, name, field(name), expected));
    }
    const std::vector<std::string>& columns_;
    std::string where_;
    std::vector<std::string_view> fields_;
};

EquilibriumRow row_of(const Fields& fields) {
    EquilibriumRow row;
    row.number = fields.integer("number", 0);
    row.previous = fields.integer("previous", -1);
    row.segment = fields.integer("segment", 0);
    row.stress = fields.number("sigma2");
    row.ratio = fields.number("ratio");
    row.strain1 = fields.number("eps1");
    row.strain2 = fields.number("eps2");
    row.solid_fraction = fields.number("solid_fraction");
    row.arcs = fields.integer("arcs", 0);
    row.rattlers = fields.integer("rattlers", 0);
    row.backbone = fields.integer("backbone", 0);
    row.hyperstaticity = fields.integer("h", 0);
    row.stress_low = fields.number_or_infinite("sigma2_low");
    row.stress_high = fields.number_or_infinite("sigma2_high");
    row.min_force = fields.number_or_infinite("min_force");
    row.min_gap = fields.number_or_infinite("min_gap");
    row.margin = fields.number_or_infinite("margin");
    row.proved = fields.integer("proved", 0) == 1;
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
