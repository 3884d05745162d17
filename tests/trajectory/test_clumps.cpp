// Runs of clumps: bars are kept, and never open.
#include "support/clumps.hpp"
#include "support/recorder.hpp"
#include "support/segments.hpp"
#include "support/test.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/result.hpp>

#include <algorithm>
#include <cmath>

using namespace isostat;
using isostat::test::with_infinitesimal;

namespace {

RunOptions whatever_the_strain() {
    return {.max_strain = HUGE_VAL};
}

} // namespace

/// With tan phi = 5/12 the lying dimer rises where sigma_2 = F_1 tan phi = 5, stands as the mirror image of what it
/// was, and falls back where sigma_2 = F_1 / tan phi = 28.8.
BOOST_AUTO_TEST_CASE(a_dimer_in_a_box_runs_through_a_loop_between_the_tangent_and_the_cotangent) {
    State state = with_infinitesimal(isostat::test::lying_dimer(12, 12));
    RunCounters counters;
    crafted::Recorder run;
    const RunOptions options = whatever_the_strain();
    const auto down = isostat::run_segment(state, towards(-1), 0, options, counters, run);
    BOOST_TEST_REQUIRE(!down.failure, (down.failure ? down.failure->message() : ""));
    BOOST_TEST(std::abs(state.load.stress[1] - 5) < 1e-14);
    BOOST_TEST(std::abs(state.packing.length(0) - 2) < 1e-14);
    BOOST_TEST(std::abs(state.packing.length(1) - 2.875) < 1e-14);
    BOOST_TEST((run.arcs[0].opened == Contact{ContactKind::lower_wall, 0, 1}));
    BOOST_TEST((run.arcs[0].closed == Contact{ContactKind::upper_wall, 0, 0}));
    BOOST_TEST(std::abs(run.equilibria.back().stress_high - 28.8) < 1e-12);
    BOOST_TEST_REQUIRE(!isostat::run_segment(state, towards(1), 1, options, counters, run).failure);
    BOOST_TEST(std::abs(state.load.stress[1] - 28.8) < 1e-12);
    BOOST_TEST(std::abs(state.packing.length(0) - 2.875) < 1e-14);
    BOOST_TEST(run.equilibria.back().dof_count == 5);
    BOOST_TEST(run.equilibria.back().backbone == 5);
    for (const isostat::ArcRecord& arc : run.arcs) {
        BOOST_TEST(arc.work > 0);
    }
}

BOOST_AUTO_TEST_CASE(a_dimer_in_space_rises_where_the_closed_form_says) {
    State state = with_infinitesimal(isostat::test::lying_dimer_in_space());
    RunCounters counters;
    crafted::Recorder run;
    const auto down = isostat::run_segment(state, towards(-1), 0, whatever_the_strain(), counters, run);
    BOOST_TEST_REQUIRE(!down.failure, (down.failure ? down.failure->message() : ""));
    BOOST_TEST(std::abs(state.load.stress[2] - 6) < 1e-12);
    BOOST_TEST((run.arcs[0].opened == Contact{ContactKind::lower_wall, 0, 2}));
}

BOOST_AUTO_TEST_CASE(trimers_run_through_ten_equilibria_that_certify_as_states) {
    for (const char* const name : {"trimer_20_1", "trimer_20_2"}) {
        State state = with_infinitesimal(isostat::test::clumps(name));
        state.load.refer_to(state.packing);
        (void)isostat::snap_to_grid(state.packing);
        RunCounters counters;
        crafted::Recorder run;
        BOOST_TEST_CONTEXT(name) {
            const auto outcome = isostat::run_segment(state, towards(10), 0, whatever_the_strain(), counters, run);
            BOOST_TEST(!outcome.failure, (outcome.failure ? outcome.failure->message() : ""));
            BOOST_TEST_REQUIRE(run.states.size() == 11U);
            for (const isostat::ArcRecord& arc : run.arcs) {
                BOOST_TEST((arc.opened.kind != ContactKind::bar));
                BOOST_TEST((arc.closed.kind != ContactKind::bar));
                BOOST_TEST((arc.kind == isostat::ArcKind::rattler || arc.work > 0));
            }
            for (const State& equilibrium : run.states) {
                BOOST_TEST((isostat::certify(equilibrium).verdict == isostat::Verdict::proved));
            }
        }
    }
}

/// A column of bodies carries all of the load there: no other force changes with it, by the balance of the whole.
BOOST_AUTO_TEST_CASE(dimers_are_loaded_until_they_support_every_load) {
    State state = with_infinitesimal(isostat::with_free_motions_held(isostat::test::clumps("dimer_20_2")));
    state.load.refer_to(state.packing);
    (void)isostat::snap_to_grid(state.packing);
    RunCounters counters;
    crafted::Recorder run;
    const auto outcome = isostat::run_segment(state, towards(30), 0, whatever_the_strain(), counters, run);
    BOOST_TEST_REQUIRE(outcome.failure.has_value());
    BOOST_TEST((outcome.failure->kind == FailureKind::no_limit), outcome.failure->message());
    BOOST_TEST(run.equilibria.size() > 10U);
}

/// What is held competes with the tractions: a run that begins where it bears a torque lets it go, and ends elsewhere.
BOOST_AUTO_TEST_CASE(a_held_angle_that_bears_a_torque_is_released) {
    for (const State& place : isostat::test::held_angles()) {
        State state = with_infinitesimal(isostat::with_free_motions_held(place));
        state.load.refer_to(state.packing);
        (void)isostat::snap_to_grid(state.packing);
        RunCounters counters;
        crafted::Recorder run;
        isostat::Segment rest = towards(1);
        rest.equilibria = 0;
        const auto outcome = isostat::run_segment(state, rest, 0, whatever_the_strain(), counters, run);
        BOOST_TEST_REQUIRE(!outcome.failure, (outcome.failure ? outcome.failure->message() : ""));
        BOOST_TEST_REQUIRE(!run.arcs.empty());
        BOOST_TEST(std::any_of(run.arcs.begin(), run.arcs.end(), [](const isostat::ArcRecord& arc) {
            return arc.kind == isostat::ArcKind::release && arc.work > 0;
        }));
        BOOST_TEST((isostat::certify(run.states.back()).verdict == isostat::Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(ties_of_clumps_are_not_chosen) {
    State state = isostat::test::lying_dimer(12, 12);
    RunCounters counters;
    crafted::Recorder run;
    RunOptions options = whatever_the_strain();
    options.ties = isostat::TiePolicy::choose;
    BOOST_CHECK_THROW((void)isostat::run_segment(state, towards(-1), 0, options, counters, run), isostat::Error);
}
