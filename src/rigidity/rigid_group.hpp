#pragma once
/// \file
/// Grains that move as one body, told by counting (proofs/degenerate.md, R1): private to the rooms on the right.

#include <isostat/contact/contact.hpp>
#include <isostat/packing/packing.hpp>

#include <vector>

namespace isostat {

/// The grains that `among` and `pair` join: their degrees of freedom, less the translations and the rotation that leave
/// every gap between them alone, are as many as the contacts `among` them.
/// True, and the rows of `among` are independent at a configuration: the row of `pair` depends on them there, so that
/// its gap does not change while they stay closed, whatever else moves. False says nothing: another list may count.
/// \pre `pair` is not in `among`; neither is a pair twice. Cost O(contacts + grains).
template <int Dim>
bool moves_as_one(const DofMap<Dim>& dofs, int disks, const std::vector<Contact>& among, const Contact& pair);

extern template bool moves_as_one<2>(const DofMap<2>&, int, const std::vector<Contact>&, const Contact&);

} // namespace isostat
