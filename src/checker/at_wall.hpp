#pragma once
/// \file
/// A disk and a wall as the checker sees them: the only code of the checker that says where a wall stands and which
/// contacts with walls there can be.

#include "checker/index.hpp"

#include <isostat/packing/packing.hpp>

#include <cstddef>
#include <optional>
#include <type_traits>

namespace isostat::checker {

/// The distance of the centre of a disk from a wall is `sign` times (x - the place of the wall).
struct AtWall {
    std::size_t disk;                ///< the coordinate x of the disk along the axis of the wall
    std::optional<std::size_t> wall; ///< the coordinate at which the wall stands; none: the wall stands at 0
    int sign = 1;                    ///< +1: the disk is above the wall, -1: below

    /// \pre `contact.is_wall()`
    AtWall(const Contact& contact, const Layout& layout)
        : disk(layout.of_disk(contact.i) + static_cast<std::size_t>(contact.j)) {
        if (contact.kind == ContactKind::upper_wall) {
            wall = layout.of_length(static_cast<std::size_t>(contact.j));
            sign = -1;
        }
    }
    /// The distance, or its rate, where `at` gives a number for each coordinate.
    template <class At> [[nodiscard]] auto distance(At at) const {
        using Number = std::remove_cvref_t<decltype(at(disk))>;
        return !wall ? Number(at(disk)) : sign > 0 ? Number(at(disk) - at(*wall)) : Number(at(*wall) - at(disk));
    }
    /// The same of anything that has one number per coordinate.
    template <class Numbers> [[nodiscard]] auto distance_in(const Numbers& of) const {
        return distance([&of](std::size_t k) -> decltype(auto) { return of[k]; });
    }
};

/// \pre `contact.is_wall()`
inline WallKind wall_of(const Packing& packing, const Contact& contact) {
    return (contact.kind == ContactKind::upper_wall ? packing.walls.upper : packing.walls.lower)[at(contact.j)];
}

/// Calls visit(contact) for a disk and every wall that is there, axis after axis. The list is the checker's own, so
/// that a wall that the library forgets is not forgotten here.
template <class Visit> void for_each_wall(const Packing& packing, int disk, Visit visit) {
    for (int a = 0; a < packing.dimension; ++a) {
        for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
            if (const Contact wall(kind, disk, a); wall_of(packing, wall) != WallKind::absent) {
                visit(wall);
            }
        }
    }
}

} // namespace isostat::checker
