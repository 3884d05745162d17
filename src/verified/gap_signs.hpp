#pragma once
/// \file
/// `gap_sign_at_vertex` of several candidates at once.

#include "verified/configuration.hpp"

#include <vector>

namespace isostat {

/// One result per candidate. Cost: that of one candidate, and a gap per rung for each further one.
std::vector<Order> gap_signs_at_vertex(const Packing& packing, const IsostaticStructure& structure,
                                       const Factorisation& factorisation, const InverseBound& inverse,
                                       const std::vector<Contact>& candidates, const LadderOptions& options = {});

} // namespace isostat
