#pragma once
/// \file
/// Each frame against the exact run from the previous frame: a score on which an earlier departure has no effect.

#include "compare/frame.hpp"

#include <isostat/trajectory/trajectory.hpp>

namespace isostat::compare {

/// Sets `local` of every frame at rest, from number `first` on, whose previous frame has a state. The exact run starts
/// there and ends at the load of the frame; frames are independent and use the threads of `set_threads`. Cost: a
/// rearrangement or two per frame.
void compare_with_frame_before(std::vector<JudgedFrame>& frames, std::size_t first, const RunOptions& options);

} // namespace isostat::compare
