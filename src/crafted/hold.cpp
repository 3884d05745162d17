#include "crafted/hold.hpp"

#include <algorithm>

namespace isostat::crafted {

namespace {

using Vector = std::array<Number, 2>;

int cross_sign(const Vector& a, const Vector& b) {
    return (a[0] * b[1] - a[1] * b[0]).sign();
}
int dot_sign(const Vector& a, const Vector& b) {
    return (a[0] * b[0] + a[1] * b[1]).sign();
}

/// 0 is interior to the hull exactly when no open angle of pi or more is free of normals: each one has another strictly
/// to its left.
bool surround(const std::vector<Vector>& normals) {
    return !normals.empty() && std::all_of(normals.begin(), normals.end(), [&](const Vector& v) {
        return std::any_of(normals.begin(), normals.end(), [&](const Vector& w) { return cross_sign(v, w) > 0; });
    });
}

/// The first normal that has an opposite one, or -1.
int opposite(const std::vector<Vector>& normals) {
    for (std::size_t a = 0; a < normals.size(); ++a) {
        for (std::size_t b = a + 1; b < normals.size(); ++b) {
            if (cross_sign(normals[a], normals[b]) == 0 && dot_sign(normals[a], normals[b]) < 0) {
                return static_cast<int>(a);
            }
        }
    }
    return -1;
}

} // namespace

void judge_holds(Inspection& inspection, const ExactPacking& packing, const DofMap<2>& dofs,
                 const exact::NumberMatrix& matrix) {
    const auto n = packing.radius.size();
    std::vector<std::vector<std::size_t>> of_disk(n);
    std::array<std::vector<std::size_t>, 2> of_wall;
    for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
        const Contact& contact = inspection.contacts[l];
        of_disk[static_cast<std::size_t>(contact.i)].push_back(l);
        if (contact.kind == ContactKind::disk_disk) {
            of_disk[static_cast<std::size_t>(contact.j)].push_back(l);
        } else if (contact.kind == ContactKind::upper_wall) {
            of_wall[static_cast<std::size_t>(contact.j)].push_back(l);
        }
    }
    inspection.carrying.assign(inspection.contacts.size(), 1);
    inspection.hold.assign(n, DiskHold::held);
    const auto loaded = [&](std::size_t i) {
        return packing.load && !packing.load->disk.empty() &&
               !(packing.load->disk[2 * i].is_zero() && packing.load->disk[2 * i + 1].is_zero());
    };
    // A movable wall under no force carries none: all its normals point the same way.
    for (std::size_t a = 0; a < 2; ++a) {
        if (packing.walls.upper[a] == WallKind::movable && packing.load && packing.load->wall[a].is_zero()) {
            for (const std::size_t l : of_wall[a]) {
                inspection.carrying[l] = 0;
            }
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < n; ++i) {
            if (packing.is_fixed(static_cast<int>(i)) || loaded(i)) {
                inspection.hold[i] = packing.is_fixed(static_cast<int>(i)) ? DiskHold::fixed : DiskHold::loaded;
                continue;
            }
            std::vector<Vector> normals;
            std::vector<std::size_t> left;
            for (const std::size_t l : of_disk[i]) {
                if (inspection.carrying[l] != 0) {
                    Vector normal;
                    for (const auto& [dof, value] : matrix.column[l]) {
                        for (std::size_t a = 0; a < 2; ++a) {
                            normal[a] = dof == dofs.dof_of(2 * i + a) ? value : normal[a];
                        }
                    }
                    normals.push_back(normal);
                    left.push_back(l);
                }
            }
            if (surround(normals)) {
                inspection.hold[i] = DiskHold::held;
                continue;
            }
            const int along = opposite(normals);
            inspection.hold[i] = along < 0 ? DiskHold::rattler : DiskHold::bridge;
            for (std::size_t k = 0; k < left.size(); ++k) {
                // On the border of a half-plane only the forces along that border can balance.
                if (along < 0 || cross_sign(normals[static_cast<std::size_t>(along)], normals[k]) != 0) {
                    inspection.carrying[left[k]] = 0;
                    changed = true;
                }
            }
        }
    }
}

} // namespace isostat::crafted
