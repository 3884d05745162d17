#include "packing/pressed_sides.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <array>

namespace isostat {

void require_pressed_sides(const Packing& packing, const Load& load, bool stated, const std::string& source) {
    constexpr std::array<char, 2> axis_name{'x', 'y'};
    const bool present = load.kind == LoadKind::true_stress;
    for (const WallForce& wall : load.wall_forces(packing)) {
        const auto side = static_cast<std::size_t>(packing.dimension - 1 - wall.axis);
        const bool open =
            packing.walls.lower[side] == WallKind::absent || packing.walls.upper[side] == WallKind::absent;
        if (open && !packing.cell.periodic[side] && (present || !stated)) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: {}, and the stress along {} presses over the length along {}, where a wall is "
                                    "absent: expected nominal stresses with reference_length in load, as the place of "
                                    "an absent wall means nothing",
                                    source, present ? "load.kind is \"true\"" : "load has no reference_length",
                                    axis_name.at(static_cast<std::size_t>(wall.axis)), axis_name.at(side)));
        }
    }
}

} // namespace isostat
