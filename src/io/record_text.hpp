#pragma once
/// \file
/// Records as text: a line of events.jsonl, a row of equilibria.csv, counters.

#include "io/json.hpp"

#include <isostat/io/run_directory.hpp>

#include <string>

namespace isostat {

/// One JSON object and a newline.
std::string event_line(const ArcRecord<2>& arc);

/// One line of certificates/arcs.jsonl: the step, and of a certified arc `grains` (those that move; absent: all),
/// `centres` (`held`: a coordinate, `q`) and `end`. `q` and `end` list the degrees of freedom that move, in their
/// order.
std::string witness_line(const ArcRecord<2>& arc);

/// The header line of equilibria.csv.
std::string equilibria_header(MoreColumns more = {});
/// The columns that the first line of a file names. Throws `Error(bad_input)`, starting with `source`, where this
/// program writes no such line.
MoreColumns named_columns(std::string_view text, const std::string& source);
/// One row and a newline. `previous`: the equilibrium that this one follows, -1 for the start. \pre the record has what
/// `more` asks for.
std::string equilibrium_row(const EquilibriumRecord<2>& record, const State<2>& state, int previous, MoreColumns more);

json::Json tally_json(const Tally& tally);
json::Json counters_json(const RunCounters& counters);
RunCounters counters_from(const json::Field& field);

} // namespace isostat
