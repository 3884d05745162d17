#pragma once
/// \file
/// Records as text: a line of events.jsonl, of certificates/arcs.jsonl, counters.

#include "io/json.hpp"
#include "io/record_columns.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <string>

namespace isostat {

/// One JSON object and a newline.
std::string event_line(const ArcRecord& arc, const RecordColumns& names);

/// One line of certificates/arcs.jsonl: the step, and of a certified arc `grains` (those that move; absent: all),
/// `centres` (`held`: a coordinate, `q`) and `end`. `q` and `end` list the degrees of freedom that move, in their
/// order.
std::string witness_line(const ArcRecord& arc);

json::Json counters_json(const RunCounters& counters);
RunCounters counters_from(const json::Field& field);

} // namespace isostat
