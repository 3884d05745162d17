#pragma once
/// \file
/// Whether the grains of a box are jammed.

#include <isostat/certificate/certify.hpp>

#include <optional>

namespace isostat {

/// Of a box with both walls on every axis, while all of them stay.
struct BoxInspection {
    int grains = 0;           ///< that are no rattlers by coordination
    Counting counting;        ///< of these alone
    JammingAnswer collective; ///< no motion of the grains that carry a force keeps all gaps >= 0
};

/// `proved` by the equilibrium of the state; where no wall moves by that of the same grains with the last upper wall
/// movable, whose forces are a self-stress of the others (proofs/cells.md, C6 and C13, where the box is the cell).
/// Nothing where a wall is absent, and where grains are fixed, held or bear forces. \pre `truth` is of this state.
/// Cost: a rank and a certificate.
std::optional<BoxInspection> inspect_box(const State& state, const Certification& truth);

/// What is so if all of these contacts close: collectively, and in a cell, where each strain is possible, strictly.
/// Where it is neither proved nor refuted (too near to other answers, grains that bear no force), where some gap of
/// the list is larger than what the proof spans, or another pair overlaps by as much, nothing is said. Cost: up to a
/// hundred Cholesky factorisations, each some milliseconds for 1000 grains, mostly a dozen.
struct IfClosed {
    std::optional<JammedIfClosed> collective, strict;
};
IfClosed jammed_if_closed(Packing packing, std::vector<Contact> contacts);
/// Of a cell, with its own images that touch; locally where collectively.
void add_if_closed(const Packing& packing, const std::vector<Contact>& contacts, CellInspection& cell);

} // namespace isostat
