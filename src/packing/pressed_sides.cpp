#include "packing/pressed_sides.hpp"

#include "packing/words.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

namespace isostat {

void require_pressed_sides(const Packing& packing, const Load& load, bool stated, const std::string& source) {
    const bool present = load.kind == LoadKind::true_stress;
    for (const WallForce& wall : load.wall_forces(packing)) {
        const auto pressed = static_cast<std::size_t>(wall.axis);
        for (std::size_t side = 0; side < packing.axes(); ++side) {
            const bool open =
                packing.walls.lower[side] == WallKind::absent || packing.walls.upper[side] == WallKind::absent;
            if (side != pressed && open && !packing.cell.periodic[side] && (present || !stated)) {
                throw Error(ErrorKind::bad_input,
                            fmt::format("{}: {}, and the stress along {} presses over the length along {}, where a "
                                        "wall is absent: expected nominal stresses with reference_length in load, as "
                                        "the place of an absent wall means nothing",
                                        source, present ? "load.kind is \"true\"" : "load has no reference_length",
                                        axis_names.at(pressed), axis_names.at(side)));
            }
        }
    }
}

} // namespace isostat
