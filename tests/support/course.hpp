#pragma once
// A run of one segment, kept: events, arcs, equilibria, states, and how it ended.

#include "support/recorder.hpp"
#include "support/segments.hpp"
#include "support/test.hpp"

namespace crafted {

using namespace isostat;

/// How a test settles ties: not; by first-order terms alone; or by choices too.
enum class Ties { stop, first_order, choose };
inline void settle(RunOptions& options, Ties ties) {
    options.ties = ties == Ties::stop ? TiePolicy::stop : TiePolicy::choose;
    options.max_choices = ties == Ties::first_order ? 0 : options.max_choices;
}

struct Course : Recorder {
    std::vector<std::string> events;
    SegmentOutcome outcome;
    RunCounters counters;
    void on_arc(const ArcRecord& arc) override {
        events.push_back(fmt::format("{}:{}>{}", arc.equilibrium, to_string(arc.opened), to_string(arc.closed)));
        Recorder::on_arc(arc);
    }
    void follow(State state, const Segment& segment, const RunOptions& options) {
        outcome = run_segment(state, segment, 0, options, counters, *this);
    }
    [[nodiscard]] std::string why() const { return outcome.failure ? outcome.failure->message() : "completed"; }
    [[nodiscard]] std::vector<TieDecision> ties() const {
        std::vector<TieDecision> all;
        for (const ArcRecord& arc : arcs) {
            all.insert(all.end(), arc.perturbed.begin(), arc.perturbed.end());
        }
        return all;
    }
    [[nodiscard]] std::string end() const { return outcome.completed ? "completed" : to_string(outcome.failure->kind); }
};

inline Course follow_load(const State& state, int direction, int equilibria, Ties ties, std::uint64_t seed = 1) {
    Course course;
    RunOptions options;
    settle(options, ties);
    options.ties_seed = seed;
    course.follow(state, towards(direction * equilibria), options);
    return course;
}

inline bool mentions(const Course& course, const std::string& word) {
    return course.outcome.failure && course.outcome.failure->message().find(word) != std::string::npos;
}

inline bool settled_as(const Course& course, const std::string& what) {
    const std::vector<TieDecision> ties = course.ties();
    return std::ranges::any_of(ties, [&](const TieDecision& tie) { return tie.what == what; });
}

} // namespace crafted
