#pragma once
/// \file
/// The list of contacts of a packing of soft grains.

#include "snap/frame_file.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/crafted/plateau.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// A packing must be this near to touching, in smallest radii: overlaps, and gaps at every wall.
inline constexpr double nearly_touching = 0.1;

/// Throws `Error(bad_input)` about a file.
[[noreturn]] void refuse(const std::string& file, const std::string& what);

/// Words on a wall that no disk is near; empty: every wall has one.
std::string far_wall(const Packing& packing);

/// Words where the sizes seem to be wrong by a factor; empty: they do not. \p largest: threshold of the plateau.
std::string far_disks(const Packing& packing, double largest, const crafted::Plateau& plateau);

/// Every wall near a disk, no overlap deep: else the file is no packing of nearly rigid disks in these walls. Throws
/// `Error(bad_input)`.
void check_nearness(const std::string& file, const Packing& packing);

/// A list of contacts, and in words where it comes from.
struct SoftList {
    std::vector<Contact> contacts; ///< without rattlers, sorted
    std::vector<double> forces;    ///< that the file says of them; NaN: none. Empty: of none
    std::string words;
};

/// A force that a row says as a vector, on one grain of a contact from the other.
struct VectorForce {
    Contact contact;
    PerAxis<double> force{};
};
/// Their normal parts, positive; \p words says how large the tangential ones are. Throws `Error(bad_input)` where some
/// pull and others push, and where a tangential part is more than `force_agreement` mean forces: friction.
std::vector<double> normal_parts(const Packing& packing, const std::vector<VectorForce>& rows, const std::string& file,
                                 std::string& words);

/// The pairs with a force in a LAMMPS dump of style local or a table (`read_local_dump`) and the walls that a disk
/// overlaps. \p ids: of the disks.
SoftList list_by_forces(const std::string& file, const Packing& packing, const std::vector<long>& ids,
                        std::optional<long> frame, const std::string& contacts, const PairColumns& columns);

/// Pairs and walls with gaps up to half the smallest radius, and more: all that overlap, however deep. Sorted.
std::vector<Contact> near_contacts(const Packing& packing);
/// Those that overlap.
std::vector<Contact> overlaps_of(const Packing& packing);

/// The same as a list.
SoftList list_by_overlaps(const Packing& packing);

} // namespace isostat::compare
