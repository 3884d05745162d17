#pragma once
/// \file
/// States and lists without rattlers, and places for rattlers without overlap beside a vertex.

#include <isostat/snap/snap.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace isostat::compare {

/// A contact with disk i named `number[i]`.
inline Contact renumbered(Contact contact, const std::vector<int>& number) {
    contact.i = number[static_cast<std::size_t>(contact.i)];
    contact.j = contact.of_disks() ? number[static_cast<std::size_t>(contact.j)] : contact.j;
    return contact;
}

/// These disks alone, with walls or cell. The pinned disk stays pinned if it is among them, else the first one is.
Packing of_disks(const Packing& packing, const std::vector<int>& disks);

/// The disks and movable walls of the contacts `carrying`, with these
/// contacts and the same load; infinitesimal loads are new generic ones.
State backbone_of(const State& state, const std::vector<Contact>& carrying);

/// The contacts that can carry a force by the positions of the normals, in their order: soft rattlers touch now and
/// then, and hard ones rest on as many contacts as there are axes. Held coordinates are left out. A contact of two
/// grains that carry other forces stays, because it holds a grain against directions in which the load does not act,
/// such as a sphere among three of its size on a wall.
std::vector<Contact> able_to_carry(const Packing& packing, std::vector<Contact> contacts);

/// Infinitesimal loads that give every contact of a grain without other force a positive force, where the list
/// determines this force: so the grain rests where it is. In a cell they sum to 0.
std::vector<double> resting_loads(const Packing& packing, const std::vector<Contact>& contacts, std::uint64_t seed);

/// Upper bound of a distance. `along`: bounds of its components.
template <class Along> double distance_above(std::size_t axes, const Along& along) {
    constexpr double up = 1 + 0x1p-49; // for a sum and a hypotenuse, each rounded
    const double in_plane = std::hypot(along(0), along(1)) * up;
    return axes == 2 ? in_plane : std::hypot(in_plane, along(2)) * up;
}

/// Moves the rattlers of `snap.packing` until no pair with one of them overlaps at
/// the true vertex, and sets `snap.cage`. Empty, or the pair that still overlaps:
/// this does not prove that no place exists. \pre the vertex is claimed.
std::string make_room(Snap& snap);

/// A rattler proved to have no place: anywhere within a quarter of the smallest radius of `snap.packing` it overlaps a
/// grain of the list at the true vertex. Empty: not proved of any. \pre the vertex is claimed.
std::string without_room(const Snap& snap);

} // namespace isostat::compare
