#pragma once
/// \file
/// Words of files and options for walls, loads and axes.

#include "core/words.hpp"

#include <isostat/packing/load.hpp>

namespace isostat {

inline constexpr EnumWords<3> wall_kind_words{"absent", "fixed", "movable"}; ///< of `WallKind`
inline constexpr EnumWords<2> load_kind_words{"nominal", "true"};            ///< of `LoadKind`
inline constexpr EnumWords<3> axis_names{"x", "y", "z"};
inline constexpr EnumWords<3> tilt_names{"xy", "xz", "yz"};

} // namespace isostat
