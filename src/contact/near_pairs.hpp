#pragma once
// Every pair of disks that is nearly in contact: from the regular triangulation where statements T5 and T6 apply, from
// a grid otherwise.

#include "contact/regular_triangulation.hpp"

#include <isostat/contact/state.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// Sorted pairs, and the triangulation that they are edges of (null: they were found by the grid).
struct NearPairs {
    std::vector<Contact> pairs;
    std::shared_ptr<const RegularTriangulation> triangulation;
};

/// Every pair of disks with gap < reach (of the real numbers; a few pairs beyond by rounding may be in it), whatever
/// the packing; members of one body are no pair, but for images. The pairs are a function of the packing and the reach
/// alone: neither `from`, a triangulation of the same disks elsewhere that is carried to these places if it is there,
/// nor what finds them makes a difference. In a cell: every pair of a disk and an image, each once; found among
/// finitely many images, without a triangulation that could be carried. \pre reach > 0; beyond 0.82 R_min the grid
/// finds them
NearPairs near_pairs(const Packing& packing, double reach,
                     const std::shared_ptr<const RegularTriangulation>& from = nullptr);

/// Those pairs among the edges of the triangulation. Empty optional when an edge overlaps by more than about 5e-4
/// R_min^2 / R, so that the completeness theorem does not apply.
std::optional<std::vector<Contact>> near_edges(const Packing& packing, double reach,
                                               const RegularTriangulation& triangulation);

/// The same of spheres, from a triangulation that is made for the purpose. Empty also where a sphere is hidden.
std::optional<std::vector<Contact>> near_edges_in_space(const Packing& packing, double reach);

/// The same pairs from the grid: complete without any hypothesis. Throws `Error(bad_input)` when they are more than
/// `most_per_disk` of each disk.
std::vector<Contact> pairs_within(const Packing& packing, double reach,
                                  int most_per_disk = std::numeric_limits<int>::max());

/// Leaves out pairs of members of one body (a member and an image of another one are a pair), and of bodies bounded by
/// arcs all members but the nearest two (`ArcBodies::is_nearest`).
void without_hidden_pairs(std::vector<Contact>& pairs, const Packing& packing);

} // namespace isostat
