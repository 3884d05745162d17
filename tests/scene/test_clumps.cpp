// Scenes that start from clumps: free motions come to rest under infinitesimal loads.
#include "support/bad_input.hpp"
#include "support/clumps.hpp"
#include "support/recorder.hpp"
#include "support/segments.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/scene/scene.hpp>

using isostat::State;

namespace {

isostat::Scene scene_of(const std::string& name, const std::string& programme) {
    return isostat::parse_scene("[packing]\nfile = \"" + name + ".json\"\n[[programme]]\n" + programme, "clumps.toml",
                                std::string(ISOSTAT_TEST_DATA) + "/clumps");
}

const std::string up_1 = "do = \"up\"\nequilibria = 1\n";

void judge(const State& state) {
    (void)isostat::start_of_scene(state, scene_of("dimer_20_1", up_1), "state");
}

} // namespace

BOOST_AUTO_TEST_CASE(a_start_of_clumps_is_judged_before_anything_moves) {
    State open = isostat::test::clumps("dimer_20_1");
    BOOST_CHECK_NO_THROW(judge(open));
    open.packing.q[0] += 1e-4;
    expect_bad_input([&] { judge(open); }, {": the gap of "});
    // The load acts on the mechanism, as it stands and when it moves.
    for (const double f2 : {4.0, 4.1}) {
        expect_bad_input([&] { judge(isostat::test::dimer_across(3, f2)); }, {"mechanism"});
    }
}

BOOST_AUTO_TEST_CASE(bodies_that_turn_about_one_member_come_to_rest_before_a_run) {
    for (const char* const name : {"dimer_20_1", "dimer2_20_2", "trimer_20_3"}) { // k = 2, 6, 6
        const State start = isostat::start_from_file(scene_of(name, up_1));
        BOOST_TEST_CONTEXT(name) {
            const isostat::Counting counting = isostat::count_contacts(start.packing, start.contacts);
            BOOST_TEST(counting.dof_count == 62);
            BOOST_TEST(counting.contact_count == 62);
            BOOST_TEST(counting.mechanisms == 0);
            BOOST_TEST(start.provenance.find("arcs_to_rest") != std::string::npos);
            BOOST_TEST((isostat::certify(start).verdict == isostat::Verdict::proved));
        }
    }
}

/// The place where the power turns is known to rounding: released, the body turns back, and stays where it is held.
BOOST_AUTO_TEST_CASE(a_body_that_hangs_where_its_power_turned_stays_there) {
    State state = isostat::start_from_file(scene_of("dimer_20_10", "do = \"down\"\nequilibria = 2\n"));
    crafted::Recorder run;
    isostat::RunCounters counters;
    isostat::RunOptions options{.max_strain = 100};
    const auto outcome = isostat::run_segment(state, towards(-2), 0, options, counters, run);
    BOOST_TEST(outcome.completed, (outcome.failure ? outcome.failure->message() : ""));
    BOOST_TEST_REQUIRE(run.equilibria.size() == 3U);
    BOOST_TEST(run.equilibria[0].held == 1);
    BOOST_TEST(run.equilibria[0].stress_low < run.equilibria[0].stress_high);
}
