#pragma once
/// \file
/// The vertex that a segment starts from: private to the room.

#include "trajectory/prover.hpp"

namespace isostat {

struct SegmentStart {
    std::shared_ptr<Vertex> vertex;
    Vertex::Gaps gaps;   ///< none is negative
    bool chosen = false; ///< of the pairs that touch, by first-order terms
};

/// What a state says, proved: a vertex at which no pair overlaps. Where
/// ties are settled, and unless the run is `resumed`, of the contacts of a hyperstatic start those are kept (in
/// `state.contacts`) that carry the load for small eps > 0: of those listed, and of the pairs that touch without being
/// listed. Failures: `overlap`, those of `Prover::vertex` and `Prover::gaps`, and of the choice.
Result<SegmentStart> start_segment(State& state, Prover& prover, const TieSettling& ties, bool resumed);

} // namespace isostat
