#pragma once
/// \file
/// The isostatic ranges of a plateau that are worth reporting.

#include <isostat/crafted/plateau.hpp>

#include <vector>

namespace isostat::crafted {

/// The isostatic ranges worth reporting.
struct Told {
    std::vector<PlateauRange> backbone, all; ///< inside the widest range: the result
    std::vector<PlateauRange> elsewhere;     ///< other ranges of the backbone
    int noise = 0;                           ///< ranges of the backbone left out as narrower than the rounding
    bool special = false;                    ///< the widest range has N = N_f and no full rank
};
Told told_of(const Plateau& plateau);

} // namespace isostat::crafted
