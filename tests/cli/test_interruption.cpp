// Kill, Ctrl-C and --resume.
// kill -9 at random instants, limits of the file size, two programs in one folder: at every level of certificates.
#include "cli/background.hpp"
#include "cli/program.hpp"

#include <isostat/io/run_directory.hpp>

#include <sys/stat.h>

#include <chrono>

using namespace program;
namespace fs = std::filesystem;

namespace {

/// Two segments, so that a signal can come in either; vertex400 keeps it going long enough to be hit.
const std::string long_scene =
    "[[programme]]\ndo = \"up\"\nequilibria = 12\n[[programme]]\ndo = \"down\"\nfrom = 4\nequilibria = 6\n";

const std::string programme =
    "[[programme]]\ndo = \"up\"\nequilibria = 8\n[[programme]]\ndo = \"down\"\nfrom = 4\nequilibria = 3\n";

std::string scene(const std::string& level) {
    return scene_from(scratch::data("vertex100.txt"), programme,
                      "checkpoint_seconds = 0\n[run]\ncertify = \"" + level + "\"\n");
}

} // namespace

/// Choices are made again by a resumed run, with other arithmetic behind it and any number of threads.
BOOST_FIXTURE_TEST_CASE(runs_that_choose_are_the_same_resumed_and_with_any_number_of_threads, scratch::InFolder,
                        *boost::unit_test::label("slow")) {
    const std::string scene = folder.at("s.toml");
    scratch::write(
        scene, "[packing]\ndisks = 30\nlaw = \"bidisperse\"\nseed = 4\n[run]\nties = \"choose\"\n[output]\npictures = "
               "false\ncheckpoint_seconds = 0\n[[programme]]\ndo = \"up\"\nequilibria = 10\n[[programme]]\ndo = "
               "\"down\"\nfrom = 4\nequilibria = 4\n");
    const fs::path whole = folder / "whole";
    expect(run({"run", scene, "-o", whole.string(), "-q", "--threads", "1"}), 0);
    const std::string events = scratch::read(whole / "events.jsonl");
    BOOST_TEST(contains(events, "\"choice\":"));
    const auto arcs = std::ranges::count(events, '\n');
    for (const int threads : {1, 2, 3}) {
        BOOST_TEST_INFO_SCOPE(threads << " threads");
        const fs::path out = folder / ("cut" + std::to_string(threads));
        Background background({"run", scene, "-o", out.string(), "-q", "--threads", std::to_string(threads % 3 + 1)});
        BOOST_TEST(background.signal_at(out / "events.jsonl", threads * arcs / 4, SIGKILL));
        const int status = background.wait();
        BOOST_TEST((status == 128 + SIGKILL || status == 0)); // 0: it was faster than the signal
        if (status != 0) {
            BOOST_TEST(contains(scratch::read(out / "run.json"), "\"status\": \"running\""));
            BOOST_TEST(!fs::exists(out / "summary.json"));
        }
        expect(run({"run", scene, "-o", out.string(), "-q", "--resume", "--threads", std::to_string(threads)}), 0);
        same_records(whole, out);
    }
}

BOOST_FIXTURE_TEST_CASE(ctrl_c_leaves_valid_files_and_resumes, scratch::InFolder) {
    const std::string scene = folder.at("s.toml");
    scratch::write_scene(scene, scene_from(scratch::data("vertex400.txt"), long_scene, "checkpoint_seconds = 0\n"));
    expect(run({"run", scene, "-o", folder.at("whole"), "-q"}), 0);
    for (const int signal : {SIGINT, SIGTERM}) {
        const fs::path out = folder / ("cut" + std::to_string(signal));
        Background background({"run", scene, "-o", out.string(), "-q"});
        BOOST_TEST(background.signal_at(out / "equilibria.csv", 4, signal));
        const int status = background.wait();
        BOOST_TEST((status == 130 || status == 0));
        if (status == 130) {
            BOOST_TEST(contains(scratch::read(out / "run.json"), "\"status\": \"interrupted"));
            BOOST_TEST(contains(scratch::read(out / "summary.json"), "\"status\": \"interrupted\""));
            BOOST_TEST(isostat::read_equilibria(out / "equilibria.csv").size() >= 3U);
        }
        expect(run({"run", scene, "-o", out.string(), "-q", "--resume"}), 0);
        same_records(folder / "whole", out);
    }
}

/// A command that reads a pipe from which nothing ever comes ends by one signal.
void ends_by(int signal, const std::string& pipe, const Arguments& command) {
    const Background background(command);
    int status = 0, writer = -1;
    bool ended = false, sent = false;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(10);
    while (!ended && std::chrono::steady_clock::now() < deadline) {
        if (!sent && (writer = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK)) >= 0) { // it reads
            sent = ::kill(background.pid(), signal) == 0;
        }
        ended = ::waitpid(background.pid(), &status, WNOHANG) == background.pid();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (!ended) {
        ::kill(background.pid(), SIGKILL);
        ::waitpid(background.pid(), &status, 0);
    }
    if (writer >= 0) {
        ::close(writer);
    }
    BOOST_TEST(sent);
    BOOST_TEST(ended);
    BOOST_TEST((WIFSIGNALED(status) && WTERMSIG(status) == signal));
}

BOOST_FIXTURE_TEST_CASE(one_ctrl_c_ends_a_command_that_has_written_no_records, scratch::InFolder) {
    const std::string pipe = folder.at("input"), out = folder.at("out");
    BOOST_TEST_REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    for (const int signal : {SIGINT, SIGTERM}) {
        for (const Arguments& command : {Arguments{"verify", pipe},
                                         {"run", pipe, "-o", out},
                                         {"prepare", pipe, "-o", out},
                                         {"ensemble", pipe, "-o", out, "--samples", "2"}}) {
            BOOST_TEST_INFO_SCOPE(command[0]);
            ends_by(signal, pipe, command);
        }
    }
}

BOOST_FIXTURE_TEST_CASE(verify_and_report_end_at_ctrl_c_with_a_line, scratch::InFolder) {
    const std::string pipe = folder.at("input"), said = folder.at("said");
    BOOST_TEST_REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    for (const char* command : {"verify", "report"}) {
        const std::string line =
            std::string("timeout -s INT 2 ") + ISOSTAT_PROGRAM + " " + command + " " + pipe + " 2>" + said;
        BOOST_TEST(std::system(line.c_str()) != 0);
        BOOST_TEST(contains(scratch::read(said), "isostat: stopped\n"), command);
    }
}

BOOST_FIXTURE_TEST_CASE(resuming_a_finished_run_changes_nothing, scratch::InFolder) {
    const std::string scene = folder.at("s.toml");
    const fs::path out = folder / "run";
    scratch::write_scene(scene, scene_from(scratch::data("vertex100.txt"), up(6)));
    expect(run({"run", scene, "-o", out.string(), "-q"}), 0);
    std::vector<std::string> before;
    for (const char* name : {"events.jsonl", "equilibria.csv", "summary.json", "run.json", "states/last.json"}) {
        before.push_back(scratch::read(out / name));
    }
    expect(run({"run", scene, "-o", out.string(), "-q", "--resume"}), 0);
    std::size_t k = 0;
    for (const char* name : {"events.jsonl", "equilibria.csv", "summary.json", "run.json", "states/last.json"}) {
        BOOST_TEST(scratch::read(out / name) == before[k++], name);
    }
}

BOOST_FIXTURE_TEST_CASE(a_run_killed_before_its_first_equilibrium_is_one_without_equilibria, scratch::InFolder) {
    const std::string scene = folder.at("s.toml"), out = folder.at("run");
    scratch::write(scene, "[packing]\ndisks = 3000\n" + up(6));
    Background background({"run", scene, "-o", out, "-q"});
    for (int k = 0; k < 600000 && !fs::exists(folder / "run/equilibria.csv"); ++k) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    BOOST_TEST(background.signal_at(folder / "run/run.json", 1, SIGKILL));
    (void)background.wait();
    BOOST_TEST(isostat::read_equilibria(folder / "run/equilibria.csv").empty());
    expect(run({"report", out, "--html", "-q"}), 0);
    expect(run({"verify", out}), 2, {});
}

BOOST_FIXTURE_TEST_CASE(a_preparation_that_is_interrupted_says_where_and_keeps_what_it_reached, scratch::InFolder) {
    const std::string scene = folder.file("s.toml", "[packing]\ndisks = 3000\n" + up(6));
    Background background({"run", scene, "-o", folder.at("run"), "-q"});
    BOOST_TEST(background.signal_at(folder / "run/run.json", 1, SIGINT)); // it is there before the preparation
    BOOST_TEST(background.wait() == 130);
    BOOST_TEST(contains(scratch::read(folder / "run/run.json"), "interrupted: "));
    BOOST_TEST(contains(scratch::read(folder / "run/run.json"), "preparation failed at "));
    BOOST_TEST(contains(scratch::read(folder / "run/preparation_failed.json"), "isostat-packing"));
    BOOST_TEST(!fs::exists(folder / "run/start.json"));
    BOOST_TEST(!fs::exists(folder / "run/states/last.json"));
}

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
                if (fs::exists(out / "lock")) { // `timeout` ends too, perhaps before the run, which holds the lock
                    BOOST_TEST(std::system(("flock " + (out / "lock").string() + " true").c_str()) == 0);
                }
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

BOOST_FIXTURE_TEST_CASE(a_limit_of_the_file_size_is_a_failed_write_and_the_run_goes_on_later, scratch::InFolder) {
    const std::string file = folder.at("s.toml");
    scratch::write_scene(file, scene("decisions"));
    expect(run({"run", file, "-o", folder.at("whole"), "-q"}), 0);
    const std::string out = folder.at("cut");
    // 20 blocks of 512 bytes: room for the start, not for all events.
    expect(run({"run", file, "-o", out, "-q"}, "ulimit -f 20; "), 74, {"cannot write"});
    expect(run({"run", file, "-o", out, "-q", fs::exists(fs::path(out) / "run.json") ? "--resume" : "-q"}), 0);
    same_records(folder / "whole", out);
}

BOOST_FIXTURE_TEST_CASE(the_levels_leave_what_they_promise, scratch::InFolder) {
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
