#pragma once
/// \file
/// Of which states `certify` claims anything, and the lengths that its bounds take from a packing: private to the room.

#include "packing/arc_bodies.hpp"

#include <isostat/contact/state.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// Why nothing is claimed of a state: it holds a coordinate, or has no disks, or numbers so large or small that
/// underflow and overflow, which no bound counts, could matter.
std::optional<std::string> beyond_claims(const State& state);

/// Largest coordinate or radius.
double largest_length(const Packing& packing);

/// Some image is farther away than the grid allows for (proofs/cells.md, C2).
bool any_far(const std::vector<Contact>& pairs);

/// A cell on the grid, where every r is exact, with `moved` bound of what that changes of a coordinate. Nothing where a
/// part of the cell that cannot move would have to, or an image is too far.
std::optional<Packing> on_grid(Packing packing, const std::vector<Contact>& contacts, double& moved);

/// The gap of a pair that is not among the candidates, at a distance from where they were found, is at least their
/// `reach` minus this times the distance (proofs/cells.md, C4; V4 (d) in a box).
double far_weight(const Packing& packing, double reach);

/// Why the circles of these contacts may not be those that touch, the true vertex being `distance` (2-norm) from the
/// packing at most; nothing: every normal is inside the sectors of both members (U9).
std::optional<std::string> beyond_sectors(const ArcBodies& arcs, const std::vector<Contact>& contacts, double distance);

} // namespace isostat
