#pragma once
/// \file
/// What `import` and `snap` take from a packing of soft grains: the list of its contacts, the stresses.

#include "cli/read_packing.hpp"

#include <isostat/contact/contact.hpp>

#include <array>
#include <string>
#include <vector>

namespace isostat::cli {

/// A packing must be this near to touching, in smallest radii: overlaps, and gaps at every wall.
inline constexpr double nearly_touching = 0.1;

/// Two positive numbers, as in "S1,S2"; `names` is that. Throws `Error(usage)`.
std::array<double, 2> parse_pair(const std::string& text, const char* option, const char* names);
/// Of --stress; 1,1 for an empty text.
std::array<double, 2> parse_stress(const std::string& text);

/// Throws `Error(bad_input)` about a file.
[[noreturn]] void refuse(const std::string& file, const std::string& what);

/// Words on a wall that no disk is near; empty: every wall has one.
std::string far_wall(const Packing<2>& packing);

/// Every wall near a disk, no overlap deep: else the file is no packing of nearly rigid disks in these walls. Throws
/// `Error(bad_input)`.
void check_nearness(const std::string& file, const Packing<2>& packing);

/// `--cell`: what of a periodic cell moves, "rectangular", "tilted" or "isotropic"; empty: the tilt too if the file has
/// one.
struct CellStatement {
    std::string file, cell;
};
/// The periods move, as stated. Throws `Error(usage)` for a statement about walls, or about a channel.
void take_cell(const CellStatement& statement, Packing<2>& packing);

/// A list of contacts, and in words where it comes from.
struct SoftList {
    std::vector<Contact> contacts; ///< without rattlers, sorted
    std::vector<double> forces;    ///< that the file says of them; NaN: none. Empty: of none
    std::string words;
};

/// The pairs with a force in a LAMMPS dump of style local (\p columns: "I,J,FORCE") and the walls that a disk overlaps.
SoftList list_by_forces(const std::string& file, const ReadPacking& packing, const std::string& frame,
                        const std::string& contacts, const std::string& columns);

/// The pairs that overlap.
SoftList list_by_overlaps(const Packing<2>& packing);

} // namespace isostat::cli
