#pragma once
/// \file
/// Loads that mean nothing on a packing.

#include <isostat/packing/load.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace isostat {

/// Forces on disks along periodic axes sum to zero, exactly: else the pinned disk bears the rest, whichever it is.
/// The first periodic axis along which the forces, d per disk, do not sum to zero, and their sum. `Exact` rounds no
/// sum.
template <class Exact, class Force>
std::optional<std::pair<std::size_t, Exact>> unbalanced(const std::vector<Force>& forces, const Cell& cell) {
    const auto axes = static_cast<std::size_t>(cell.dimension);
    for (std::size_t a = 0; a < axes; ++a) {
        Exact sum(0);
        for (std::size_t k = a; k < forces.size() && cell.periodic[a]; k += axes) {
            sum += Exact(forces[k]);
        }
        if (!(sum == Exact(0))) {
            return std::pair(a, sum);
        }
    }
    return std::nullopt;
}

/// Throws `Error(bad_input)` where a wall, or a period, is pressed over the length of a side that has no length: one of
/// its walls is absent, whose place means nothing. That is so of true stresses, and of nominal ones where the reference
/// lengths are not stated (`stated`): then they would be the present ones.
void require_pressed_sides(const Packing& packing, const Load& load, bool stated, const std::string& source);

} // namespace isostat
