#pragma once
/// \file
/// The vertex that a segment starts from: private to the room.

#include "trajectory/prover.hpp"

namespace isostat {

struct SegmentStart {
    std::shared_ptr<Vertex> vertex;
    Vertex::Gaps gaps;   ///< none is negative
    bool chosen = false; ///< first-order terms chose contacts among the touching pairs
};

/// Proves what a state says: a vertex at which no pair overlaps. Where ties are settled, and unless the run is
/// `resumed`, a hyperstatic start keeps (in `state.contacts`) those contacts that carry the load for small eps > 0,
/// chosen from its list and from the touching pairs outside the list. Failures: `overlap`, those of `Prover::vertex`
/// and `Prover::gaps`, and of the choice.
Result<SegmentStart> start_segment(State& state, Prover& prover, const TieSettling& ties, bool resumed);

} // namespace isostat
