#pragma once
// Whether a crafted packing in a cell is jammed: in exact arithmetic.

#include <isostat/crafted/exact_packing.hpp>

namespace isostat::crafted {

/// \pre every axis is periodic, nothing overlaps; `hold` of `judge_holds` for this packing
Jamming judge_jamming(const ExactPacking& packing, const std::vector<DiskHold>& hold, const InspectionLimits& limits);

} // namespace isostat::crafted
