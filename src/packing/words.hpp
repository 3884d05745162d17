#pragma once
/// \file
/// Words of files and options for walls, loads and axes.

#include <isostat/core/words.hpp>
#include <isostat/packing/load.hpp>

namespace isostat {

inline constexpr auto wall_kind_words = words_of<WallKind>("absent", "fixed", "movable"); ///< of `WallKind`
inline constexpr auto load_kind_words = words_of<LoadKind>("nominal", "true");            ///< of `LoadKind`
inline constexpr std::array axis_names{"x", "y", "z"};
inline constexpr std::array tilt_names{"xy", "xz", "yz"};

/// What a grain is called.
constexpr const char* grain_word(int dimension) {
    return dimension == plane ? "disk" : "sphere";
}

} // namespace isostat
