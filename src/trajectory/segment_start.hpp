#pragma once
/// \file
/// The vertex that a segment starts from: private to the room.

#include "trajectory/prover.hpp"

namespace isostat {

template <int Dim> struct SegmentStart {
    std::shared_ptr<Vertex<Dim>> vertex;
    typename Vertex<Dim>::Gaps gaps; ///< none is negative
    bool chosen = false;             ///< of the pairs that touch, by first-order terms
};

/// What a state says, proved: a vertex at which no pair overlaps. Where
/// ties are settled, and unless the run is `resumed`, of the contacts of a hyperstatic start those are kept (in
/// `state.contacts`) that carry the load for small eps > 0: of those listed, and of the pairs that touch without being
/// listed. Failures: `overlap`, those of `Prover::vertex` and `Prover::gaps`, and of the choice.
template <int Dim>
Result<SegmentStart<Dim>> start_segment(State<Dim>& state, Prover<Dim>& prover, const TieSettling<Dim>& ties,
                                        bool resumed);

extern template Result<SegmentStart<2>> start_segment<2>(State<2>&, Prover<2>&, const TieSettling<2>&, bool);

} // namespace isostat
