#pragma once
/// \file
/// What a plateau says of a packing: of its isostatic ranges, those that count.

#include <isostat/crafted/plateau.hpp>

#include <vector>

namespace isostat::crafted {

/// What counts of the isostatic ranges.
struct Told {
    std::vector<PlateauRange> backbone, all; ///< in the widest range: the answer
    std::vector<PlateauRange> elsewhere;     ///< of the backbone, less wide
    int noise = 0;                           ///< of the backbone, less wide than the rounding: so many are left out
    bool special = false;                    ///< the widest range has N = N_f and no full rank
};
Told told_of(const Plateau& plateau);

} // namespace isostat::crafted
