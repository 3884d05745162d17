#pragma once
/// \file
/// The manifest of a series, as it stands.

#include <isostat/compare/compare.hpp>

#include <array>
#include <optional>
#include <string>

namespace isostat::compare {

struct Manifest {
    Series series;                       ///< without frames
    std::string disks, contacts, frames; ///< paths; `contacts` may be empty
    std::string contact_i, contact_j, contact_force;
    std::array<std::string, 4> wall_force;   ///< left, bottom, right, top: columns of `disks`, or all empty
    std::string size;                        ///< column of the sizes
    bool diameters = false;                  ///< they are diameters
    std::string select_column, select_value; ///< disks with this value; empty: all
    double length_factor = 1, force_factor = 1;
    LoadKind load = LoadKind::nominal;
    double sigma1 = 0;
    std::array<double, 2> reference_length{};
    bool periodic = false; ///< frames of a periodic cell: the bounds of the dump are its periods
    bool tilted = false;   ///< its tilt moves, under no shear stress
};

/// Names of the walls in the order of `Manifest::wall_force`, and the contact of a disk with each.
inline constexpr std::array<const char*, 4> wall_names{"left", "bottom", "right", "top"};
Contact with_wall(int disk, std::size_t wall);

Manifest read_manifest(const std::filesystem::path& path);

} // namespace isostat::compare
