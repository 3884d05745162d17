#pragma once
/// \file
/// The reference bundle: equilibria that exact runs from one start share, and where the runs separate.

#include "compare/path.hpp"

namespace isostat::compare {

/// `count` members: `path` itself (the exact run from `start`), and others from the same
/// list of contacts, in turn with the rules most_negative, least_index, random (seed 1,
/// 2, ...) and rattlers that rest down, up, left, right, for spheres first back and
/// front. They use the threads of `set_threads`. Cost: an exact run per member.
Bundle make_bundle(const State& start, const Path& path, const std::vector<double>& loads, int count,
                   const RunOptions& options);

/// The node with this list; -1: none.
int node_with(const Bundle& bundle, const std::vector<Contact>& list);

} // namespace isostat::compare
