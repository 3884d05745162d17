#pragma once
/// \file
/// The reference bundle: what exact runs from one start have in common, and where they part.

#include "compare/path.hpp"

namespace isostat::compare {

/// `count` members: `path` itself (the exact run from `start`), and others from the same list of contacts, in turn with
/// the rules most_negative, least_index, random (seed 1, 2, ...) and rattlers that rest down, up, left,
/// right, of spheres back and front first. They go to the threads of `set_threads`. Cost: that of an exact run for
/// each.
Bundle make_bundle(const State& start, const Path& path, const std::vector<double>& loads, int count,
                   const RunOptions& options);

/// The node with this list; -1: none.
int node_with(const Bundle& bundle, const std::vector<Contact>& list);

} // namespace isostat::compare
