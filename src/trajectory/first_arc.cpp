// One arc, and the mechanism that begins one, without a run.
#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/core/result.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <algorithm>
#include <atomic>

namespace isostat {

namespace {

/// Ends the run after its first arc.
class OneArc final : public RunObserver {
  public:
    void on_arc(const ArcRecord& arc) override {
        if (!seen) {
            seen = arc;
            stop = true;
        }
    }
    std::optional<ArcRecord> seen;
    std::atomic<bool> stop = false;
};

} // namespace

Result<ArcRecord> first_arc(State state, int direction, RunOptions options) {
    OneArc observer;
    options.stop = &observer.stop;
    Segment segment;
    segment.direction = direction;
    segment.equilibria = 1;
    RunCounters counters;
    const SegmentOutcome outcome = run_segment(state, segment, 0, options, counters, observer);
    if (observer.seen) {
        return std::move(*observer.seen);
    }
    return outcome.failure.value_or(Failure{FailureKind::no_limit, "no arc was made"});
}

Result<std::vector<double>> mechanism(const State& state, const Contact& opened) {
    const auto found = std::find(state.contacts.begin(), state.contacts.end(), opened);
    if (found == state.contacts.end()) {
        throw Error(ErrorKind::bad_input,
                    to_string(opened, state.packing.dimension) + ": expected a contact of the state");
    }
    auto structure = IsostaticStructure::prove(state.packing, state.contacts);
    if (!structure.ok()) {
        return structure.failure();
    }
    std::vector<double> velocity(state.contacts.size(), 0.0);
    velocity[static_cast<std::size_t>(found - state.contacts.begin())] = -1; // an approach velocity
    Factorisation(structure.value()).solve_velocities(velocity);
    return velocity;
}

} // namespace isostat
