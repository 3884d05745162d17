// Power turns, held coordinates and turning arcs in the smallest scenes known: examples/turns.
#include "cli/program.hpp"

using namespace program;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> events_of_scene(const std::string& scene) {
    const scratch::Folder out;
    expect(run({"run", scratch::data("../../examples/turns/" + scene), "-o", out.path().string(), "-q"}), 0);
    const std::vector<std::string> lines = scratch::lines_of(out / "events.jsonl");
    BOOST_TEST(contains(scratch::read(out / "summary.json"), "\"undecided\": 0"));
    const Outcome verified = run({"verify", out.path().string()}); // held coordinates and all
    expect(verified, 0);
    BOOST_TEST(contains(verified.out, "proved"));
    return lines;
}

void has(const std::string& line, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
        BOOST_TEST(contains(line, part), part << " is not in " << line);
    }
}

} // namespace

BOOST_AUTO_TEST_CASE(three_disks_meet_a_power_turn_hold_a_coordinate_and_release_it) {
    const auto events = events_of_scene("power-turn.toml");
    BOOST_TEST_REQUIRE(events.size() == 3U);
    const std::string proved = "\"certificate\":{\"verdict\":\"proved\"";
    has(events[0], {"\"kind\":\"limit\"", "\"opened\":\"1-left\"", "\"closed\":\"held x of grain 1\"",
                    "\"power_turn\":true", proved, "\"power\":\"proved\""});
    has(events[1], {"\"kind\":\"tension\"", "\"opened\":\"1-2\"", "\"closed\":\"0-1\"", proved});
    has(events[2], {"\"kind\":\"release\"", "\"opened\":\"held x of grain 1\"", "\"closed\":\"1-left\"", proved,
                    "\"power\":\"proved\""});
}

BOOST_AUTO_TEST_CASE(four_disks_open_a_contact_whose_gap_turns_back) {
    const auto events = events_of_scene("turning.toml");
    BOOST_TEST_REQUIRE(events.size() == 2U);
    has(events[0], {"\"opened\":\"0-2\"", "\"closed\":\"3-bottom\"", "\"verdict\":\"proved\"", "\"turning\":true"});
    has(events[1], {"\"verdict\":\"proved\"", "\"turning\":false"});
}
