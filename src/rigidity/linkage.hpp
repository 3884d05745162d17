#pragma once
/// \file
/// Pairs that keep touching while grains move relative to each other: bodies that turn by the same angle, parallel
/// bars, mirror images at a wall (proofs/degenerate.md, R2). Private to the rooms on the right.

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <vector>

namespace isostat {

/// The graph of contacts and a touching pair. In the plane every edge of this graph may turn together with the edges of
/// its class: triangles turn rigidly, opposite sides of a parallelogram by the same angle, two equal bars from a disk
/// to disks of one size at one wall by opposite angles. True: all cycles close in these motions, and these are as many
/// as the motions that the contacts `among` leave to the grains.
/// If true, and the rows of `among` are independent at a configuration where all of these touch without overlap: the
/// gap of `pair` stays 0 on every motion from there on which `among` stay closed and independent. Only indices and
/// radii are used, exactly. False proves nothing: another list may give true.
/// \pre `pair` is not in `among`, and no pair occurs twice. Cost: a rank of (contacts) x (triangles, parallelograms).
bool moves_as_linkage(const Packing& packing, const std::vector<Contact>& among, const Contact& pair);

} // namespace isostat
