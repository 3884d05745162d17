#pragma once
/// \file
/// Grains that move as one body, found by counting (proofs/degenerate.md, R1): private to the rooms on the right.

#include <isostat/contact/state.hpp>
#include <isostat/packing/load.hpp>

#include <vector>

namespace isostat {

/// The grains that `among` and `pair` join have as many degrees of freedom, minus the translations and the rotation
/// that change no gap between them, as there are contacts in `among`.
/// If true, and the rows of `among` are independent: the row of `pair` depends on them, so that its gap does not change
/// while they stay closed, whatever else moves. False proves nothing: another list may give true.
/// \pre `pair` is not in `among`, and no pair occurs twice. Cost O(contacts + grains).
bool moves_as_one(const DofMap& dofs, int disks, const std::vector<Contact>& among, const Contact& pair);

/// The contacts `carrying` alone carry a load along `axis` on the upper wall of that axis: they join that wall to a
/// fixed wall, and are as many as the degrees of freedom of the grains that they join, minus the motions that change
/// none of their gaps, none of which moves the load (R3).
/// If true, and the rows of a regular list that contains `carrying` are independent: the forces that balance the load
/// vanish on all other contacts. False proves nothing. \pre no contact is in `carrying` twice. Cost as above.
bool carries_alone(const DofMap& dofs, const std::vector<Contact>& carrying, int axis);

} // namespace isostat
