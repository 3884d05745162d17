#pragma once
/// \file
/// The exact run that a series is compared with.

#include "compare/nearest_arc.hpp"

#include <isostat/compare/compare.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

struct Path {
    std::vector<PathEquilibrium> equilibria;
    std::vector<int> at_load; ///< per load: the equilibrium at that load, -1 beyond the end of the run
    std::string end;          ///< empty, or why the run ends before the last load
};

/// The run from `state` to each of the loads in turn.
Path follow(State state, const std::vector<double>& loads, const RunOptions& options);
/// As `follow`, then three equilibria more in the last direction; soft limits are added when `stiffness` > 0. \p arcs:
/// null, or receives all arcs.
Path follow_beyond(State state, const std::vector<double>& loads, const RunOptions& options, double stiffness,
                   NearestArcs* arcs);

/// The contacts that carry a force in the equilibrium at the loaded stress `sigma` that a run from `state` reaches:
/// step by step, or with `jump` after the whole change at once.
Result<std::vector<Contact>> list_after(State state, double sigma, bool jump, const RunOptions& options);

} // namespace isostat::compare
