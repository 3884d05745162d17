#pragma once
// Runs played into folders as the program does it, and what the checker must say of them.

#include "certificate/state_certifier.hpp"
#include "io/json.hpp"
#include "support/forger.hpp"
#include "support/segments.hpp"

#include <isostat/io/run_directory.hpp>
#include <isostat/trajectory/trajectory.hpp>

namespace played {

using isostat::RunOptions;
using isostat::RunVerification;
using isostat::Segment;

/// As run.json has them.
inline std::string settings(const RunOptions& options) {
    isostat::json::Json run{{"rule", isostat::word_of(options.rule, isostat::opening_rule_words)},
                            {"certify", isostat::to_string(options.certify)},
                            {"ties", isostat::word_of(options.ties, isostat::tie_policy_words)},
                            {"ties_seed", options.ties_seed}};
    if (options.rule == isostat::OpeningRule::random) { // nothing else reads it
        run["rule_seed"] = options.rule_seed;
    }
    if (options.max_choices < RunOptions().max_choices) {
        run["max_choices"] = options.max_choices;
    }
    return isostat::json::Json{{"run", run}}.dump();
}

/// Every state is stored, and the start where arcs may lead from it to equilibrium 0. What ended the last segment is
/// returned.
inline isostat::SegmentOutcome into(const std::filesystem::path& folder, isostat::State state,
                                    const std::vector<Segment>& segments, const RunOptions& options = {},
                                    bool with_start = false) {
    isostat::RunHeader header;
    header.program = "test";
    header.settings = settings(options);
    header.programme.assign(segments.size(), "segment");
    header.witnesses = options.certify == isostat::CertifyLevel::arcs;
    header.touching = options.at_first_order();
    header.states_every = 1;
    isostat::RunCounters counters;
    isostat::RunDirectory directory(folder, header, isostat::RunDirectory::Mode::fresh, counters);
    if (with_start) {
        directory.store_start(state);
    }
    isostat::StateCertifier certifier(folder, "test", counters, directory);
    const bool certified = options.certify >= isostat::CertifyLevel::states;
    isostat::RunObserver& observer = certified ? static_cast<isostat::RunObserver&>(certifier) : directory;
    isostat::SegmentOutcome outcome;
    for (std::size_t k = 0; k < segments.size() && (k == 0 || outcome.completed); ++k) {
        directory.begin_segment(static_cast<int>(k), segments[k], 0, counters.equilibria);
        outcome = run_segment(state, segments[k], static_cast<int>(k), options, counters, observer);
    }
    const std::string end = outcome.completed ? "" : outcome.failure->message();
    directory.finish(outcome.completed ? isostat::RunStatus::completed : isostat::RunStatus::failed, end);
    BOOST_TEST_MESSAGE((outcome.completed ? "completed" : end));
    return outcome;
}

/// The same of segments that must be completed.
inline void completely(const std::filesystem::path& folder, const isostat::State& state,
                       const std::vector<Segment>& segments, const RunOptions& options = {}, bool with_start = false) {
    const isostat::SegmentOutcome outcome = into(folder, state, segments, options, with_start);
    BOOST_REQUIRE_MESSAGE(outcome.completed, (outcome.failure ? outcome.failure->message(3) : ""));
}

inline void without_objection(const RunVerification& run) {
    BOOST_TEST(run.wrong == "");
    BOOST_TEST(run.undecided.size() == 0U, (run.undecided.empty() ? "" : run.undecided[0]));
}

/// All of the run is proved.
inline RunVerification proved(const std::filesystem::path& folder) {
    RunVerification run = isostat::verify_run(folder);
    without_objection(run);
    BOOST_TEST((run.verdict == isostat::Verdict::proved));
    BOOST_TEST(run.arcs_proved == run.arcs);
    return run;
}

/// The forged run is refuted, and these words say why.
inline void refuted(const RunVerification& forged, const std::string& said) {
    BOOST_TEST((forged.verdict == isostat::Verdict::refuted), (forged.undecided.empty() ? "" : forged.undecided[0]));
    BOOST_TEST(forged.wrong.find(said) != std::string::npos, forged.wrong);
}

} // namespace played
