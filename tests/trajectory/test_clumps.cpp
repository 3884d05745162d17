// Runs of clumps: bars are kept, and never open.
#include "support/clumps.hpp"
#include "support/crafted.hpp"

#include <isostat/certificate/certify.hpp>

using namespace isostat;
using crafted::play;
using crafted::Played;
using isostat::test::with_infinitesimal;

namespace {

/// With infinitesimal loads, referred to its own lengths.
State ready(const State& of) {
    State state = with_infinitesimal(of);
    state.load.refer_to(state.packing);
    (void)snap_to_grid(state.packing);
    return state;
}

} // namespace

/// With tan phi = 5/12 the lying dimer rises where sigma_2 = F_1 tan phi = 5, stands as the mirror image of what it
/// was, and falls back where sigma_2 = F_1 / tan phi = 28.8.
BOOST_AUTO_TEST_CASE(a_dimer_in_a_box_runs_through_a_loop_between_the_tangent_and_the_cotangent) {
    const Played down = completed(play(with_infinitesimal(isostat::test::lying_dimer(12, 12)), -1, 1));
    BOOST_TEST(std::abs(down.state.load.stress[1] - 5) < 1e-14);
    BOOST_TEST(std::abs(down.state.packing.length(0) - 2) < 1e-14);
    BOOST_TEST(std::abs(down.state.packing.length(1) - 2.875) < 1e-14);
    BOOST_TEST((down.records.arcs[0].opened == crafted::bottom(0)));
    BOOST_TEST((down.records.arcs[0].closed == crafted::right(0)));
    BOOST_TEST(std::abs(down.records.equilibria.back().stress_high - 28.8) < 1e-12);
    const Played up = completed(play(down.state, +1, 1));
    BOOST_TEST(std::abs(up.state.load.stress[1] - 28.8) < 1e-12);
    BOOST_TEST(std::abs(up.state.packing.length(0) - 2.875) < 1e-14);
    BOOST_TEST(up.records.equilibria.back().dof_count == 5);
    BOOST_TEST(up.records.equilibria.back().backbone == 5);
    for (const Played* run : {&down, &up}) {
        for (const ArcRecord& arc : run->records.arcs) {
            BOOST_TEST(arc.work > 0);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_dimer_in_space_rises_where_the_closed_form_says) {
    const Played down = completed(play(with_infinitesimal(isostat::test::lying_dimer_in_space()), -1, 1));
    BOOST_TEST(std::abs(down.state.load.stress[2] - 6) < 1e-12);
    BOOST_TEST((down.records.arcs[0].opened == Contact{ContactKind::lower_wall, 0, 2}));
}

BOOST_AUTO_TEST_CASE(trimers_run_through_ten_equilibria_that_certify_as_states) {
    for (const char* const name : {"trimer_20_1", "trimer_20_2"}) {
        BOOST_TEST_INFO_SCOPE(name);
        const Played run = play(ready(isostat::test::clumps(name)), +1, 10);
        BOOST_TEST(run.outcome.completed, run.why());
        BOOST_TEST_REQUIRE(run.records.states.size() == 11U);
        for (const ArcRecord& arc : run.records.arcs) {
            BOOST_TEST((arc.opened.kind != ContactKind::bar));
            BOOST_TEST((arc.closed.kind != ContactKind::bar));
            BOOST_TEST((arc.kind == ArcKind::rattler || arc.work > 0));
        }
        for (const State& equilibrium : run.records.states) {
            BOOST_TEST((certify(equilibrium).verdict == Verdict::proved));
        }
    }
}

/// A column of bodies carries all of the load there: no other force changes with it, by the balance of the whole.
BOOST_AUTO_TEST_CASE(dimers_are_loaded_until_they_support_every_load) {
    const Played run = play(ready(with_free_motions_held(isostat::test::clumps("dimer_20_2"))), +1, 30);
    fails(run.outcome.failure, FailureKind::no_limit);
    BOOST_TEST(run.records.equilibria.size() > 10U);
}

/// What is held competes with the tractions: a run that begins where it bears a torque lets it go, and ends elsewhere.
BOOST_AUTO_TEST_CASE(a_held_angle_that_bears_a_torque_is_released) {
    for (const State& place : isostat::test::held_angles()) {
        const Played run = completed(play(ready(with_free_motions_held(place)), +1, 0));
        const std::vector<ArcRecord>& arcs = run.records.arcs;
        BOOST_TEST(std::ranges::any_of(
            arcs, [](const ArcRecord& arc) { return arc.kind == ArcKind::release && arc.work > 0; }));
        BOOST_TEST((certify(run.records.states.back()).verdict == Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(ties_of_clumps_are_not_chosen) {
    BOOST_CHECK_THROW((void)play(isostat::test::lying_dimer(12, 12), -1, 1, {}, {.ties = TiePolicy::choose}), Error);
}
