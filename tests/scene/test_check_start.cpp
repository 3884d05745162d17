// Scenes that start from clumps: free motions come to rest under infinitesimal loads.
#include "scene/seed.hpp"
#include "support/bad_input.hpp"
#include "support/clumps.hpp"
#include "support/crafted.hpp"
#include "support/scratch.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/scene/scene.hpp>

using namespace isostat;
using isostat::State;

namespace {

void refuses_start(const State& state, const std::vector<std::string>& words) {
    expect_bad_input([&] { check_start(state, "start.json"); }, words);
}

std::string seeded(const std::string& text, std::uint64_t seed) {
    return with_seed(text, seed, "s.toml", "/somewhere");
}

void refused(const std::string& text, std::uint64_t seed, const std::string& word) {
    expect_bad_input([&] { (void)seeded(text, seed); }, {word});
}

isostat::Scene scene_of(const std::string& name, const std::string& programme) {
    return isostat::parse_scene("[packing]\nfile = \"" + name + ".json\"\n[[programme]]\n" + programme, "clumps.toml",
                                std::string(ISOSTAT_TEST_DATA) + "/clumps");
}

const std::string up_1 = "do = \"up\"\nequilibria = 1\n";

void judge(const State& state) {
    (void)isostat::start_of_scene(state, scene_of("dimer_20_1", up_1), "state");
}

} // namespace

BOOST_AUTO_TEST_CASE(isostatic_starts_pass) {
    BOOST_CHECK_NO_THROW(check_start(::crafted::two_disks(1, 2, 1, 1), "start.json"));
    BOOST_CHECK_NO_THROW(check_start(::crafted::three_disks(1, 1, 1.5, 1, 1), "start.json"));
    BOOST_CHECK_NO_THROW(check_start(read_state(scratch::data("vertex100.txt")).state, "vertex100.txt"));
}

BOOST_AUTO_TEST_CASE(a_self_stress_is_refused_with_the_numbers) {
    refuses_start(::crafted::square_lattice(3), {"start.json", "N_f = 20", "N = 24", "rank 20", "h = 4", "k = 0"});
}

BOOST_AUTO_TEST_CASE(a_mechanism_is_refused_with_the_numbers) {
    State state = ::crafted::two_disks(1, 2, 1, 1);
    state.contacts.pop_back();
    refuses_start(state, {"N_f = 6", "N = 5", "h = 0", "k = 1"});
}

BOOST_AUTO_TEST_CASE(overlaps_are_named) {
    State state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.q[2] -= 0.5; // disk 1 into disk 0
    refuses_start(state, {"overlap", "0-1", "-0.4659"});
    state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.length(1) -= 0.01; // the top wall into disk 1
    refuses_start(state, {"disk 1", "larger than the box"});
    state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.q[1] -= 0.01; // disk 0 into the bottom
    refuses_start(state, {"overlap", "0-bottom", "-0.01"});
}

BOOST_AUTO_TEST_CASE(an_open_contact_is_named) {
    State state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.length(0) += 0.25;
    refuses_start(state, {"1-right", "0.25", "expected 0"});
}

BOOST_AUTO_TEST_CASE(only_the_seed_of_the_packing_changes) {
    const std::string text =
        "# größe\n[packing] # here\ndisks = 7\n  seed = 12 # of the sample\n[run]\nrule_seed = 12\n";
    BOOST_TEST(seeded(text, 345) ==
               "# größe\n[packing] # here\ndisks = 7\n  seed = 345 # of the sample\n[run]\nrule_seed = 12\n");
    BOOST_TEST(seeded(text, 12) == text);
    BOOST_TEST(seeded("packing = {seed = 1_0, disks = 3}", 2) == "packing = {seed = 2, disks = 3}");
    BOOST_TEST(seeded("packing.\"disks\" = 3\npacking.seed = 0x1F", 2) == "packing.\"disks\" = 3\npacking.seed = 2");
    BOOST_TEST(seeded("[\"packing\"]\n\"seed\"=1\ndisks = 3", 9223372036854775807U) ==
               "[\"packing\"]\n\"seed\"=9223372036854775807\ndisks = 3");
}

BOOST_AUTO_TEST_CASE(a_missing_seed_is_added) {
    BOOST_TEST(seeded("[packing] # ö\ndisks = 3\n", 4) == "[packing] # ö\nseed = 4\ndisks = 3\n");
    refused("packing = {disks = 3}", 4, "seed");
}

BOOST_FIXTURE_TEST_CASE(a_list_of_radii_stands_in_the_scene_of_a_sample, scratch::InFolder) {
    scratch::write(folder / "radii.txt", "1\n2.5\n");
    const std::string text = "[packing]\nradii_file = \"radii.txt\"\nseed = 3\n";
    const std::string expected = "[packing]\nradii = [1, 2.5]\nseed = 5\n";
    BOOST_TEST(with_seed(text, 5, "s.toml", folder.path()) == expected);
    BOOST_TEST(parse_scene(expected, "s.toml", "/elsewhere").preparation.radii.size() == 2U);
}

BOOST_AUTO_TEST_CASE(scenes_without_samples_are_refused) {
    refused("[packing]\nfile = \"start.json\"\n", 2, "start.json");
    refused("[packing]\ndisks = 3\nseed = 1\n", 9223372036854775808U, "9223372036854775808");
    refused("[packing]\ndisks = 3\nfly = 1\n", 2, "fly");
    refused("[packing\n", 2, "TOML");
}

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
        BOOST_TEST_INFO_SCOPE(name);
        const isostat::Counting counting = isostat::count_contacts(start.packing, start.contacts);
        BOOST_TEST(counting.dof_count == 62);
        BOOST_TEST(counting.contact_count == 62);
        BOOST_TEST(counting.mechanisms == 0);
        BOOST_TEST(start.provenance.find("arcs_to_rest") != std::string::npos);
        BOOST_TEST((isostat::certify(start).verdict == isostat::Verdict::proved));
    }
}

/// The place where the power turns is known to rounding: released, the body turns back, and stays where it is held.
BOOST_AUTO_TEST_CASE(a_body_that_hangs_where_its_power_turned_stays_there) {
    const State state = isostat::start_from_file(scene_of("dimer_20_10", "do = \"down\"\nequilibria = 2\n"));
    const crafted::Played run = crafted::play(state, -1, 2);
    BOOST_TEST(run.outcome.completed, run.why());
    BOOST_TEST_REQUIRE(run.records.equilibria.size() == 3U);
    BOOST_TEST(run.records.equilibria[0].held == 1);
    BOOST_TEST(run.records.equilibria[0].stress_low < run.records.equilibria[0].stress_high);
}
