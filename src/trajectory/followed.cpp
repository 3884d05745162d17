/// \file
/// Which states a run can follow.

#include <isostat/core/error.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>
#include <qd/dd_real.h>

#include <algorithm>

namespace isostat {

void require_followed(const State& state, const std::string& source) {
    const Cell& cell = state.packing.cell;
    if (!cell.any()) {
        return;
    }
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::bad_input, source + ": a periodic cell; " + what);
    };
    if (cell.keeps_shape) {
        refuse("it keeps its shape, and a load on its size only scales the forces: no contact ever opens. Expected a "
               "rectangular or tilted cell (inspect, certify and verify take this one)");
    }
    const bool shears = std::find(cell.tilt_moves.begin(), cell.tilt_moves.end(), true) != cell.tilt_moves.end();
    if (state.load.kind == LoadKind::true_stress && shears) {
        refuse(
            "true stresses have no potential where the tilt moves, and nothing would tell where a run leads: expected "
            "dead loads, kind = \"nominal\", or a tilt that does not move");
    }
    for (std::size_t a = 0; a < static_cast<std::size_t>(cell.dimension); ++a) {
        const auto balanced = [&](const std::vector<double>& forces, const char* what) {
            dd_real sum = 0.0;
            for (std::size_t k = a; k < forces.size() && cell.periodic[a];
                 k += static_cast<std::size_t>(cell.dimension)) {
                sum += forces[k];
            }
            if (!(sum == 0.0)) {
                refuse(fmt::format("the {} along axis {} sum to {}: expected 0 exactly, or the pinned disk would bear "
                                   "the rest",
                                   what, a, to_double(sum)));
            }
        };
        balanced(state.load.infinitesimal, "infinitesimal loads");
        balanced(state.load.disk_force, "forces on disks");
    }
}

} // namespace isostat
