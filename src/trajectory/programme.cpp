#include <isostat/core/result.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

namespace isostat {

Segment segment_of(const ProgrammeStep& step, const Load& load, const std::string& source) {
    Segment segment;
    segment.name = step.name;
    segment.equilibria = step.equilibria;
    segment.from = step.from;
    if (step.to) {
        segment.to_stress = *step.to * load.other_stress();
    }
    segment.direction = step.action == Action::up                   ? +1
                        : step.action == Action::down               ? -1
                        : *segment.to_stress > load.loaded_stress() ? +1
                                                                    : -1;
    if (step.to && !(segment.direction * (*segment.to_stress - load.loaded_stress()) > 0)) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{}:{}: segment \"{}\": {} is {} at its start: expected a {} ratio than {}", source,
                                step.line, step.name, load.ratio_name(), load.ratio(),
                                segment.direction > 0 ? "larger" : "smaller", *step.to));
    }
    return segment;
}

ProgrammeOutcome play(const Programme& programme, State& state, const RunOptions& options, RunCounters& counters,
                      RunObserver& observer) {
    int made = programme.made;
    for (std::size_t s = programme.first; s < programme.steps.size(); ++s, made = 0) {
        const ProgrammeStep& step = programme.steps[s];
        if (step.from && made == 0) {
            if (*step.from > counters.equilibria) {
                return {std::nullopt, step.name,
                        fmt::format("segment \"{}\" starts from equilibrium {}, but the run has only reached {}",
                                    step.name, *step.from, counters.equilibria)};
            }
            state = programme.stored(*step.from);
        }
        Segment segment;
        try {
            segment = segment_of(step, state.load, programme.source);
        } catch (const Error& error) {
            return {std::nullopt, step.name, error.what()};
        }
        observer.on_segment(static_cast<int>(s), segment, made, state);
        if (segment.equilibria) {
            *segment.equilibria -= made;
        }
        const SegmentOutcome outcome = run_segment(state, segment, static_cast<int>(s), options, counters, observer);
        if (!outcome.completed) {
            return {outcome.failure, step.name, {}};
        }
    }
    return {};
}

} // namespace isostat
