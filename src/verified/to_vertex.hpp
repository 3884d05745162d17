#pragma once
/// \file
/// From a configuration to the vertex of a list of contacts.

#include "core/roundoff.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <optional>
#include <vector>

namespace isostat {

/// Newton's method on the gaps of `contacts`, each step through a structure that was proved regular, until the largest
/// gap is at the grid or stops decreasing. Nothing is proved of the end. No coordinate moves farther than `reach`. A
/// cell that keeps its shape changes its size. `steps` counts the steps. Failures, with the packing unchanged:
/// `not_isostatic`, `not_converged`.
std::optional<Failure> to_vertex(Packing& packing, const std::vector<Contact>& contacts, long& steps,
                                 double reach = roundoff::infinity);

} // namespace isostat
