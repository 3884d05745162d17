#pragma once
/// \file
/// Words of files and options for walls, loads and axes.

#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

namespace isostat {

inline constexpr auto wall_kind_words = words_of<WallKind>("absent", "fixed", "movable"); ///< of `WallKind`
inline constexpr auto load_kind_words = words_of<LoadKind>("nominal", "true");            ///< of `LoadKind`
inline constexpr std::array axis_names{"x", "y", "z"};                                    ///< of the axes
inline constexpr std::array tilt_names{"xy", "xz", "yz"};
inline constexpr auto upper_wall_names = Contact(ContactKind::upper_wall, 0, 0).wall().name; ///< of the axes

/// \pre a contact with a wall
constexpr const char* wall_name(const Contact& contact) {
    return contact.wall().name[static_cast<std::size_t>(contact.j)];
}

/// What a grain is called.
constexpr const char* grain_word(int dimension) {
    return dimension == plane ? "disk" : "sphere";
}

} // namespace isostat
