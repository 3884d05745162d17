#pragma once
// The same packing in another unit of length.

#include <isostat/packing/packing.hpp>

#include <vector>

namespace units {

/// Multiplies every length.
inline void stretch(isostat::Packing& packing, double unit) {
    for (std::vector<double>* const lengths : {&packing.q, &packing.radius}) {
        for (double& length : *lengths) {
            length *= unit;
        }
    }
    for (isostat::Bar& bar : packing.bars) {
        bar.length *= unit;
    }
}

} // namespace units
