#pragma once
/// \file
/// Words of files and options for walls, loads and axes.

#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

namespace isostat {

inline constexpr auto wall_kind_words = words_of<WallKind>("absent", "fixed", "movable"); ///< of `WallKind`
inline constexpr auto load_kind_words = words_of<LoadKind>("nominal", "true");            ///< of `LoadKind`
inline constexpr std::array lower_wall_names{"left", "bottom", "back"};                   ///< of the axes
inline constexpr std::array upper_wall_names{"right", "top", "front"};
inline constexpr std::array axis_names{"x", "y", "z"};
inline constexpr std::array tilt_names{"xy", "xz", "yz"};

/// \pre a contact with a wall
constexpr const char* wall_name(const Contact& contact) {
    const auto axis = static_cast<std::size_t>(contact.j);
    return contact.kind == ContactKind::lower_wall ? lower_wall_names[axis] : upper_wall_names[axis];
}

/// What a grain is called.
constexpr const char* grain_word(int dimension) {
    return dimension == plane ? "disk" : "sphere";
}

} // namespace isostat
