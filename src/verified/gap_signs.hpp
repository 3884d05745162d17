#pragma once
/// \file
/// `gap_sign_at_vertex` of several candidates at once.

#include "verified/configuration.hpp"

#include <vector>

namespace isostat {

/// One answer per candidate. Cost: that of one, and a gap per rung for each.
template <int Dim>
std::vector<Order> gap_signs_at_vertex(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                                       const Factorisation& factorisation, const InverseBound& inverse,
                                       const std::vector<Contact>& candidates, const LadderOptions& options = {});

extern template std::vector<Order> gap_signs_at_vertex<2>(const Packing<2>&, const IsostaticStructure<2>&,
                                                          const Factorisation&, const InverseBound&,
                                                          const std::vector<Contact>&, const LadderOptions&);

} // namespace isostat
