// Forces that are equal, or 0, at every vertex for a reason that is counted, in runs and in the checker.
#include "cli/program.hpp"
#include "support/forger.hpp"

using namespace program;

namespace {

struct EdgeRun {
    int seed;
    std::string opened, other; ///< two walls with one force
};

/// Eight spheres in a box; edges of lower walls, of upper walls, and of one of each.
const std::array edge_runs{EdgeRun{17, "1-right", "1-top"}, EdgeRun{31, "7-bottom", "7-left"},
                           EdgeRun{35, "0-left", "0-top"}};

} // namespace

// A pinned sphere keeps two contacts and a coordinate is held relative to it: with another one pinned the zeros show
// (C9).
BOOST_AUTO_TEST_CASE(zeros_of_a_pinned_sphere_are_seen_while_a_coordinate_is_held, *boost::unit_test::label("slow")) {
    const scratch::Folder folder;
    scratch::write(folder / "scene.toml",
                   "[packing]\nspheres = 30\nlaw = \"equal\"\njitter = 1e-3\nseed = 5\n[cell]\nkind = \"triclinic\"\n"
                   "[[programme]]\ndo = \"up\"\nequilibria = 11\n[output]\npictures = false\n");
    const std::string out = folder.at("run");
    expect(run({"run", folder.at("scene.toml"), "-o", out, "-q"}), 0);
    expect(run({"verify", out}), 0);
}

// A wall without force holds a sphere in the plane of its contacts: when the infinitesimal loads open that wall the
// load does work too, and the arc does not end where the power of the infinitesimal ones turns.
BOOST_AUTO_TEST_CASE(a_sphere_that_bears_force_leaves_its_plane_with_the_power_of_the_load,
                     *boost::unit_test::label("slow")) {
    const scratch::Folder folder;
    scratch::write(folder / "scene.toml", "[packing]\nspheres = 12\nlaw = \"bidisperse\"\nseed = 22\n[[programme]]\n"
                                          "do = \"up\"\nequilibria = 3\n[output]\npictures = false\n");
    const std::string out = folder.at("run");
    expect(run({"run", folder.at("scene.toml"), "-o", out, "-q"}), 0);
    says(run({"verify", out}), 0, {"4 of 4 proved"});
    const std::string events = scratch::read(folder / "run/events.jsonl");
    BOOST_TEST(events.find("\"kind\":\"rattler\",\"opened\":\"5-top\"") != std::string::npos);
}

// A sphere that comes level with its neighbours of the same size at the wall that it meets.
BOOST_AUTO_TEST_CASE(an_arc_may_end_where_its_power_is_0_by_counting, *boost::unit_test::label("slow")) {
    const scratch::Folder folder;
    scratch::write(folder / "scene.toml", "[packing]\nspheres = 45\nlaw = \"bidisperse\"\nseed = 2\n[[programme]]\n"
                                          "do = \"up\"\nequilibria = 1\n[output]\npictures = false\n");
    const std::string out = folder.at("run");
    (void)run({"run", folder.at("scene.toml"), "-o", out, "-q"}); // ends as a tie of equal radii
    expect(run({"verify", out}), 0);
    std::string events = scratch::read(folder / "run/events.jsonl");
    const std::string zero = "\"power\":0.0,";
    const std::size_t at = events.find(zero);
    BOOST_REQUIRE(at != std::string::npos);
    scratch::write(folder / "run/events.jsonl", events.replace(at, zero.size(), "\"power\":1e-9,"));
    forger::seal(out);
    expect(run({"verify", out}), 1);
}

BOOST_AUTO_TEST_CASE(two_walls_of_an_edge_bear_one_force_and_the_infinitesimal_loads_order_them,
                     *boost::unit_test::label("slow")) {
    for (const EdgeRun& edge : edge_runs) {
        BOOST_TEST_INFO_SCOPE("seed " << edge.seed);
        const scratch::Folder folder;
        scratch::write(folder / "scene.toml",
                       "[packing]\nspheres = 8\ndiameters = [1.0, 2.0]\nseed = " + std::to_string(edge.seed) +
                           "\n[[programme]]\ndo = \"up\"\nequilibria = 2\n[output]\npictures = false\n");
        const std::string out = folder.at("run");
        (void)run({"run", folder.at("scene.toml"), "-o", out, "-q"});
        expect(run({"verify", out}), 0);
        std::string events = scratch::read(folder / "run/events.jsonl");
        const auto opens = [](const std::string& name) { return "\"opened\":\"" + name + "\""; };
        const std::size_t at = events.find(opens(edge.opened));
        BOOST_REQUIRE(at != std::string::npos);
        events.replace(at, opens(edge.opened).size(), opens(edge.other));
        scratch::write(folder / "run/events.jsonl", events);
        forger::seal(out);
        says(run({"verify", out}), 1, {"takes " + edge.opened});
    }
}
