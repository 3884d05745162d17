#include "rigidity/rigid_group.hpp"

#include <algorithm>
#include <array>

namespace isostat {

namespace {

/// Disks and walls that contacts join.
template <int Dim> struct Group {
    std::vector<unsigned char> disk;
    std::array<bool, Dim> lower{};
    std::array<bool, Dim> upper{};

    explicit Group(int disks) : disk(static_cast<std::size_t>(disks), 0) {}
    void add(const Contact& contact) {
        disk[static_cast<std::size_t>(contact.i)] = 1;
        if (contact.kind == ContactKind::disk_disk) {
            disk[static_cast<std::size_t>(contact.j)] = 1;
        } else {
            (contact.kind == ContactKind::lower_wall ? lower : upper)[static_cast<std::size_t>(contact.j)] = true;
        }
    }
};

/// Translations along an axis and rotations that keep every gap in the group: none of them may move what is fixed.
template <int Dim> int rigid_motions(const DofMap<Dim>& dofs, const Group<Dim>& group) {
    static_assert(Dim == 2, "one rotation");
    const std::size_t walls = Dim * group.disk.size();
    int motions = 0;
    bool rotates = true;
    for (std::size_t axis = 0; axis < Dim; ++axis) {
        bool moves = !group.lower[axis] && (!group.upper[axis] || dofs.dof_of(walls + axis) >= 0);
        rotates = rotates && !group.lower[axis] && !group.upper[axis];
        for (std::size_t i = 0; i < group.disk.size(); ++i) {
            if (group.disk[i] != 0 && dofs.dof_of(Dim * i + axis) < 0) {
                moves = rotates = false;
            }
        }
        motions += moves ? 1 : 0;
    }
    return motions + (rotates ? 1 : 0);
}

} // namespace

template <int Dim>
bool moves_as_one(const DofMap<Dim>& dofs, int disks, const std::vector<Contact>& among, const Contact& pair) {
    const auto held = [](const Contact& c) { return c.kind == ContactKind::held; };
    if (held(pair) || std::any_of(among.begin(), among.end(), held)) {
        return false; // a held coordinate is kept relative to the walls that do not move: no pair of grains
    }
    Group<Dim> group(disks);
    group.add(pair);
    std::for_each(among.begin(), among.end(), [&](const Contact& c) { group.add(c); });
    const std::size_t walls = static_cast<std::size_t>(Dim) * group.disk.size();
    int free = 0;
    for (std::size_t i = 0; i < group.disk.size(); ++i) {
        for (std::size_t axis = 0; group.disk[i] != 0 && axis < Dim; ++axis) {
            free += dofs.dof_of(Dim * i + axis) >= 0 ? 1 : 0;
        }
    }
    for (std::size_t axis = 0; axis < Dim; ++axis) {
        free += group.upper[axis] && dofs.dof_of(walls + axis) >= 0 ? 1 : 0;
    }
    return static_cast<int>(among.size()) == free - rigid_motions(dofs, group);
}

template bool moves_as_one<2>(const DofMap<2>&, int, const std::vector<Contact>&, const Contact&);

} // namespace isostat
