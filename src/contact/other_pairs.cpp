#include "contact/other_pairs.hpp"

#include "contact/candidates.hpp"
#include "contact/contact_set.hpp"
#include "contact/images.hpp"
#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"

#include <cmath>
#include <limits>

namespace isostat {

namespace {

/// Those with walls, and without images those of two disks.
std::vector<Contact> all_pairs(const Packing& packing) {
    std::vector<Contact> pairs;
    const int n = packing.disk_count();
    for (int i = 0; i < n; ++i) {
        for (int j = i + 1; j < n && !packing.cell.any(); ++j) {
            pairs.push_back({ContactKind::disk_disk, i, j});
        }
        packing.walls.for_each(packing.dimension, i, [&pairs](const Contact& wall) { pairs.push_back(wall); });
    }
    std::erase_if(pairs, [&packing](const Contact& pair) { return !can_move(packing, pair); });
    without_hidden_pairs(pairs, packing);
    return pairs;
}

} // namespace

std::vector<Contact> without(std::vector<Contact> pairs, const std::vector<Contact>& contacts, int disk_count) {
    const ContactSet kept(contacts, disk_count);
    std::erase_if(pairs, [&kept](const Contact& pair) { return kept.contains(pair); });
    return pairs;
}

OtherPairs other_pairs(const Packing& packing, const std::vector<Contact>& contacts) {
    CandidateList candidates = find_candidates(packing, largest_candidate_fraction);
    OtherPairs pairs{without(std::move(candidates.contacts), contacts, packing.disk_count()), candidates.reach};
    if (!pairs.near.empty()) {
        return pairs;
    }
    pairs = {without(all_pairs(packing), contacts, packing.disk_count()), std::numeric_limits<double>::infinity()};
    const bool any = packing.cell.any() && DofMap(packing).dof_count() > 0; // else nothing ever comes near
    for (double reach = packing.min_radius(); any && std::isinf(pairs.reach); reach *= 2) {
        if (disk_beyond(packing, reach, farthest_disk)) {
            return {{}, candidates.reach};
        }
        std::vector<Contact> images = near_pairs(packing, reach).pairs;
        std::erase_if(images, [&packing](const Contact& pair) { return !can_move(packing, pair); });
        images = without(std::move(images), contacts, packing.disk_count());
        if (!images.empty()) {
            pairs.near.insert(pairs.near.end(), images.begin(), images.end());
            pairs.reach = reach;
        }
    }
    return pairs;
}

std::vector<Contact> touching_own_images(const Packing& packing) {
    std::vector<Contact> out;
    if (packing.cell.any()) {
        // contact_candidates.md Displacements (any reach finds what touches)
        for (const Contact& pair : near_pairs(packing, 0.5 * packing.min_radius()).pairs) {
            if (pair.i == pair.j && !can_move(packing, pair) && gap_sign(packing, pair, 0) == 0) {
                out.push_back(pair);
            }
        }
    }
    return out;
}

} // namespace isostat
