#include "statics/equal_forces.hpp"

#include <algorithm>
#include <utility>

namespace isostat {

namespace {

/// A sphere in the edge of two walls.
struct Edge {
    const std::vector<Contact>& contacts;
    const Contact& one; ///< the sphere at each of the two walls
    const Contact& other;

    [[nodiscard]] bool has(Contact wall, int sphere) const {
        wall.i = sphere;
        return std::ranges::find(contacts, wall) != contacts.end();
    }
    /// The contact acts on the sphere equally towards both walls.
    [[nodiscard]] bool presses_alike(const Contact& c, int dimension) const {
        if (c.of_disks()) {
            const int neighbour = c.i == one.i ? c.j : c.i;
            return neighbour == one.i || (c.i != one.i && c.j != one.i) ||
                   (has(one, neighbour) && has(other, neighbour));
        }
        if (c.kind == ContactKind::held) {
            return c.i / dimension != one.i || (c.i % dimension != one.j && c.i % dimension != other.j);
        }
        return c.i != one.i || c == one || c == other || (c.j != one.j && c.j != other.j);
    }
};

/// The sphere moves, and only contacts act on it.
bool moves_without_load(const Statics& statics, int sphere) {
    const DofMap& dofs = statics.structure().dofs();
    const std::vector<int>& rows = statics.loaded_rows();
    const std::size_t first = dofs.layout().of_disk(sphere);
    const auto of_sphere = [&](int row) {
        const auto coordinate = static_cast<std::size_t>(dofs.coordinate_of(row));
        return coordinate >= first && coordinate < first + dofs.layout().axes();
    };
    const bool moves = dofs.dof_of(first) >= 0 || dofs.dof_of(first + 1) >= 0; // the pinned sphere moves along walls
    return moves && std::ranges::none_of(rows, of_sphere);
}

/// Two members of one size, which are a whole body, and their contacts with one grain.
struct Notch {
    const Statics& statics;
    int i, j;
    ContactId one, other;

    [[nodiscard]] bool is_member(int m) const { return m == i || m == j; }
    /// Both touch a wall of the other axis; along this one they move without load, and only the two contacts press.
    [[nodiscard]] bool lies_level(int axis) const {
        const std::vector<Contact>& contacts = statics.structure().contacts();
        const DofMap& dofs = statics.structure().dofs();
        bool level = false;
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            const Contact& c = contacts[l];
            const ContactId id(l);
            Contact mirror = c;
            mirror.i = j;
            level = level ||
                    (c.is_wall() && c.i == i && c.j != axis && std::ranges::find(contacts, mirror) != contacts.end());
            const bool along = c.is_wall() ? c.j == axis : c.kind != ContactKind::held || c.i % plane == axis;
            const bool first = is_member(c.kind == ContactKind::held ? c.i / plane : c.i);
            const bool second = c.of_disks() && is_member(c.j);
            const bool own = c.kind == ContactKind::bar && first && second;
            if ((first || second) && along && !own && id != one && id != other && !statics.is_structural_zero(id)) {
                return false;
            }
        }
        const auto moves = [&](int m) { return dofs.dof_of(static_cast<std::size_t>(plane * m + axis)) >= 0; };
        return level && moves(i) && moves(j) && moves_without_load(statics, i) && moves_without_load(statics, j);
    }
};

std::vector<EqualForce> equal_in_notch(const Statics& statics, ContactId of) {
    const std::vector<Contact>& contacts = statics.structure().contacts();
    const std::vector<double>& radius = statics.packing().radius;
    const Contact& c = contacts[of.index()];
    std::vector<EqualForce> equal;
    for (const Bar& bar : statics.packing().bars) {
        for (const auto& [i, j] : {std::pair(bar.i, bar.j), std::pair(bar.j, bar.i)}) {
            const int k = c.i == i ? c.j : c.i;
            if (c != pair_of(i, k) || statics.is_structural_zero(of) ||
                radius[static_cast<std::size_t>(i)] != radius[static_cast<std::size_t>(j)]) {
                continue;
            }
            const auto found = std::ranges::find(contacts, pair_of(j, k));
            const ContactId mate(static_cast<std::size_t>(found - contacts.begin()));
            const Notch notch{statics, i, j, of, mate};
            if (found != contacts.end() && (notch.lies_level(0) || notch.lies_level(1))) {
                equal.push_back({mate, statics.infinitesimal(mate) - statics.infinitesimal(of)});
            }
        }
    }
    return equal;
}

std::vector<EqualForce> equal_in_edge(const Statics& statics, ContactId of) {
    const std::vector<Contact>& contacts = statics.structure().contacts();
    const int dimension = statics.structure().dofs().layout().dimension;
    const Contact& one = contacts[of.index()];
    std::vector<EqualForce> equal;
    if (!one.is_wall() || statics.is_structural_zero(of) || !moves_without_load(statics, one.i)) {
        return equal;
    }
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        const Contact& other = contacts[k];
        const ContactId mate(k);
        if (!other.is_wall() || other.i != one.i || other.j == one.j || statics.is_structural_zero(mate)) {
            continue;
        }
        const Edge edge{contacts, one, other};
        bool alike = true;
        for (std::size_t l = 0; l < contacts.size() && alike; ++l) {
            alike = statics.is_structural_zero(ContactId(l)) || edge.presses_alike(contacts[l], dimension);
        }
        if (alike) {
            equal.push_back({mate, statics.infinitesimal(mate) - statics.infinitesimal(of)});
        }
    }
    return equal;
}

} // namespace

std::vector<EqualForce> equal_by_place(const Statics& statics, ContactId of) {
    return statics.packing().dimension == plane ? equal_in_notch(statics, of) : equal_in_edge(statics, of);
}

} // namespace isostat
