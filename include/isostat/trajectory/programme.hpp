#pragma once
/// \file
/// A whole load programme: segment after segment, from the last equilibrium or from an earlier one.

#include <isostat/trajectory/trajectory.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// What a segment of the programme does to the stress ratio sigma_2 / sigma_1 (shear / sigma_2 where the tilt is
/// loaded).
enum class Action { up, down, to };

/// One segment as a scene names it ([[programme]] entry): its goal is a ratio, not a stress.
struct ProgrammeStep {
    Action action = Action::up;
    std::optional<int> equilibria; ///< `equilibria`: stop after this many new ones
    std::optional<double> to;      ///< `to`: stop at this ratio sigma_2 / sigma_1, inside a supported interval
    std::optional<int> from;       ///< `from`: start from this equilibrium of the run instead of the last one
    bool of_shear = false;         ///< the tilt is loaded: `to` is a ratio shear / sigma_2, of either sign
    std::string name;              ///< `name`, or made from the rest
    int line = 0;                  ///< in the scene file
};

/// The programme's segment for a state under `load`: direction and stress of the goal.
/// Throws `Error(bad_input)`, starting with `source`, when the ratio to reach lies behind.
Segment segment_of(const ProgrammeStep& step, const Load& load, const std::string& source);

/// What is to be done, and from where on.
struct Programme {
    std::vector<ProgrammeStep> steps;
    std::string source;    ///< what messages about a step start with: the name of the scene file
    std::size_t first = 0; ///< step to begin with, or to go on with
    int made = 0;          ///< equilibria made in it already
    /// The state of an earlier equilibrium of the run, for steps that start `from` it.
    std::function<State(int)> stored;
};

/// How a programme ended: completed when neither is there.
struct ProgrammeOutcome {
    std::optional<Failure> failure; ///< of the segment called `segment`
    std::string segment;
    std::string
        impossible; ///< not empty: a step that cannot begin where the run is, in words; only the packing could tell
};

/// Plays the steps one after the other with `run_segment`, from `state`. The observer is told of each segment before it
/// begins. \post `state` is the last equilibrium reached; `counters` advanced. Throws what `stored` throws.
ProgrammeOutcome play(const Programme& programme, State& state, const RunOptions& options, RunCounters& counters,
                      RunObserver& observer);

} // namespace isostat
