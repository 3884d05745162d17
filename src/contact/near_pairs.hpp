#pragma once
// Every pair of disks that is nearly in contact: from cells where the sizes of the disks are similar, from the regular
// triangulation where they are not and statements T5 and T6 apply, from a sweep otherwise.

#include <isostat/contact/contact.hpp>

#include <optional>
#include <vector>

namespace isostat {

/// Sorted list that contains every pair of disks with gap < reach (of the real numbers; a few pairs beyond by rounding
/// may be in it), whatever the packing. \pre 0 < reach <= 0.82 R_min.
template <int Dim> std::vector<Contact> near_pairs(const Packing<Dim>& packing, double reach);

/// The list from a grid of cells as large as the largest disks: complete without any hypothesis, O(n). Empty optional
/// when the size ratio is above 4 or lengths are beyond 1e+-100.
template <int Dim> std::optional<std::vector<Contact>> near_pairs_by_cells(const Packing<Dim>& packing, double reach);

/// The list from the edges of the regular triangulation with weights R^2, O(n log n). Empty optional when the
/// completeness theorem cannot be applied: a hidden vertex, an edge that overlaps by more than about 5e-4 R_min^2 / R,
/// a size ratio above 1e5, lengths beyond 1e+-100.
template <int Dim>
std::optional<std::vector<Contact>> near_pairs_by_triangulation(const Packing<Dim>& packing, double reach);

/// The list from a sweep along the first axis: complete without any hypothesis, O(n^1.5) for packings.
template <int Dim> std::vector<Contact> near_pairs_by_sweep(const Packing<Dim>& packing, double reach);

template <> std::optional<std::vector<Contact>> near_pairs_by_cells<2>(const Packing<2>&, double);
template <> std::optional<std::vector<Contact>> near_pairs_by_triangulation<2>(const Packing<2>&, double);
template <> std::vector<Contact> near_pairs_by_sweep<2>(const Packing<2>&, double);
extern template std::vector<Contact> near_pairs<2>(const Packing<2>&, double);

} // namespace isostat
