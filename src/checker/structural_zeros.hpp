#pragma once
/// \file
/// All forces that vanish by the pattern alone (proofs/checker.md, K7).

#include "checker/forces.hpp"

#include <optional>
#include <vector>

namespace isostat::checker {

/// Contacts whose forces are exactly 0 for every load where `load` is not 0, for all radii, by the pattern alone (K7;
/// no entry is left out, proofs/definition.md): as many as there are. Ascending; nothing when the pattern has no
/// perfect matching.
std::optional<std::vector<int>> structural_zeros(const Problem& problem, const Forces& load);

} // namespace isostat::checker
