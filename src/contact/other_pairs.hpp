#pragma once
/// \file
/// The pairs of grains that are not contacts, as far as a claim about their gaps needs them.

#include <isostat/contact/state.hpp>

#include <cmath>
#include <vector>

namespace isostat {

/// Pairs that are not contacts, and a bound for those that were left out.
struct OtherPairs {
    std::vector<Contact> near; ///< not empty when there is any pair at all, but where they are `far`
    double reach =
        0; ///< every pair that is not in `near` has a gap >= reach in the packing; infinity: none was left out

    /// A cell so flat, or of so long a basis, that the nearest pair is more periods away than lists go (images.hpp).
    [[nodiscard]] bool far() const { return near.empty() && std::isfinite(reach); }
};

/// Those of a list that are not contacts.
std::vector<Contact> without(std::vector<Contact> pairs, const std::vector<Contact>& contacts, int disk_count);

/// Candidates of the triangulation (T5, T6) without the contacts; when that leaves none, all pairs (O(n^2), in small
/// packings only), in a cell those of a longer and longer reach. Pairs that cannot move relative to each other do not
/// count.
OtherPairs other_pairs(const Packing& packing, const std::vector<Contact>& contacts);

/// A disk and an own image at gap 0, exactly, between which no part of the cell moves (`can_move`). Such a pair is no
/// contact of a list and bears no load, but the other strains of the cell can close it.
std::vector<Contact> touching_own_images(const Packing& packing);

} // namespace isostat
