#pragma once
/// \file
/// What columns of equilibria.csv and fields of events.jsonl are called: in the plane by what is loaded, in space by
/// axis.

#include <isostat/packing/load.hpp>

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

} // namespace isostat
