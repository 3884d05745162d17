#include "rigidity/rigid_group.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace isostat {

namespace {

/// Disks and walls that contacts join.
struct Group {
    std::vector<unsigned char> disk;
    PerAxis<bool> at_zero{}; ///< walls normal to the axis
    PerAxis<bool> at_length{};

    Group(int disks, const std::vector<Contact>& contacts) : disk(static_cast<std::size_t>(disks), 0) {
        for (const Contact& contact : contacts) {
            const auto j = static_cast<std::size_t>(contact.j);
            disk[static_cast<std::size_t>(contact.i)] = 1;
            if (contact.of_disks()) {
                disk[j] = 1;
            } else {
                (contact.wall().at_length ? at_length : at_zero)[j] = true;
            }
        }
    }
};

/// Whether a coordinate of a disk counts as free. A coordinate of a pinned disk does (proofs/cells.md, C1): a group
/// that belongs to no cell may be moved as a whole.
bool counts(const DofMap& dofs, std::size_t disk, std::size_t axis) {
    return dofs.is_periodic(axis) || dofs.dof_of(plane * disk + axis) >= 0;
}

/// Number of axis translations and rotations that keep every gap in the group and move nothing that is fixed.
int rigid_motions(const DofMap& dofs, const Group& group) {
    assert(dofs.layout().dimension == plane); // one rotation
    const std::size_t walls = plane * group.disk.size();
    int motions = 0;
    bool rotates = true;
    for (std::size_t axis = 0; axis < plane; ++axis) {
        bool moves = !group.at_zero[axis] && (!group.at_length[axis] || dofs.dof_of(walls + axis) >= 0);
        rotates = rotates && !group.at_zero[axis] && !group.at_length[axis];
        for (std::size_t i = 0; i < group.disk.size(); ++i) {
            if (group.disk[i] != 0 && !counts(dofs, i, axis)) {
                moves = rotates = false;
            }
        }
        motions += moves ? 1 : 0;
    }
    return motions + (rotates ? 1 : 0);
}

/// Degrees of freedom of the group less its rigid motions.
int motions_to_hold(const DofMap& dofs, const Group& group) {
    const std::size_t walls = plane * group.disk.size();
    int free = 0;
    for (std::size_t i = 0; i < group.disk.size(); ++i) {
        for (std::size_t axis = 0; group.disk[i] != 0 && axis < plane; ++axis) {
            free += counts(dofs, i, axis) ? 1 : 0;
        }
    }
    for (std::size_t axis = 0; axis < plane; ++axis) {
        free += group.at_length[axis] && dofs.dof_of(walls + axis) >= 0 ? 1 : 0;
    }
    return free - rigid_motions(dofs, group);
}

using Periods = std::array<int, 3>;

/// a + sign m
Periods moved(Periods a, const Image& m, int sign) {
    for (std::size_t k = 0; k < a.size(); ++k) {
        a[k] += sign * m.m[k];
    }
    return a;
}

} // namespace

bool moves_as_one(const DofMap& dofs, int disks, const std::vector<Contact>& among, const Contact& pair) {
    std::vector<Contact> all = among;
    all.push_back(pair);
    if (!unwound(disks, all)) {
        return false;
    }
    return static_cast<int>(among.size()) == motions_to_hold(dofs, Group(disks, all));
}

std::optional<std::vector<Contact>> unwound(int disks, std::vector<Contact> contacts) {
    const auto any = [&](auto what) { return std::ranges::any_of(contacts, what); };
    if (any([](const Contact& c) { return c.kind == ContactKind::held || c.kind == ContactKind::bar; })) {
        return std::nullopt;
    }
    if (!any([](const Contact& c) { return !c.image.is_here(); })) {
        return contacts;
    }
    std::vector<std::vector<std::size_t>> at(static_cast<std::size_t>(disks));
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (contacts[l].of_disks()) {
            at[static_cast<std::size_t>(contacts[l].i)].push_back(l);
            at[static_cast<std::size_t>(contacts[l].j)].push_back(l);
        }
    }
    std::vector<std::optional<Periods>> by(at.size()); // how far each disk is moved; empty: not reached
    std::vector<std::size_t> next;
    for (std::size_t first = 0; first < at.size(); ++first) {
        if (by[first] || at[first].empty()) {
            continue;
        }
        by[first] = Periods{};
        next.push_back(first);
        while (!next.empty()) {
            const std::size_t disk = next.back();
            next.pop_back();
            for (const std::size_t l : at[disk]) {
                const Contact& c = contacts[l];
                const bool forwards = static_cast<std::size_t>(c.i) == disk;
                const auto other = static_cast<std::size_t>(forwards ? c.j : c.i);
                const Periods there = moved(*by[disk], c.image, forwards ? 1 : -1);
                if (!by[other]) {
                    by[other] = there;
                    next.push_back(other);
                } else if (*by[other] != there) {
                    return std::nullopt;
                }
            }
        }
    }
    for (Contact& c : contacts) {
        c.image = {};
    }
    return contacts;
}

} // namespace isostat
