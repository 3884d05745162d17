#pragma once
/// \file
/// equilibria.csv as text, both ways.

#include "io/record_text.hpp"

#include <isostat/io/run_directory.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace isostat {

/// In both columns of a contact that there is not, and in the second one of a held coordinate.
inline constexpr int no_contact = -9;
/// The lowest number of a wall in the second column.
inline constexpr int last_wall = wall_facts.back().column.back();
/// In the second column, of a bar to disk j: that less j.
inline constexpr int first_bar = -10;
/// Columns i and j of a contact: see `equilibria_columns`.
std::pair<int, int> contact_columns(const Contact& contact);

/// Of a run whose first line names those; in the plane the axes of the measures are those of a loaded axis 1.
RecordColumns record_columns(const MoreColumns& more);

/// Columns of integers, in whatever run; in all others are numbers, infinite ones among them.
const std::set<std::string>& integer_columns();

/// The header line of equilibria.csv.
std::string equilibria_header(MoreColumns more = {});
/// The columns that the first line of a file names. Throws `Error(bad_input)`, starting with `source`, where this
/// program writes no such line.
MoreColumns named_columns(std::string_view text, const std::string& source);
/// One row and a newline. `previous`: the equilibrium that this one follows, -1 for the start. \pre the record has what
/// `more` asks for.
std::string equilibrium_row(const EquilibriumRecord& record, const State& state, int previous, MoreColumns more);

/// One line of equilibria.csv, by the names of its header.
struct EquilibriumLine {
    std::string where; ///< file and line
    std::map<std::string, double> value;
    std::shared_ptr<const RecordColumns> names; ///< those of the file
    [[nodiscard]] double at(const std::string& name) const { return value.at(name); }
    /// Of the column with that name.
    [[nodiscard]] double bound(const std::string& name) const { return value.at(name + "_bound"); }
    /// The loaded stress, or with `_low` and `_high` the ends of its supported interval.
    [[nodiscard]] double stress(const char* end = "") const { return value.at(names->stress + end); }
    /// Of a column of integers.
    [[nodiscard]] int integer(const std::string& name) const { return static_cast<int>(at(name)); }
    [[nodiscard]] bool has(const std::string& name) const { return value.contains(name); }
};

/// The last line of a file of a run that goes on, or was killed, need not be complete.
enum class LastLine { complete, may_be_cut };

/// The text of a file of records, without a line that was cut.
std::string records_text(const std::filesystem::path& path, LastLine last);

/// Throws `Error(bad_input)` with file and line where a line has not one number for each column, an integer where the
/// column has integers.
std::vector<EquilibriumLine> read_equilibrium_lines(const std::filesystem::path& path, LastLine last);

} // namespace isostat
