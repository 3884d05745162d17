#pragma once
/// \file
/// What the functions of the room share: of which states they claim anything, the lengths that their bounds take from a
/// packing, counts, forces at other loads. Private to the room.

#include "packing/arc_bodies.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/counting.hpp>

#include <optional>
#include <span>
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

/// `count_contacts`; when its rank is only a lower bound and the matrix is small, the rank from a kernel that was
/// checked in rationals (`exact::kernel`): then `rank_exact` is `proved`.
Counting exact_counting(const State& state);

/// Finite forces at the true vertex of the state under each of these stresses along the axes in the place of its own,
/// as `Certification::finite`; empty where no true vertex was found. Cost: a rank proof and two factorisations, then a
/// few solves for each.
std::vector<std::vector<Interval>> finite_forces(State state, std::span<const PerAxis<double>> stresses);

} // namespace isostat
