#pragma once
// What every program here has in common: its options, its tables as Markdown on the standard output, and the same
// tables with `--json FILE`:
//   {"program": ..., "arguments": [...], "isostat": version, "compiler": ..., "flags": ..., "processor": ..., "clock":
//   ..., "tables": [{"name": ..., "caption": ..., "columns": [{"key": ..., "heading": ..., "unit": ...}],
//   "rows": [{key: value, ...}]}]}
// A repeated measurement is {"median": ..., "low": ..., "high": ..., "values": [...]}, an empty field null.

#include "bench/shared/sample.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace bench {

/// An empty field, a count, a word, a yes or no, one number, or several of the same.
using Cell = std::variant<std::monostate, long, std::string, bool, double, Sample>;

struct Column {
    std::string key;               ///< in JSON
    std::string heading;           ///< in Markdown
    std::string unit;              ///< "ms", "KLU", "UMFPACK", "" for what has none
    std::string format = "{:.3g}"; ///< of a number
};

class Table {
  public:
    /// `name` is unique in its program; `caption` tells what is measured, of what, and what counts.
    Table(std::string name, std::string caption, std::vector<Column> columns);
    /// \throws std::logic_error when there are more or fewer cells than columns
    void add(std::vector<Cell> row);
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const std::string& caption() const { return caption_; }
    /// Heads and rows; a sample is "median (low-high)".
    [[nodiscard]] std::string markdown() const;
    /// Heads (keys) and rows; of a sample the median; a comma in a word becomes a semicolon.
    void write_csv(const std::filesystem::path& file) const;

  private:
    friend class Program;
    std::string name_, caption_;
    std::vector<Column> columns_;
    std::vector<std::vector<Cell>> rows_;
};

/// Command line and results of one program.
class Program {
  public:
    /// `name` as on the command line; the description is the text of --help.
    Program(std::string name, std::string description);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// Options with a value ("--name"), flags, and words without a name. The value is the default.
    void option(const std::string& name, int& value, const std::string& help);
    void option(const std::string& name, std::string& value, const std::string& help);
    void flag(const std::string& name, bool& value, const std::string& help);
    void words(const std::string& name, std::vector<std::string>& values, const std::string& help);
    /// Ends the program where there is nothing to do (--help; bad usage: status 64).
    void parse(int argc, char** argv);

    /// Prints the table, and keeps it.
    void show(const Table& table);
    /// Keeps it for the file of `--json` only.
    void keep(const Table& table);
    /// Writes the file of `--json`; 0 when everything held, else 1 (74 when the file cannot be written).
    [[nodiscard]] int finish(bool holds = true) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Runs gnuplot on NAME.gp in the folder; says so when there is none.
void draw(const std::filesystem::path& folder, const std::string& name, const std::string& script);

} // namespace bench
