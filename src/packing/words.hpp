#pragma once
/// \file
/// Words of files and options for walls, loads and axes.

#include "core/words.hpp"

#include <isostat/packing/load.hpp>

namespace isostat {

inline constexpr std::array wall_kind_words{"absent", "fixed", "movable"}; ///< of `WallKind`
inline constexpr std::array load_kind_words{"nominal", "true"};            ///< of `LoadKind`
inline constexpr std::array axis_names{"x", "y", "z"};
inline constexpr std::array tilt_names{"xy", "xz", "yz"};

/// What a grain is called.
constexpr const char* grain_word(int dimension) {
    return dimension == plane ? "disk" : "sphere";
}

} // namespace isostat
