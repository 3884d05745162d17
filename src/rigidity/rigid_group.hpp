#pragma once
/// \file
/// Grains that move as one body (proofs/degenerate.md, R1), and pairs that keep touching while grains move relative to
/// each other (R2), found by counting: private to the rooms on the right.

#include <isostat/packing/packing.hpp>

#include <optional>
#include <vector>

namespace isostat {

/// The grains that `among` and `pair` join have as many degrees of freedom, minus the translations and the rotation
/// that change no gap between them, as there are contacts in `among`.
/// If true, and the rows of `among` are independent: the row of `pair` depends on them, so that its gap does not change
/// while they stay closed, whatever else moves. False proves nothing: another list may give true.
/// \pre `pair` is not in `among`, and no pair occurs twice. Cost O(contacts + grains).
bool moves_as_one(const DofMap& dofs, int disks, const std::vector<Contact>& among, const Contact& pair);

/// The same contacts after every disk is replaced by one of its images so that no contact goes to another image: a
/// change of coordinates x_i + A k_i. Nothing where a cycle of contacts winds around the cell, or where a contact is a
/// held coordinate. Cost O(contacts + disks); without images O(contacts).
std::optional<std::vector<Contact>> unwound(int disks, std::vector<Contact> contacts);

/// Bodies that turn by the same angle, parallel bars, mirror images at a wall (R2): the graph of contacts and a
/// touching pair. In the plane every edge of this graph may turn together with the edges of its class: triangles turn
/// rigidly, opposite sides of a parallelogram by the same angle, two equal bars from a disk to disks of one size at one
/// wall by opposite angles. True: all cycles close in these motions, and these are as many as the motions that the
/// contacts `among` leave to the grains. If true, and the rows of `among` are independent at a configuration where all
/// of these touch without overlap: the gap of `pair` stays 0 on every motion from there on which `among` stay closed
/// and independent. Only indices and radii are used, exactly. False proves nothing: another list may give true. \pre
/// `pair` is not in `among`, and no pair occurs twice. Cost: a rank of (contacts) x (triangles, parallelograms).
bool moves_as_linkage(const Packing& packing, const std::vector<Contact>& among, const Contact& pair);

} // namespace isostat
