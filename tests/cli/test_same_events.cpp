// The checker, which has its own code for all of it, replays whole runs.
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
    scratch::write(folder / "scene.toml", scene(disks, seed, equilibria));
    const std::string out = folder.at("run");
    expect(run({"run", folder.at("scene.toml"), "-o", out, "-q"}), 0);
    const std::string events = scratch::read(folder / "run/events.jsonl");
    const auto arcs = std::count(events.begin(), events.end(), '\n');
    const Outcome verified = done(run({"verify", out, "--json"}));
    const nlohmann::json answer = nlohmann::json::parse(verified.out);
    BOOST_TEST(answer["verdict"] == "ends proved, way looked at", verified.out);
    BOOST_TEST(answer["ends_proved"] == arcs);
    BOOST_TEST(arcs > equilibria);
}

} // namespace

BOOST_AUTO_TEST_CASE(verify_proves_every_end_of_runs_with_100_disks, *boost::unit_test::label("slow")) {
    for (const int seed : {1, 2, 3, 4}) {
        replay(100, seed, 12);
    }
}

// At the power turn of this run both ends of a straight strut carry the same force to the last digit: the infinitesimal
// loads order them (S4), in the run and in the checker.
BOOST_AUTO_TEST_CASE(verify_proves_which_end_of_a_straight_strut_opens_and_refutes_the_other,
                     *boost::unit_test::label("slow")) {
    const scratch::Folder folder;
    scratch::write(folder / "scene.toml", scene(100, 4, 8));
    const std::string out = folder.at("run");
    expect(run({"run", folder.at("scene.toml"), "-o", out, "-q"}), 0);
    expect(run({"verify", out}), 0);
    const std::string events = scratch::read(folder / "run/events.jsonl");
    const std::size_t turn = events.find("\"power_turn\":true");
    BOOST_REQUIRE(turn != std::string::npos);
    const std::size_t next = events.find("\"opened\":\"71-75\"", turn);
    BOOST_REQUIRE(next != std::string::npos);
    scratch::write(folder / "run/events.jsonl", events.substr(0, next) + "\"opened\":\"75-93\"" +
                                                    events.substr(next + std::string("\"opened\":\"71-75\"").size()));
    forger::seal(out);
    says(run({"verify", out}), 1, {"takes 71-75"});
}

BOOST_AUTO_TEST_CASE(verify_proves_every_end_of_runs_with_400_disks, *boost::unit_test::label("slow")) {
    for (const int seed : {1, 2, 3}) {
        replay(400, seed, 5);
    }
}
