#pragma once
/// \file
/// Grains that move as one body, told by counting (proofs/degenerate.md, R1): private to the rooms on the right.

#include <isostat/contact/state.hpp>
#include <isostat/packing/load.hpp>

#include <vector>

namespace isostat {

/// The grains that `among` and `pair` join: their degrees of freedom, less the translations and the rotation that leave
/// every gap between them alone, are as many as the contacts `among` them.
/// True, and the rows of `among` are independent at a configuration: the row of `pair` depends on them there, so that
/// its gap does not change while they stay closed, whatever else moves. False says nothing: another list may count.
/// \pre `pair` is not in `among`; neither is a pair twice. Cost O(contacts + grains).
bool moves_as_one(const DofMap& dofs, int disks, const std::vector<Contact>& among, const Contact& pair);

/// A load along `axis` on the upper wall of that axis is carried by `carrying` alone: they join that wall to one that
/// does not move, and are as many as the degrees of freedom of the grains that they join, less the motions that leave
/// their gaps alone, none of which the load moves (R3).
/// True, and the rows of a regular list that `carrying` is part of are independent: the forces that balance the load
/// vanish on all other contacts. False says nothing. \pre no contact is in `carrying` twice. Cost as above.
bool carries_alone(const DofMap& dofs, const std::vector<Contact>& carrying, int axis);

} // namespace isostat
