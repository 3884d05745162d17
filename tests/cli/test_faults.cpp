// kill -9 at random instants, limits of the file size, two programs in one folder: at every level of certificates.
#include "cli/program.hpp"

#include <chrono>

using namespace program;
namespace fs = std::filesystem;

namespace {

const std::string programme =
    "[[programme]]\ndo = \"up\"\nequilibria = 8\n[[programme]]\ndo = \"down\"\nfrom = 4\nequilibria = 3\n";

std::string scene(const std::string& level) {
    return scene_from(scratch::data("vertex100.txt"), programme,
                      "checkpoint_seconds = 0\n[run]\ncertify = \"" + level + "\"\n");
}

} // namespace

BOOST_AUTO_TEST_CASE(runs_killed_again_and_again_at_random_instants_end_with_the_records_of_a_whole_run,
                     *boost::unit_test::label("slow")) {
    std::mt19937 random(8);
    for (const std::string& level : {std::string("decisions"), std::string("arcs")}) {
        const scratch::Folder folder;
        const std::string file = folder.at("s.toml");
        scratch::write_scene(file, scene(level));
        const auto begin = std::chrono::steady_clock::now();
        expect(run({"run", file, "-o", folder.at("whole"), "-q"}), 0);
        const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
        const fs::path out = folder / "cut";
        int kills = 0;
        for (int k = 0; k < 40 && kills < 6; ++k) {
            // `timeout` kills after a random time; --resume also starts, when there is nothing yet to resume.
            const bool begun = fs::exists(out / "run.json");
            std::vector<std::string> arguments{"run", file, "-o", out.string(), "-q"};
            if (begun) {
                arguments.emplace_back("--resume");
            }
            const double after = whole.count() * (0.1 + 0.006 * static_cast<double>(random() % 100)) / (1 + k - kills);
            const Outcome outcome = run(arguments, "timeout -s KILL " + std::to_string(after) + " ");
            if (outcome.status != 0) {
                ++kills;
            } else if (kills > 0) {
                break;
            } else { // the machine has become faster: it is killed sooner
                fs::remove_all(out);
            }
        }
        BOOST_TEST(kills > 0);
        expect(run({"run", file, "-o", out.string(), "-q", fs::exists(out / "run.json") ? "--resume" : "-q"}), 0);
        same_records(folder / "whole", out);
    }
}

BOOST_AUTO_TEST_CASE(a_limit_of_the_file_size_is_a_failed_write_and_the_run_goes_on_later) {
    const scratch::Folder folder;
    const std::string file = folder.at("s.toml");
    scratch::write_scene(file, scene("decisions"));
    expect(run({"run", file, "-o", folder.at("whole"), "-q"}), 0);
    const std::string out = folder.at("cut");
    // 20 blocks of 512 bytes: room for the start, not for all events.
    const Outcome full = run({"run", file, "-o", out, "-q"}, "ulimit -f 20; ");
    expect(full, 74, {"cannot write"});
    expect(run({"run", file, "-o", out, "-q", fs::exists(fs::path(out) / "run.json") ? "--resume" : "-q"}), 0);
    same_records(folder / "whole", out);
}

BOOST_AUTO_TEST_CASE(the_levels_leave_what_they_promise) {
    const scratch::Folder folder;
    const std::string file = folder.at("s.toml");
    for (const std::string& level : {std::string("decisions"), std::string("states"), std::string("arcs")}) {
        scratch::write_scene(file, scene(level));
        const fs::path out = folder / level;
        expect(run({"run", file, "-o", out.string(), "-q"}), 0);
        const std::string events = scratch::read(out / "events.jsonl");
        const std::string summary = scratch::read(out / "summary.json");
        BOOST_TEST(contains(events, "\"certificate\":{\"verdict\":\"proved\"") == (level == "arcs"));
        BOOST_TEST(!contains(events, "\"certificate\":{\"verdict\":\"undecided\""));
        BOOST_TEST(fs::exists(out / "certificates/eq_000003.json") == (level != "decisions"));
        BOOST_TEST(contains(summary, "\"certified_arcs\""));
        if (level != "decisions") {
            expect(run({"verify", (out / "certificates/eq_000003.json").string()}), 0);
            BOOST_TEST(contains(summary, "\"proved\": 12"));
        }
        const Outcome plan = run({"plan", file});
        BOOST_TEST(contains(plan.out, "proof   arcs"));
        BOOST_TEST((plan.out.find("proof   arcs") < plan.out.find("left out")) == (level == "arcs"));
    }
    scratch::write_scene(file, scene("everything"));
    expect(run({"run", file, "-o", folder.at("none"), "-q"}), 65, {"certify", "decisions"});
}
