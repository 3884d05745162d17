#include "bench/work_precision/report.hpp"

#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace work_precision {

double cpu_seconds() {
    return 1e-3 * bench::cpu_milliseconds();
}

void Table::add(std::vector<std::string> row) {
    if (row.size() != heads_.size()) {
        throw std::logic_error(fmt::format("{}: a row of {} fields below {} heads", name_, row.size(), heads_.size()));
    }
    rows_.push_back(std::move(row));
}

void Table::write_csv(const std::filesystem::path& folder) const {
    std::ofstream csv(folder / (name_ + ".csv"));
    csv << fmt::format("{}\n", fmt::join(heads_, ","));
    for (std::vector<std::string> fields : rows_) {
        for (std::string& f : fields) {
            std::replace(f.begin(), f.end(), ',', ';');
            f = f == "–" ? "nan" : f;
        }
        csv << fmt::format("{}\n", fmt::join(fields, ","));
    }
}

namespace {

/// Numbers as numbers, "–" as nothing.
bench::Cell cell(const std::string& field) {
    char* end = nullptr;
    const double x = std::strtod(field.c_str(), &end);
    if (field == "–") {
        return {};
    }
    return field.empty() || *end != '\0' ? bench::Cell(field) : bench::Cell(x);
}

} // namespace

void Table::write(const Settings& settings) const {
    write_csv(settings.folder);
    std::string text = fmt::format("**{}.** {}\n\n| {} |\n|", name_, caption_, fmt::join(heads_, " | "));
    for (std::size_t k = 0; k < heads_.size(); ++k) {
        text += "---|";
    }
    text += "\n";
    for (const auto& row : rows_) {
        text += fmt::format("| {} |\n", fmt::join(row, " | "));
    }
    std::ofstream(settings.folder / "tables.md", std::ios::app) << text << "\n";
    fmt::print("{}\n", text);
    std::vector<bench::Column> columns;
    for (const std::string& head : heads_) {
        columns.push_back({head, head, ""});
    }
    bench::Table kept(name_, caption_, columns);
    for (const auto& row : rows_) {
        std::vector<bench::Cell> cells;
        for (const std::string& field : row) {
            cells.push_back(cell(field));
        }
        kept.add(cells);
    }
    settings.program->keep(kept);
}

double median(std::vector<double> x) {
    return bench::Sample(std::move(x)).median();
}

double largest(const std::vector<double>& x) {
    return x.empty() ? std::numeric_limits<double>::quiet_NaN() : *std::max_element(x.begin(), x.end());
}

double mean(const std::vector<double>& x) {
    double sum = 0;
    for (const double c : x) {
        sum += c;
    }
    return sum / static_cast<double>(x.size());
}

std::string number(double x) {
    return std::isnan(x) ? std::string("–") : fmt::format("{:.1e}", x);
}

std::string plain(double x) {
    return std::isnan(x) ? std::string("–") : fmt::format("{:.3g}", x);
}

isostat::State prepared(int disks, std::uint64_t seed) {
    isostat::PreparationOptions options{.disks = disks, .seed = seed};
    isostat::PreparationReport report;
    auto state = isostat::prepare(options, report);
    if (!state.ok()) {
        throw std::runtime_error(fmt::format("{} disks, seed {}: {}", disks, seed, state.failure().message()));
    }
    return state.value();
}

void draw(const std::filesystem::path& folder, const std::string& name, const std::string& script) {
    bench::draw(folder, name,
                "set datafile separator ','\nset terminal svg size 760,520 font 'sans,13' background 'white'\nset "
                "grid\nset output '" +
                    name + ".svg'\n" + script);
}

} // namespace work_precision
