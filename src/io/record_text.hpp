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
std::string equilibria_header(MoreColumns more = MoreColumns::none);
inline MoreColumns columns_of(const EquilibriumRecord<2>& record) {
    return record.length.size() > 2 ? MoreColumns::tilt : record.touching ? MoreColumns::touching : MoreColumns::none;
}
/// One row and a newline. `previous`: the equilibrium that this one follows, -1 for the start.
std::string equilibrium_row(const EquilibriumRecord<2>& record, const State<2>& state, int previous);

json::Json tally_json(const Tally& tally);
json::Json counters_json(const RunCounters& counters);
RunCounters counters_from(const json::Field& field);

} // namespace isostat
