#pragma once
// The rule `steepest`: room `statics` only.

#include "statics/contender.hpp"

#include <vector>

namespace isostat {

/// Gives keys f / |v| to the contenders that may have the smallest one, and leaves out those that are proved not to
/// (D5): where hundreds of forces are negative, few of the norms |v| are computed. Cost: two solves for each.
template <int Dim> void keep_steepest(const Statics<Dim>& statics, std::vector<Contender>& contenders);

extern template void keep_steepest<2>(const Statics<2>&, std::vector<Contender>&);

} // namespace isostat
