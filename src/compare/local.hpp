#pragma once
/// \file
/// Each frame against the exact run from the frame before: a score that a first departure does not spoil.

#include "compare/frame.hpp"

#include <isostat/trajectory/trajectory.hpp>

namespace isostat::compare {

/// Sets `local` of every frame at rest, from number `first` on, whose frame before has a state. The exact run starts
/// there and ends at the load of the frame; frames are independent and go to the threads of `set_threads`. Cost: a
/// rearrangement or two per frame.
void compare_with_frame_before(std::vector<JudgedFrame>& frames, std::size_t first, const RunOptions& options);

} // namespace isostat::compare
