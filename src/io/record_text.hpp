#pragma once
/// \file
/// Records as text: what columns of equilibria.csv and fields of events.jsonl are called (in the plane by what is
/// loaded, in space by axis), a line of events.jsonl, of certificates/arcs.jsonl, counters.

#include "io/json.hpp"

#include <isostat/packing/load.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <string>
#include <vector>

namespace isostat {

/// In the plane the stress is `sigma2` and the measures are `eps1`, `L1` of the other axis, `eps2`, `L2` of what is
/// loaded and `eps3`, `L3` of the rest of a cell whose tilt moves. In space the stress is `sigma1` to `sigma3` or
/// `shear_xy`, `shear_xz`, `shear_yz`, on a path `t`, and the measures are `eps1`, `L1`, ... by axis, then `eps_xy`,
/// `xy`, ...
struct RecordColumns {
    struct Measure {
        std::string strain, length;
        std::size_t axis; ///< as `Load::loaded_axis`: tilts follow the axes
    };
    int dimension = 2; ///< in which contacts are named
    std::string stress;
    bool of_path = false;             ///< p and q follow the ratio
    std::string strain, other_strain; ///< of what is loaded, and of `Load::other_axis`
    std::vector<Measure> measures;    ///< one for each axis, and of cells whose tilts move one for each tilt
};

/// Of a run with such a load; `tilts`: `Cell::shears`.
RecordColumns record_columns(const Load& load, bool tilts);

/// Fields that an object of events.jsonl may have.
struct EventNames {
    std::vector<std::string> all;
    std::vector<std::string> numbers; ///< null: not known
};
EventNames event_names(const RecordColumns& names);

/// One JSON object and a newline.
std::string event_line(const ArcRecord& arc, const RecordColumns& names);

/// One line of certificates/arcs.jsonl: the step, and of a certified arc `grains` (those that move; absent: all),
/// `centres` (`held`: a coordinate, `q`) and `end`. `q` and `end` list the degrees of freedom that move, in their
/// order.
std::string witness_line(const ArcRecord& arc);

json::Json counters_json(const RunCounters& counters);
RunCounters counters_from(const json::Field& field);

} // namespace isostat
