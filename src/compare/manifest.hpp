#pragma once
/// \file
/// The manifest of a series as read, and a first one for a series without.

#include <isostat/compare/compare.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace isostat::compare {

struct Manifest {
    Series series;                       ///< without frames
    std::string disks, contacts, frames; ///< paths; `contacts` may be empty
    std::string contact_i, contact_j;
    std::vector<std::string> contact_force;  ///< one column, or those of a vector
    std::vector<std::string> wall_force;     ///< as `wall_names`: columns of `disks`, or empty
    std::string size;                        ///< column of the sizes
    bool diameters = false;                  ///< the sizes are diameters
    std::string select_column, select_value; ///< disks with this value; empty: all
    double length_factor = 1, force_factor = 1;
    LoadKind load = LoadKind::nominal;
    PerAxis<double> stress{}; ///< except on the last axis, where the frames have it (`several`: 0, the frames have all)
    PerAxis<double> reference_length{};
    bool periodic = false; ///< frames of a periodic cell: the bounds of the dump are its periods
    bool tilted = false;   ///< its tilts move, under no shear stress

    [[nodiscard]] std::size_t axes() const { return static_cast<std::size_t>(series.dimension); }
    /// Names of the walls: the lower ones, axis by axis, then the upper ones.
    [[nodiscard]] std::vector<std::string> wall_names() const;
    /// The contact of a grain with number `wall` of these.
    [[nodiscard]] Contact with_wall(int grain, std::size_t wall) const;
    /// The product of the reference lengths of the other axes, on which a nominal stress acts.
    [[nodiscard]] double reference_area(std::size_t axis) const;
};

Manifest read_manifest(const std::filesystem::path& path);

/// The texts of a manifest for a file of frames, and of its table of frames. Loads and walls, which the file does not
/// have (the bounds of a dump are no walls), are left for the user to fill in.
struct BegunSeries {
    std::string manifest, frames;
};

/// \p disks: file of the frames. \p frames: name of the table in the manifest. Throws `Error(bad_input)` for the file.
BegunSeries begin_series(const std::filesystem::path& disks, const std::string& name, const std::string& frames);

} // namespace isostat::compare
