#pragma once
/// \file
/// All forces that vanish by the pattern alone (proofs/checker.md, K7).

#include "checker/forces.hpp"

#include <optional>
#include <vector>

namespace isostat::checker {

/// All contacts whose forces are exactly 0, by the pattern alone, for every load that
/// vanishes where `load` does and for all radii (K7; no entry is left out,
/// proofs/definition.md). Ascending; nothing when the pattern has no perfect matching.
std::optional<std::vector<int>> structural_zeros(const Problem& problem, const Forces& load);

} // namespace isostat::checker
