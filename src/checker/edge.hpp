#pragma once
/// \file
/// Two walls that bear the same force in an edge of a box (statement S6, proofs/stability.md).

#include "checker/evidence.hpp"

namespace isostat::checker {

/// Whether the forces of two contacts are equal at the true vertex for every load that vanishes where `load` does: the
/// two are walls of different axes at one movable sphere without load, and each other contact of the sphere that may
/// bear a force is with a sphere at both of these walls, or does not press along either axis. `zeros`: contacts whose
/// forces are 0 under that load.
bool equal_in_edge(const Evidence& evidence, const Forces& load, const std::vector<int>& zeros, std::size_t a,
                   std::size_t b);

/// Whether the forces of all these contacts vanish together with that of `one`, which is one of them: they are
/// multiples of each other by counting (K8), with or without the contacts in the edge of `one`.
bool vanish_with(const Evidence& evidence, const Forces& load, const std::vector<int>& contacts, std::size_t one);

} // namespace isostat::checker
