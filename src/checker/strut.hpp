#pragma once
/// \file
/// Ends of a straight strut at a power turn, and two walls that bear the same force in an edge of a box (statements S4,
/// S6 and S7, proofs/stability.md).

#include "checker/evidence.hpp"
#include "checker/replay.hpp"

#include <optional>

namespace isostat::checker {

/// Whether two forces may be equal at the exact power turn, where the multiplier of the held coordinate is 0: by the
/// balance of the disks between them the ends of a strut differ by at most that multiplier, wherever the turn was
/// rounded to. False without a coordinate held at the last turn.
bool same_at_turn(const Place& place, std::size_t a, std::size_t b);

/// Contacts whose force is 0 at the exact power turn (S4 (c)), whatever the forces are at the rounded place: one that
/// alone joins movable disks without load to the rest, and the two, not in one line, that hold such a disk when
/// contacts of this kind are left out. Empty in space. \pre a coordinate is held since the last turn.
std::vector<bool> without_force(const Place& place);

/// Whether contact `a` may have lost against `b` because of coordinates held earlier: `a` is one of them, or the
/// multipliers of some are so small that they may have been released and held again at once (without a record), and the
/// two forces differ by no more than these multipliers, or that of `a` is 0 at the present turn without them. Then the
/// order of the two refutes nothing.
bool holds_may_explain(const Place& place, std::size_t a, std::size_t b);

/// Order of the forces of two contacts that alone hold a group of free disks, from the infinitesimal loads on the
/// group: -1 when that of `a` is smaller. 0: these loads are perpendicular to the strut, up to its bend and
/// `turn_tolerance`. Nothing: the two do not cut off such a group.
std::optional<int> strut_order(const Place& place, std::size_t a, std::size_t b);

/// Whether the forces of two contacts are equal at the true vertex for every load that vanishes where `load` does. In
/// an edge (S6): walls of different axes at one movable sphere without load, where each other contact of the sphere
/// that may bear a force is with a sphere at both of these walls, or does not press along either axis. In a notch (S7):
/// contacts of one grain with the members of a dimer of equal ones, level at a wall, where nothing else presses on the
/// dimer along that wall. `zeros`: contacts whose forces are 0 under that load.
bool equal_by_place(const Evidence& evidence, const Forces& load, const std::vector<int>& zeros, std::size_t a,
                    std::size_t b);

/// Whether the forces of all these contacts vanish together with that of `one`, which is one of them, whatever the
/// loaded stress: they are multiples of each other by counting (K8), with or without the contacts whose forces equal
/// that of `one`.
bool vanish_with(const Evidence& evidence, const std::vector<int>& contacts, std::size_t one);

} // namespace isostat::checker
