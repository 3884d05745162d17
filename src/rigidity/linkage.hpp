#pragma once
/// \file
/// Pairs that keep touching while grains move against each other: bodies that turn alike, parallel bars, mirror images
/// at a wall (proofs/degenerate.md, R2). Private to the rooms on the right.

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <vector>

namespace isostat {

/// Contacts and a pair that touches. In the plane every edge of this graph may turn with the others of its class:
/// triangles turn as they are, opposite sides of a parallelogram alike, two equal bars from a disk to disks of one size
/// at one wall against each other. All cycles close in these motions, and they are as many as the contacts `among` the
/// grains leave.
/// True, the rows of `among` are independent at a configuration, and all of these touch without overlap there: the gap
/// of `pair` stays 0 on every motion from there on which `among` stay closed and independent. It reads indices and
/// radii alone, exactly. False says nothing: another list may do.
/// \pre `pair` is not in `among`; neither is a pair twice. Cost: a rank of (contacts) x (triangles, parallelograms).
bool moves_as_linkage(const Packing& packing, const std::vector<Contact>& among, const Contact& pair);

} // namespace isostat
