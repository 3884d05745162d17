#pragma once
/// \file
/// Forces at the true vertex (proofs/checker.md, K6) and what counting alone proves of them (K7, K8).

#include "checker/vertex.hpp"

#include <isostat/packing/load.hpp>

namespace isostat::checker {

/// External forces per degree of freedom at the true vertex.
using Forces = std::vector<Range>;

/// A stress of an axis or tilt, as an exact number: on a path `at` + t `rate`.
Rational stress_of(const Load& load, std::size_t place);

/// The finite load of a state, its derivative with respect to the loaded stress, and the infinitesimal load.
Forces finite_load(const Problem& problem, const State& state, const TrueVertex& vertex);
Forces unit_load(const Problem& problem, const State& state, const TrueVertex& vertex);
Forces infinitesimal_load(const Problem& problem, const State& state);

/// Ranges of all contact forces (compressive positive) under a load.
std::vector<Range> contact_forces(const Problem& problem, const Solver& solver, const InverseBound& inverse,
                                  const TrueVertex& vertex, const Forces& load);

/// The number of degrees of freedom without load that no contact outside a set touches. Along an axis without loads
/// what cannot move counts too, as long as its balance is independent of the counted ones.
int free_of_others(const Problem& problem, const std::vector<int>& contacts, const Forces& load);

/// The forces of these contacts are exactly 0 under the load (K7). False proves nothing.
bool vanish_structurally(const Problem& problem, const std::vector<int>& contacts, const Forces& load);

/// The forces of these contacts are fixed multiples of one number under every load that vanishes where `load` does
/// (K8). False proves nothing.
bool vary_together(const Problem& problem, const std::vector<int>& contacts, const Forces& load);

} // namespace isostat::checker
