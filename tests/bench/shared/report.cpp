#include "bench/shared/report.hpp"

#include "core/memory.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace bench {

namespace {

using Json = nlohmann::ordered_json;

std::string number(const std::string& format, double x) {
    return std::isnan(x) ? std::string("–") : fmt::vformat(format, fmt::make_format_args(x));
}

struct InMarkdown {
    const Column& column;
    std::string operator()(std::monostate) const { return "–"; }
    std::string operator()(long x) const { return fmt::to_string(x); }
    std::string operator()(const std::string& x) const { return x; }
    std::string operator()(bool x) const { return x ? "yes" : "no"; }
    std::string operator()(double x) const { return number(column.format, x); }
    std::string operator()(const Sample& x) const {
        const std::string middle = number(column.format, x.median());
        return x.values().size() < 2
                   ? middle
                   : fmt::format("{} ({}-{})", middle, number(column.format, x.low()), number(column.format, x.high()));
    }
};

struct InJson {
    Json operator()(std::monostate) const { return nullptr; }
    Json operator()(const Sample& x) const {
        return {{"median", x.median()}, {"low", x.low()}, {"high", x.high()}, {"values", x.values()}};
    }
    template <class T> Json operator()(const T& x) const { return x; }
};

struct InCsv {
    std::string operator()(std::monostate) const { return "nan"; }
    std::string operator()(long x) const { return fmt::to_string(x); }
    std::string operator()(std::string x) const {
        std::ranges::replace(x, ',', ';');
        return x;
    }
    std::string operator()(bool x) const { return x ? "1" : "0"; }
    std::string operator()(double x) const { return fmt::format("{:.6g}", x); }
    std::string operator()(const Sample& x) const { return fmt::format("{:.6g}", x.median()); }
};

std::string processor() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "unknown";
}

} // namespace

Table::Table(std::string name, std::string caption, std::vector<Column> columns)
    : name_(std::move(name)), caption_(std::move(caption)), columns_(std::move(columns)) {}

void Table::add(std::vector<Cell> row) {
    if (row.size() != columns_.size()) {
        throw std::logic_error(
            fmt::format("{}: a row of {} fields below {} heads", name_, row.size(), columns_.size()));
    }
    rows_.push_back(std::move(row));
}

std::string Table::markdown() const {
    std::string text = "|";
    for (const Column& column : columns_) {
        text += fmt::format(" {} |", column.heading);
    }
    text += "\n|";
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        text += "---|";
    }
    text += "\n";
    for (const std::vector<Cell>& row : rows_) {
        text += "|";
        for (std::size_t k = 0; k < row.size(); ++k) {
            text += fmt::format(" {} |", std::visit(InMarkdown{columns_[k]}, row[k]));
        }
        text += "\n";
    }
    return text;
}

void Table::write_csv(const std::filesystem::path& file) const {
    std::ofstream out(file);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        out << (k == 0 ? "" : ",") << columns_[k].key;
    }
    out << "\n";
    for (const std::vector<Cell>& row : rows_) {
        for (std::size_t k = 0; k < row.size(); ++k) {
            out << (k == 0 ? "" : ",") << std::visit(InCsv{}, row[k]);
        }
        out << "\n";
    }
}

struct Program::Implementation {
    std::string name;
    CLI::App app;
    std::string json;
    std::vector<std::string> arguments;
    Json tables = Json::array();
};

Program::Program(std::string name, std::string description) : implementation_(std::make_unique<Implementation>()) {
    isostat::keep_freed_memory(); // as the program isostat does
    implementation_->name = std::move(name);
    implementation_->app.name(implementation_->name);
    implementation_->app.description(std::move(description));
    option("--json", implementation_->json, "file for the tables");
}

Program::~Program() = default;

void Program::option(const std::string& name, int& value, const std::string& help) {
    implementation_->app.add_option(name, value, help)->capture_default_str();
}

void Program::option(const std::string& name, std::string& value, const std::string& help) {
    implementation_->app.add_option(name, value, help)->capture_default_str();
}

void Program::flag(const std::string& name, bool& value, const std::string& help) {
    implementation_->app.add_flag(name, value, help);
}

void Program::words(const std::string& name, std::vector<std::string>& values, const std::string& help) {
    implementation_->app.add_option(name, values, help)->capture_default_str();
}

void Program::parse(int argc, char** argv) {
    implementation_->arguments.assign(argv + 1, argv + argc);
    try {
        implementation_->app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(implementation_->app.exit(error) == 0 ? 0 : 64);
    }
}

void Program::show(const Table& table) {
    fmt::print("\n{}\n\n{}", table.caption_, table.markdown());
    std::fflush(stdout);
    keep(table);
}

void Program::keep(const Table& table) {
    Json columns = Json::array();
    for (const Column& c : table.columns_) {
        columns.push_back({{"key", c.key}, {"heading", c.heading}, {"unit", c.unit}});
    }
    Json rows = Json::array();
    for (const std::vector<Cell>& row : table.rows_) {
        Json object = Json::object();
        for (std::size_t k = 0; k < row.size(); ++k) {
            object[table.columns_[k].key] = std::visit(InJson{}, row[k]);
        }
        rows.push_back(std::move(object));
    }
    implementation_->tables.push_back(
        {{"name", table.name_}, {"caption", table.caption_}, {"columns", columns}, {"rows", rows}});
}

int Program::finish(bool holds) const {
    if (!implementation_->json.empty()) {
        std::ofstream file(implementation_->json);
        file << Json{{"program", implementation_->name},
                     {"arguments", implementation_->arguments},
                     {"isostat", BENCH_VERSION},
                     {"compiler", "g++ " __VERSION__},
                     {"flags", BENCH_FLAGS},
                     {"processor", processor()},
                     {"processors", std::thread::hardware_concurrency()},
                     {"clock", "CPU time of one thread, unless a column says otherwise"},
                     {"holds", holds},
                     {"tables", implementation_->tables}}
                    .dump(1)
             << "\n";
        if (!file.flush()) {
            fmt::print(stderr, "{}: cannot write {}\n", implementation_->name, implementation_->json);
            return 74;
        }
    }
    return holds ? 0 : 1;
}

void draw(const std::filesystem::path& folder, const std::string& name, const std::string& script) {
    // Dark and light in turn: told apart in grey print too, where points and dashes do not do it.
    constexpr const char* colours[] = {"#12365a", "#e07b1a", "#3f9a5c", "#a61c3c",
                                       "#8a4fb0", "#c2a000", "#2f8f9d", "#555555"};
    std::string palette;
    for (std::size_t k = 0; k < std::size(colours); ++k) {
        palette += fmt::format("set linetype {} lc rgb '{}' pt {}\n", k + 1, colours[k], 5 + 2 * (k % 4));
    }
    std::ofstream(folder / (name + ".gp")) << palette << script;
    const auto here = std::filesystem::current_path();
    std::filesystem::current_path(folder);
    if (std::system(("gnuplot " + name + ".gp").c_str()) != 0) {
        fmt::print(stderr, "no figure {}: gnuplot failed\n", name);
    }
    std::filesystem::current_path(here);
}

} // namespace bench
