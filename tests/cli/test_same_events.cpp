// The checker, which has its own code for all of it, replays whole runs.
// Forces that are equal, or 0, at every vertex for a reason that is counted, in runs and in the checker.
#include "cli/program.hpp"
#include "support/forger.hpp"

using namespace program;

namespace {

std::string scene(int disks, int seed, int equilibria) {
    return "[packing]\ndisks = " + std::to_string(disks) + "\nseed = " + std::to_string(seed) +
           "\n[[programme]]\ndo = \"up\"\nequilibria = " + std::to_string(equilibria) +
           "\n[[programme]]\ndo = \"down\"\nto = 1.0\n[output]\npictures = false\n";
}

void replay(int disks, int seed, int equilibria) {
    const scratch::Folder folder;
    BOOST_TEST_INFO_SCOPE(disks << " disks, seed " << seed);
    const std::string out = ran(folder, scene(disks, seed, equilibria));
    const auto arcs = static_cast<int>(scratch::lines_of(folder / "run/events.jsonl").size());
    has(json_of(run({"verify", out, "--json"})), {{"verdict", "ends proved, way looked at"}, {"ends_proved", arcs}});
    BOOST_TEST(arcs > equilibria);
}

/// So many spheres, with the rest of the section, under a growing load.
std::string spheres(const std::string& packing, int equilibria) {
    return "[packing]\nspheres = " + packing + up(equilibria) + "[output]\npictures = false\n";
}

std::string opens(const std::string& name) {
    return "\"opened\":\"" + name + "\"";
}

/// Puts one text in the place of another in the events of a run, the first from there on.
void forge(const std::filesystem::path& folder, std::size_t begin, const std::string& from, const std::string& to) {
    std::string events = scratch::read(folder / "events.jsonl");
    const std::size_t at = events.find(from, begin);
    BOOST_REQUIRE(at != std::string::npos);
    scratch::write(folder / "events.jsonl", events.replace(at, from.size(), to));
    forger::seal(folder);
}

struct EdgeRun {
    int seed;
    std::string opened, other; ///< two walls with one force
};

/// Eight spheres in a box; edges of lower walls, of upper walls, and of one of each.
const std::array edge_runs{EdgeRun{17, "1-right", "1-top"}, EdgeRun{31, "7-bottom", "7-left"},
                           EdgeRun{35, "0-left", "0-top"}};

} // namespace

BOOST_AUTO_TEST_CASE(verify_proves_every_end_of_runs_with_100_disks, *boost::unit_test::label("slow")) {
    for (const int seed : {1, 2, 3, 4}) {
        replay(100, seed, 12);
    }
}

// At the power turn of this run both ends of a straight strut carry the same force to the last digit: the infinitesimal
// loads order them (S4), in the run and in the checker.
BOOST_FIXTURE_TEST_CASE(verify_proves_which_end_of_a_straight_strut_opens_and_refutes_the_other, scratch::InFolder,
                        *boost::unit_test::label("slow")) {
    const std::string out = ran(folder, scene(100, 4, 8));
    expect(run({"verify", out}), 0);
    const std::size_t turn = scratch::read(folder / "run/events.jsonl").find("\"power_turn\":true");
    BOOST_REQUIRE(turn != std::string::npos);
    forge(out, turn, opens("71-75"), opens("75-93"));
    says(run({"verify", out}), 1, {"takes 71-75"});
}

BOOST_AUTO_TEST_CASE(verify_proves_every_end_of_runs_with_400_disks, *boost::unit_test::label("slow")) {
    for (const int seed : {1, 2, 3}) {
        replay(400, seed, 5);
    }
}

// A pinned sphere keeps two contacts and a coordinate is held relative to it: with another one pinned the zeros show
// (C9).
BOOST_FIXTURE_TEST_CASE(zeros_of_a_pinned_sphere_are_seen_while_a_coordinate_is_held, scratch::InFolder,
                        *boost::unit_test::label("slow")) {
    const std::string out =
        ran(folder, spheres("30\nlaw = \"equal\"\njitter = 1e-3\nseed = 5\n[cell]\nkind = \"triclinic\"\n", 11));
    expect(run({"verify", out}), 0);
}

// A wall without force holds a sphere in the plane of its contacts: when the infinitesimal loads open that wall the
// load does work too, and the arc does not end where the power of the infinitesimal ones turns.
BOOST_FIXTURE_TEST_CASE(a_sphere_that_bears_force_leaves_its_plane_with_the_power_of_the_load, scratch::InFolder,
                        *boost::unit_test::label("slow")) {
    const std::string out = ran(folder, spheres("12\nlaw = \"bidisperse\"\nseed = 22\n", 3));
    says(run({"verify", out}), 0, {"4 of 4 proved"});
    BOOST_TEST(contains(scratch::read(folder / "run/events.jsonl"), "\"kind\":\"rattler\",\"opened\":\"5-top\""));
}

// A sphere that comes level with its neighbours of the same size at the wall that it meets.
BOOST_FIXTURE_TEST_CASE(an_arc_may_end_where_its_power_is_0_by_counting, scratch::InFolder,
                        *boost::unit_test::label("slow")) {
    const std::string out = ran(folder, spheres("45\nlaw = \"bidisperse\"\nseed = 2\n", 1), {}); // ends as a tie
    expect(run({"verify", out}), 0);
    forge(out, 0, "\"power\":0.0,", "\"power\":1e-9,");
    expect(run({"verify", out}), 1);
}

BOOST_AUTO_TEST_CASE(two_walls_of_an_edge_bear_one_force_and_the_infinitesimal_loads_order_them,
                     *boost::unit_test::label("slow")) {
    for (const EdgeRun& edge : edge_runs) {
        BOOST_TEST_INFO_SCOPE("seed " << edge.seed);
        const scratch::Folder folder;
        const std::string seed = "seed = " + std::to_string(edge.seed) + "\n";
        const std::string out = ran(folder, spheres("8\ndiameters = [1.0, 2.0]\n" + seed, 2), {});
        expect(run({"verify", out}), 0);
        forge(out, 0, opens(edge.opened), opens(edge.other));
        says(run({"verify", out}), 1, {"takes " + edge.opened});
    }
}
