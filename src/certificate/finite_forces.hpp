#pragma once
/// \file
/// Forces at one true vertex under several loads: private to the room.

#include <isostat/contact/state.hpp>
#include <isostat/io/state_file.hpp>

#include <span>
#include <vector>

namespace isostat {

/// Finite forces at the true vertex of the state under each of these stresses along the axes in the place of its own,
/// as `Certification::finite`; empty where no true vertex was found. Cost: a rank proof and two factorisations, then a
/// few solves for each.
std::vector<std::vector<Interval>> finite_forces(State state, std::span<const PerAxis<double>> stresses);

} // namespace isostat
