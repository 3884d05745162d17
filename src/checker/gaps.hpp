#pragma once
/// \file
/// All gaps at the true vertex but those of the contacts (proofs/checker.md, K9).

#include "checker/vertex.hpp"

#include <optional>

namespace isostat::checker {

/// A pair that cannot move (two fixed disks, a fixed disk and a fixed wall, a disk and an image of it that no moving
/// period separates) and overlaps, exactly. Of disk -1: not known, as the cell is too sheared or a disk too far from
/// it.
std::optional<Contact> fixed_overlap(const Problem& problem, const State& state);

/// A pair of grains and its gap at the true vertex.
struct Gap {
    Contact pair;
    Range value;
};

/// Pairs that are no contacts and can move relative to each other: all that may have the smallest gap. Every pair that
/// is not listed has a gap above the smallest one. Empty: there is no such pair at all. In a cell a pair with disk -1
/// and a gap of any size: nothing is known, as it is too sheared or a disk too far from it.
std::vector<Gap> smallest_gaps(const Problem& problem, const State& state, const TrueVertex& vertex);

/// Whether a pair is one of those.
bool is_free_pair(const State& state, const Contact& pair);

} // namespace isostat::checker
