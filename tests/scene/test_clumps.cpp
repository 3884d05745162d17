// Scenes that start from clumps: free motions come to rest under infinitesimal loads.
#include "support/clumps.hpp"
#include "support/recorder.hpp"
#include "support/segments.hpp"
#include "support/test.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/error.hpp>
#include <isostat/scene/scene.hpp>

using isostat::State;

BOOST_AUTO_TEST_SUITE(scene)

namespace {

isostat::Scene scene_of_clumps() {
    return isostat::parse_scene("[packing]\nfile = \"dimer_20_1.json\"\n[[programme]]\ndo = \"up\"\nequilibria = 1\n",
                                "clumps.toml", std::string(ISOSTAT_TEST_DATA) + "/clumps");
}

/// The message, or nothing where the state is a start.
std::string refusal(const State& state) {
    try {
        (void)isostat::start_of_scene(state, scene_of_clumps(), "state");
    } catch (const isostat::Error& error) {
        return error.what();
    }
    return {};
}

} // namespace

BOOST_AUTO_TEST_CASE(a_start_of_clumps_is_judged_before_anything_moves) {
    State open = isostat::test::clumps("dimer_20_1");
    BOOST_TEST(refusal(open).empty());
    open.packing.q[0] += 1e-4;
    BOOST_TEST(refusal(open).find(": the gap of ") != std::string::npos, refusal(open));
    // The load acts on the mechanism, as it stands and when it moves.
    BOOST_TEST(refusal(isostat::test::dimer_across(3, 4)).find("mechanism") != std::string::npos);
    BOOST_TEST(refusal(isostat::test::dimer_across(3, 4.1)).find("mechanism") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(bodies_that_turn_about_one_member_come_to_rest_before_a_run) {
    for (const char* const name : {"dimer_20_1", "dimer2_20_2", "trimer_20_3"}) { // k = 2, 6, 6
        const isostat::Scene scene = isostat::parse_scene(std::string("[packing]\nfile = \"") + name +
                                                              ".json\"\n[[programme]]\ndo = \"up\"\nequilibria = 1\n",
                                                          "clumps.toml", std::string(ISOSTAT_TEST_DATA) + "/clumps");
        const State start = isostat::start_from_file(scene);
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
    const isostat::Scene scene =
        isostat::parse_scene("[packing]\nfile = \"dimer_20_10.json\"\n[[programme]]\ndo = \"down\"\nequilibria = 2\n",
                             "clumps.toml", std::string(ISOSTAT_TEST_DATA) + "/clumps");
    State state = isostat::start_from_file(scene);
    crafted::Recorder run;
    isostat::RunCounters counters;
    isostat::RunOptions options{.max_strain = 100};
    const auto outcome = isostat::run_segment(state, towards(-2), 0, options, counters, run);
    BOOST_TEST(outcome.completed, (outcome.failure ? outcome.failure->message() : ""));
    BOOST_TEST_REQUIRE(run.equilibria.size() == 3U);
    BOOST_TEST(run.equilibria[0].held == 1);
    BOOST_TEST(run.equilibria[0].stress_low < run.equilibria[0].stress_high);
}

BOOST_AUTO_TEST_SUITE_END()
