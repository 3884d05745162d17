#pragma once
/// \file
/// The exact run beside a series.

#include "compare/nearest_arc.hpp"

#include <isostat/compare/compare.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

struct Path {
    std::vector<PathEquilibrium> equilibria;
    std::vector<int> at_load; ///< per load: the equilibrium there, -1 beyond the end of the run
    std::string end;          ///< empty, or why it ends before the last load
};

/// From `state` to each of the loads in turn.
Path follow(State state, const std::vector<double>& loads, const RunOptions& options);
/// The same, then three equilibria on in the last direction; soft limits are added when `stiffness` > 0. \p arcs: null,
/// or told of all arcs.
Path follow_beyond(State state, const std::vector<double>& loads, const RunOptions& options, double stiffness,
                   NearestArcs* arcs);

/// The contacts that carry a force in the equilibrium at the loaded stress `sigma` that a run from `state` finds: on
/// the way, or with `jump` after the whole change at once.
Result<std::vector<Contact>> list_after(State state, double sigma, bool jump, const RunOptions& options);

} // namespace isostat::compare
