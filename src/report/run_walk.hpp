#pragma once
/// \file
/// Every vertex of a run, recomputed from its records: for pictures.

#include "checker/run_records.hpp"

#include <functional>
#include <string>
#include <vector>

namespace isostat {

/// A vertex of a run. References are valid during the call only.
struct WalkedVertex {
    const State& state;
    const checker::EventRecord* arc = nullptr;    ///< the arc that ended here; null: no arc did, or it is not known
    const EquilibriumLine* equilibrium = nullptr; ///< null: between equilibria
    const State* from = nullptr;                  ///< start of the arc
    const State* start = nullptr;                 ///< start of the rearrangement; null: not known
    bool relisted = false;                        ///< the order of the contacts is new: a stored state was read
};

/// Called for each vertex, in the order of the records. `false` ends the walk.
using WalkVisitor = std::function<bool(const WalkedVertex&)>;

/// Follows the arcs in double from states/eq_000000.json, as `verify` does before it
/// proves anything: the results are for display. Each vertex is solved for anew, so errors
/// do not add up. Where an arc cannot be followed its vertices are left out up to the next
/// stored state. Returns what was left out, in words. Cost: some factorisations per arc.
std::vector<std::string> walk_run(const checker::RunRecords& records, const WalkVisitor& visit);

} // namespace isostat
