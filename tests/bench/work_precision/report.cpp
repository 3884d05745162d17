#include "bench/work_precision/report.hpp"

#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace work_precision {

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
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

void Table::write(const std::filesystem::path& folder) const {
    write_csv(folder);
    std::string text = fmt::format("**{}.** {}\n\n| {} |\n|", name_, caption_, fmt::join(heads_, " | "));
    for (std::size_t k = 0; k < heads_.size(); ++k) {
        text += "---|";
    }
    text += "\n";
    for (const auto& row : rows_) {
        text += fmt::format("| {} |\n", fmt::join(row, " | "));
    }
    std::ofstream(folder / "tables.md", std::ios::app) << text << "\n";
    fmt::print("{}\n", text);
}

double median(std::vector<double> x) {
    if (x.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::sort(x.begin(), x.end());
    return x.size() % 2 == 1 ? x[x.size() / 2] : 0.5 * (x[x.size() / 2 - 1] + x[x.size() / 2]);
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

isostat::State<2> prepared(int disks, std::uint64_t seed) {
    isostat::PreparationOptions options;
    options.disks = disks;
    options.seed = seed;
    isostat::PreparationReport<2> report;
    auto state = isostat::prepare<2>(options, report);
    if (!state.ok()) {
        throw std::runtime_error(fmt::format("{} disks, seed {}: {}", disks, seed, state.failure().message));
    }
    return state.value();
}

void draw(const std::filesystem::path& folder, const std::string& name, const std::string& script) {
    std::ofstream(folder / (name + ".gp")) << "set datafile separator ','\nset terminal svg size 760,520 font "
                                              "'sans,13' background 'white'\nset grid\nset output '"
                                           << name << ".svg'\n"
                                           << script;
    const auto here = std::filesystem::current_path();
    std::filesystem::current_path(folder);
    if (std::system(("gnuplot " + name + ".gp").c_str()) != 0) {
        fmt::print(stderr, "no figure {}: gnuplot failed\n", name);
    }
    std::filesystem::current_path(here);
}

} // namespace work_precision
