#include "statics/equal_forces.hpp"

#include <algorithm>

namespace isostat {

namespace {

/// A sphere in the edge of two walls.
struct Edge {
    const std::vector<Contact>& contacts;
    const Contact& one; ///< the sphere at each of the two walls
    const Contact& other;

    [[nodiscard]] bool has(Contact wall, int sphere) const {
        wall.i = sphere;
        return std::find(contacts.begin(), contacts.end(), wall) != contacts.end();
    }
    /// The contact acts on the sphere equally towards both walls.
    [[nodiscard]] bool presses_alike(const Contact& c, int dimension) const {
        switch (c.kind) {
        case ContactKind::disk_disk:
        case ContactKind::bar: {
            const int neighbour = c.i == one.i ? c.j : c.i;
            return neighbour == one.i || (c.i != one.i && c.j != one.i) ||
                   (has(one, neighbour) && has(other, neighbour));
        }
        case ContactKind::held:
            return c.i / dimension != one.i || (c.i % dimension != one.j && c.i % dimension != other.j);
        case ContactKind::lower_wall:
        case ContactKind::upper_wall: break;
        }
        return c.i != one.i || c == one || c == other || (c.j != one.j && c.j != other.j);
    }
};

bool is_wall(const Contact& c) {
    return c.kind == ContactKind::lower_wall || c.kind == ContactKind::upper_wall;
}

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
    return moves && std::none_of(rows.begin(), rows.end(), of_sphere);
}

} // namespace

std::vector<EqualForce> equal_in_edge(const Statics& statics, ContactId of) {
    const std::vector<Contact>& contacts = statics.structure().contacts();
    const int dimension = statics.structure().dofs().layout().dimension;
    const Contact& one = contacts[of.index()];
    std::vector<EqualForce> equal;
    if (dimension == plane || !is_wall(one) || statics.is_structural_zero(of) || !moves_without_load(statics, one.i)) {
        return equal;
    }
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        const Contact& other = contacts[k];
        const ContactId mate(k);
        if (!is_wall(other) || other.i != one.i || other.j == one.j || statics.is_structural_zero(mate)) {
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

} // namespace isostat
