#pragma once
// Slow twin of the peeling of disks, by angles: which contacts can carry a force >= 0, from the normals around each
// disk. `Vector` has cross_sign(a, b) and dot_sign(a, b), both decided.

#include <isostat/crafted/exact_packing.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace isostat::crafted {

/// 0 is interior to the hull exactly when no open angle of pi or more is free of normals: each one has another strictly
/// to its left.
template <class Vector> bool surround(const std::vector<Vector>& normals) {
    return !normals.empty() && std::ranges::all_of(normals, [&](const Vector& v) {
        return std::ranges::any_of(normals, [&](const Vector& w) { return cross_sign(v, w) > 0; });
    });
}

/// The first normal that has an opposite one, or -1.
template <class Vector> int opposite(const std::vector<Vector>& normals) {
    for (std::size_t a = 0; a < normals.size(); ++a) {
        for (std::size_t b = a + 1; b < normals.size(); ++b) {
            if (cross_sign(normals[a], normals[b]) == 0 && dot_sign(normals[a], normals[b]) < 0) {
                return static_cast<int>(a);
            }
        }
    }
    return -1;
}

/// Contacts around one disk: number and direction from the disk (any positive length).
template <class Vector> using Arms = std::vector<std::pair<std::size_t, Vector>>;

/// Clears `carrying` of contacts that can carry no force until nothing changes, and sets `hold` of the disks whose hold
/// is not `fixed` or `loaded`.
template <class Vector>
void exclude_contacts(const std::vector<Arms<Vector>>& arms, std::vector<unsigned char>& carrying,
                      std::vector<DiskHold>& hold) {
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < arms.size(); ++i) {
            if (hold[i] == DiskHold::fixed || hold[i] == DiskHold::loaded) {
                continue;
            }
            std::vector<Vector> normals;
            std::vector<std::size_t> left;
            for (const auto& [contact, normal] : arms[i]) {
                if (carrying[contact] != 0) {
                    normals.push_back(normal);
                    left.push_back(contact);
                }
            }
            if (surround(normals)) {
                hold[i] = DiskHold::held;
                continue;
            }
            const int along = opposite(normals);
            hold[i] = along < 0 ? DiskHold::rattler : DiskHold::bridge;
            for (std::size_t k = 0; k < left.size(); ++k) {
                // On the border of a half-plane only the forces along that border can balance.
                if (along < 0 || cross_sign(normals[static_cast<std::size_t>(along)], normals[k]) != 0) {
                    carrying[left[k]] = 0;
                    changed = true;
                }
            }
        }
    }
}

} // namespace isostat::crafted
