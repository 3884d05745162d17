/// \file
/// Which states a run can follow.

#include "packing/load_faults.hpp"

#include <isostat/core/result.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>
#include <qd/dd_real.h>

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
    if (state.load.kind == LoadKind::true_stress && cell.shears()) {
        refuse(
            "true stresses have no potential where the tilt moves, and nothing would tell where a run leads: expected "
            "dead loads, kind = \"nominal\", or a tilt that does not move");
    }
    const auto balanced = [&](const std::vector<double>& forces, const char* what) {
        if (const auto left = unbalanced<dd_real>(forces, cell)) {
            refuse(fmt::format("the {} along axis {} sum to {}: expected 0 exactly, or the pinned disk would bear "
                               "the rest",
                               what, left->first, to_double(left->second)));
        }
    };
    balanced(state.load.infinitesimal, "infinitesimal loads");
    balanced(state.load.disk_force, "forces on disks");
}

} // namespace isostat
