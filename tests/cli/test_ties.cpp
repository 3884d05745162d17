// Ties in the smallest scenes known, as a user runs them: examples/ties.
// Power turns, held coordinates and turning arcs in the smallest scenes known: examples/turns.
#include "cli/program.hpp"

using namespace program;

namespace {

std::string example(const std::string& name) {
    return ISOSTAT_EXAMPLES "/ties/" + name;
}

/// The scene of an example, with the whole name of the state that it reads.
std::string scene_of(const std::string& name) {
    return scratch::replaced(scratch::read(example(name + ".toml")), "file = \"", "file = \"" + example(""));
}

/// The same under ties = "stop".
std::string stopped(const std::string& name) {
    return scratch::replaced(scene_of(name), "ties = \"choose\"\nmax_choices = 0", "ties = \"stop\"");
}

std::vector<std::string> events_of_scene(const std::string& scene) {
    const scratch::Folder out;
    expect(run({"run", scratch::data("../../examples/turns/" + scene), "-o", out.path().string(), "-q"}), 0);
    const std::vector<std::string> lines = scratch::lines_of(out / "events.jsonl");
    BOOST_TEST(contains(scratch::read(out / "summary.json"), "\"undecided\": 0"));
    says(run({"verify", out.path().string()}), 0, {"proved"}); // held coordinates and all
    return lines;
}

void has(const std::string& line, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
        BOOST_TEST(contains(line, part), part << " is not in " << line);
    }
}

} // namespace

BOOST_AUTO_TEST_CASE(ties_stop_the_run_or_are_settled_and_the_records_say_how) {
    for (const std::string name : {"two-gaps", "two-forces"}) {
        BOOST_TEST_INFO_SCOPE(name);
        const scratch::Folder folder;
        const std::string out = folder.at("run");
        const scratch::Folder stop;
        ran(stop, stopped(name), 2, {"tie", "1-", "2-", "equal radii: try isostat import", "--jitter 1e-9"});
        BOOST_TEST(contains(scratch::read(stop / "run/summary.json"), "undecided"));
        expect(run({"run", example(name + ".toml"), "-o", out, "-q"}), 0);
        const std::string events = scratch::read(folder / "run/events.jsonl");
        BOOST_TEST(contains(events, "\"perturbed\":[{\"decision\":"));
        BOOST_TEST(contains(events, "\"first_order\":["));
        const auto summary = nlohmann::json::parse(scratch::read(folder / "run/summary.json"));
        long settled = 0;
        for (const auto& [kind, count] : summary.at("counters").at("decisions").at("ties").at("perturbed").items()) {
            settled += count.get<long>();
        }
        BOOST_TEST(settled > 0);
        BOOST_TEST(contains(scratch::read(folder / "run/states/eq_000001.json"), "\"rho\":["));
        says(run({"verify", out}), 0, {"first-order decisions checked"});
        const Outcome seen = run({"inspect", folder.at("run/states/eq_000001.json")});
        const Outcome json = run({"inspect", folder.at("run/states/eq_000001.json"), "--json"});
        if (name == "two-gaps") { // the other disk may carry load too, from nothing to all but what the first needs
            BOOST_TEST(contains(seen.out, "touching besides"));
            BOOST_TEST(contains(seen.out, "1 self-stresses"));
            BOOST_TEST(nlohmann::json::parse(json.out).at("face").at("h") == 1);
            BOOST_TEST(nlohmann::json::parse(json.out).at("face").at("forces_between").size() == 4U);
        } else {
            BOOST_TEST(contains(seen.out, "left at force 0"));
            BOOST_TEST(nlohmann::json::parse(json.out).at("left_at_zero").size() == 1U);
        }
    }
}

BOOST_FIXTURE_TEST_CASE(a_hyperstatic_start_is_refused_with_its_self_stress_or_followed, scratch::InFolder) {
    ran(folder, stopped("equal-pair"), 65,
        {"h = 1", "self-stresses", "0-top", "1-top", "0-bottom", "1-bottom", "ties = \"choose\""});
    expect(run({"run", example("equal-pair.toml"), "-o", folder.at("run"), "-q"}), 0);
    const std::string state = scratch::read(folder / "run/states/eq_000000.json");
    BOOST_TEST(contains(state, "\"open\":[["));
    BOOST_TEST(contains(state, "\"zero\":[["));
    expect(run({"verify", folder.at("run")}), 0);
    says(run({"plan", example("equal-pair.toml")}), 0, {"first order in the radii", "rho from seed 1"});
}

BOOST_FIXTURE_TEST_CASE(a_list_that_is_dependent_where_an_arc_ends_is_exchanged_before_and_recorded,
                        scratch::InFolder) {
    // 12 equal disks: the contact that closes does not stop the motion, a pair that rests does.
    ran(folder,
        "[packing]\ndisks = 12\ndiameters = [1.0, 1.0]\nseed = 7\n[run]\nties = \"choose\"\n[[programme]]\ndo = "
        "\"up\"\n"
        "equilibria = 30\n",
        1, {"equilibrium 3 supports every load"});
    BOOST_TEST(contains(scratch::read(folder / "run/events.jsonl"), "\"decision\":\"end\",\"contact\":\"6-top\""));
    says(run({"verify", folder.at("run"), "-q"}), 0, {"4 of 4 proved"});
}

BOOST_AUTO_TEST_CASE(a_run_with_a_force_at_zero_is_resumed_with_the_same_records) {
    const auto records = [](const std::string& segments) {
        const scratch::Folder folder;
        ran(folder, scratch::replaced(scene_of("two-forces"), "equilibria = 1", segments), {});
        const std::string summary = scratch::read(folder / "run/summary.json");
        return std::pair(scratch::read(folder / "run/events.jsonl"),
                         summary.substr(summary.find("arc 1 of the rearrangement"), 60));
    };
    // One segment of two limits against two segments of one: the second starts from what was stored.
    const auto one = records("equilibria = 2");
    const auto two = records("equilibria = 1\n\n[[programme]]\ndo = \"down\"\nfrom = 1\nequilibria = 1");
    BOOST_TEST(one.first == two.first);
    BOOST_TEST(one.second == two.second);
}

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
