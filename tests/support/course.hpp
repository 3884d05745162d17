#pragma once
// A run of one segment, kept: events, arcs, equilibria, states, and how it ended.

#include "support/segments.hpp"
#include "support/test.hpp"

#include <isostat/trajectory/trajectory.hpp>

namespace crafted {

using isostat::ArcRecord;
using isostat::EquilibriumRecord;
using isostat::RunCounters;
using isostat::RunObserver;
using isostat::RunOptions;
using isostat::Segment;
using isostat::SegmentOutcome;
using isostat::State;
using isostat::tie_direction;
using isostat::TieDecision;
using isostat::TiePolicy;

/// How a test settles ties: not; by first-order terms alone; or by choices too.
enum class Ties { stop, first_order, choose };
inline void settle(RunOptions& options, Ties ties) {
    options.ties = ties == Ties::stop ? TiePolicy::stop : TiePolicy::choose;
    options.max_choices = ties == Ties::first_order ? 0 : options.max_choices;
}

struct Course {
    std::vector<std::string> events;
    std::vector<EquilibriumRecord> equilibria;
    std::vector<State> states;
    std::vector<ArcRecord> arcs;
    SegmentOutcome outcome;
    RunCounters counters;
    [[nodiscard]] std::string end() const {
        return outcome.completed ? "completed" : isostat::to_string(outcome.failure->kind);
    }
};

class CourseRecorder : public RunObserver {
  public:
    explicit CourseRecorder(Course& course) : course_(course) {}
    void on_arc(const ArcRecord& arc) override {
        course_.events.push_back(
            fmt::format("{}:{}>{}", arc.equilibrium, isostat::to_string(arc.opened), isostat::to_string(arc.closed)));
        course_.arcs.push_back(arc);
    }
    void on_equilibrium(const EquilibriumRecord& record, const State& state, const std::vector<double>&) override {
        course_.equilibria.push_back(record);
        course_.states.push_back(state);
    }

  private:
    Course& course_;
};

inline Course follow_load(State state, int direction, int equilibria, Ties ties, std::uint64_t seed = 1) {
    Course course;
    CourseRecorder recorder(course);
    RunOptions options;
    settle(options, ties);
    options.ties_seed = seed;
    course.outcome = run_segment(state, towards(direction * equilibria), 0, options, course.counters, recorder);
    return course;
}

inline bool mentions(const Course& course, const std::string& word) {
    return course.outcome.failure && course.outcome.failure->message().find(word) != std::string::npos;
}

inline bool settled_as(const Course& course, const std::string& what) {
    for (const ArcRecord& arc : course.arcs) {
        for (const TieDecision& tie : arc.perturbed) {
            if (tie.what == what) {
                return true;
            }
        }
    }
    return false;
}

} // namespace crafted
