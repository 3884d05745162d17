// The command as a user runs it.
// One process that dies must not touch the others.
#include "cli/background.hpp"
#include "cli/program.hpp"
#include "ensemble/ensemble.hpp"
#include "ensemble/processes.hpp"
#include "support/scratch.hpp"

#include <csignal>

using namespace program;
namespace fs = std::filesystem;
using namespace isostat;

namespace {

const std::string small = "[packing]\ndisks = 30\nseed = 1\n[[programme]]\ndo = \"up\"\nto = 1.1\n"
                          "[[programme]]\ndo = \"down\"\nto = 1.0\n[output]\npictures = false\n";

std::string table(const fs::path& folder, const char* name) {
    const std::string text = scratch::read(folder / name);
    return std::string(name) == "samples.csv" ? scratch::without_times(text) : text;
}

void same_tables(const fs::path& a, const fs::path& b) {
    for (const char* name : {"equilibria.csv", "increments.csv", "samples.csv"}) {
        BOOST_TEST(!table(a, name).empty(), name);
        BOOST_TEST((table(a, name) == table(b, name)), name);
    }
}

long lines(const std::string& text) {
    return std::ranges::count(text, '\n');
}

/// A child process of another process that runs `word`.
pid_t child_of(pid_t parent) {
    std::istringstream children(
        scratch::read("/proc/" + std::to_string(parent) + "/task/" + std::to_string(parent) + "/children"));
    pid_t pid = 0;
    children >> pid;
    return pid;
}

struct Watch {
    std::map<std::size_t, ProcessEnd> ends;
    std::vector<std::size_t> done;
    int running = 0, most = 0;
};

/// Runs shell commands; `on_wait` is called now and then.
Watch run_shell(
    const std::vector<std::string>& scripts, int jobs, std::atomic<bool>& stop,
    const std::function<void()>& on_wait = [] {}) {
    const scratch::Folder folder;
    Watch watch;
    LocalQueue queue(scripts.size());
    queue.on_done = [&](std::size_t number) { watch.done.push_back(number); };
    run_processes(
        queue, jobs, stop,
        [&](std::size_t number) -> std::optional<Command> {
            if (scripts[number].empty()) {
                return std::nullopt;
            }
            if (scripts[number] == "no program") {
                return Command{folder / "nothing", {}, folder / "log"};
            }
            return Command{"/bin/sh", {"-c", scripts[number]}, folder / ("log" + std::to_string(number))};
        },
        [&](std::size_t) { watch.most = std::max(watch.most, ++watch.running); },
        [&](std::size_t number, const ProcessEnd& end) {
            --watch.running;
            watch.ends[number] = end;
        },
        on_wait);
    return watch;
}

} // namespace

BOOST_FIXTURE_TEST_CASE(the_tables_do_not_depend_on_the_number_of_jobs, scratch::InFolder) {
    const std::string scene = folder.file("s.toml", small);
    for (const char* jobs : {"1", "2", "7"}) {
        expect(run({"ensemble", scene, "--samples", "9", "-o", (folder / jobs).string(), "-j", jobs, "-q"}), 0);
        same_tables(folder / "1", folder / jobs);
    }
    BOOST_TEST(lines(table(folder / "1", "samples.csv")) == 10);
    // Seeds make a difference, and they are in order.
    std::istringstream rows(table(folder / "1", "equilibria.csv"));
    std::string line;
    std::getline(rows, line);
    std::vector<int> seeds;
    std::set<std::string> starts;
    while (std::getline(rows, line)) {
        const int seed = std::stoi(line);
        if (seeds.empty() || seeds.back() != seed) {
            seeds.push_back(seed);
            starts.insert(line.substr(line.find(',')));
        }
    }
    BOOST_TEST((seeds == std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    BOOST_TEST(starts.size() == 9U);
}

BOOST_FIXTURE_TEST_CASE(a_sample_is_the_run_of_its_scene, scratch::InFolder) {
    expect(run({"ensemble", folder.file("s.toml", small), "-S", "2", "--first-seed", "41", "-o", folder.at("e"), "-q"}),
           0);
    scratch::write(folder / "42.toml", scratch::replaced(small, "seed = 1", "seed = 42"));
    expect(run({"run", folder.at("42.toml"), "-o", folder.at("r"), "-q"}), 0);
    const fs::path sample = folder / "e/samples/seed_000042";
    BOOST_TEST((scratch::read(sample / "events.jsonl") == scratch::read(folder / "r/events.jsonl")));
    BOOST_TEST(scratch::without_times(scratch::read(sample / "equilibria.csv")) ==
               scratch::without_times(scratch::read(folder / "r/equilibria.csv")));
    BOOST_TEST(scratch::read(sample / "scene.toml") == scratch::read(folder / "42.toml"));
}

BOOST_FIXTURE_TEST_CASE(one_sample_that_cannot_be_written_loses_no_other_and_is_made_up_for, scratch::InFolder) {
    const std::string scene = folder.file("s.toml", small);
    expect(run({"ensemble", scene, "-S", "4", "-o", folder.at("whole"), "-q"}), 0);
    expect(run({"ensemble", scene, "-S", "1", "-o", folder.at("e"), "-q"}), 0);
    fs::create_directories(folder / "e/samples/seed_000002");
    scratch::write(folder / "e/samples/seed_000002/mine.txt", "precious"); // a run goes where nothing else is
    const Outcome broken = run({"ensemble", scene, "-S", "4", "-o", folder.at("e"), "-q", "-j", "1", "--resume"});
    expect(broken, 1, {"seed 2: refused", "mine.txt"});
    const auto counts = nlohmann::json::parse(scratch::read(folder / "e/ensemble.json"))["counts"];
    BOOST_TEST(counts["completed"] == 3);
    BOOST_TEST(counts["refused"] == 1);
    fs::remove(folder / "e/samples/seed_000002/mine.txt");
    expect(run({"ensemble", scene, "-S", "4", "-o", folder.at("e"), "-q", "--resume"}), 0);
    same_tables(folder / "e", folder / "whole");
}

BOOST_FIXTURE_TEST_CASE(a_sample_that_fails_at_its_load_is_a_result, scratch::InFolder) {
    const std::string text = scratch::replaced(small, "to = 1.1", "to = 1000.0") + "[run]\nmax_strain = 0.01\n";
    const std::string scene = folder.file("s.toml", text);
    const Outcome outcome = run({"ensemble", scene, "-S", "3", "-o", folder.at("e"), "--json"});
    expect(outcome, 1, {"max_strain"});
    const auto object = nlohmann::json::parse(outcome.out);
    BOOST_TEST(object["counts"]["failed"] == 3);
    BOOST_TEST(object["equilibria"] == object["proved"]);
    // Results are not made again.
    const auto stamp = fs::last_write_time(folder / "e/samples/seed_000001/run.json");
    expect(run({"ensemble", scene, "-S", "3", "-o", folder.at("e"), "-q", "--resume"}), 1);
    BOOST_TEST((fs::last_write_time(folder / "e/samples/seed_000001/run.json") == stamp));
}

BOOST_FIXTURE_TEST_CASE(killed_ensembles_and_killed_samples_resume_to_the_same_tables, scratch::InFolder) {
    const std::string scene = folder.file("s.toml", scratch::replaced(small, "disks = 30", "disks = 200"));
    const fs::path whole = folder / "whole";
    expect(run({"ensemble", scene, "-S", "3", "-o", whole.string(), "-q"}), 0);
    for (const int signal : {SIGKILL, SIGTERM, SIGSEGV}) {
        BOOST_TEST_INFO_SCOPE("signal " << signal);
        const fs::path out = folder / ("cut" + std::to_string(signal));
        Background background({"ensemble", scene, "-S", "3", "-o", out.string(), "-q", "-j", "1"});
        if (signal == SIGSEGV) { // of the second sample
            BOOST_TEST(background.signal_at(out / "samples/seed_000002/run.json", 1, 0));
            const pid_t child = child_of(background.pid());
            BOOST_REQUIRE(child > 0); // 0 would be this process group
            BOOST_TEST(::kill(child, signal) == 0);
            BOOST_TEST(background.wait() == 1);
            const std::string text = scratch::read(out / "ensemble.json");
            BOOST_TEST(contains(text, "\"crashed\": 1"));
            BOOST_TEST(contains(text, "\"completed\": 2"));
        } else {
            BOOST_TEST(background.signal_at(out / "samples/seed_000002/run.json", 1, signal));
            BOOST_TEST(background.wait() == (signal == SIGTERM ? 130 : 128 + signal));
            if (signal == SIGTERM) {
                BOOST_TEST(contains(scratch::read(out / "ensemble.json"), "\"missing\": 1"));
            }
        }
        // The samples of a killed parent get SIGTERM: they may still be ending.
        for (int k = 0; signal == SIGKILL && k < 60000; ++k) {
            if (!contains(scratch::read(out / "samples/seed_000002/run.json"), "\"running\"")) {
                break;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        expect(run({"ensemble", scene, "-S", "3", "-o", out.string(), "-q", "--resume", "-j", "2"}), 0);
        same_tables(out, whole);
    }
}

BOOST_FIXTURE_TEST_CASE(more_samples_are_added_to_a_finished_ensemble, scratch::InFolder) {
    const std::string scene = folder.file("s.toml", small);
    expect(run({"ensemble", scene, "-S", "5", "-o", folder.at("five"), "-q"}), 0);
    expect(run({"ensemble", scene, "-S", "2", "-o", folder.at("e"), "-q"}), 0);
    expect(run({"ensemble", scene, "-S", "5", "-o", folder.at("e"), "-q", "--resume"}), 0);
    same_tables(folder / "e", folder / "five");
}

BOOST_FIXTURE_TEST_CASE(wrong_use_is_refused_before_anything_is_made, scratch::InFolder) {
    scratch::write(folder / "s.toml", small);
    scratch::write(folder / "other.toml", small + "# another text\n");
    scratch::write_scene(folder / "read.toml", scene_from(scratch::data("vertex100.txt"), up(6)));
    scratch::write(folder / "static.toml", "[packing]\ndisks = 12\n");
    const std::string out = folder.at("e");
    const auto with = [&](const char* scene, const std::vector<std::string>& more) {
        std::vector<std::string> words{"ensemble", (folder / scene).string(), "-o", out, "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    };
    expect(with("s.toml", {}), 64, {"--samples"});
    expect(with("s.toml", {"-S", "0"}), 64);
    expect(with("s.toml", {"-S", "2", "--jobs", "0"}), 64);
    expect(with("s.toml", {"-S", "2", "--resume"}), 65, {"no ensemble"});
    expect(with("read.toml", {"-S", "2"}), 65, {"vertex100.txt"});
    expect(with("static.toml", {"-S", "2"}), 65, {"[[programme]]"});
    expect(with("nothing.toml", {"-S", "2"}), 65, {"nothing.toml"});
    BOOST_TEST(!fs::exists(out + "/ensemble.json"));
    expect(with("s.toml", {"-S", "2"}), 0);
    expect(with("s.toml", {"-S", "2"}), 64, {"--resume"});
    expect(with("other.toml", {"-S", "2", "--resume"}), 65, {"another scene"});
    expect(with("s.toml", {"-S", "2", "--resume", "--first-seed", "2"}), 65, {"seed 1"});
    expect(with("other.toml", {"-S", "2", "--force"}), 0);
}

#ifdef ISOSTAT_MPIRUN
BOOST_FIXTURE_TEST_CASE(two_ranks_of_mpirun_make_the_tables_of_one_process, scratch::InFolder) {
    const std::string scene = folder.file("s.toml", small);
    const std::string mpirun =
        std::string(ISOSTAT_MPIRUN) + " --allow-run-as-root --oversubscribe -n 2 "; // Open MPI refuses both by default
    expect(run({"ensemble", scene, "-S", "9", "-o", folder.at("one"), "-q"}), 0);
    says(run({"ensemble", scene, "-S", "9", "-o", folder.at("two")}, mpirun), 0, {"on 2 ranks"});
    same_tables(folder / "two", folder / "one");
    expect(run({"ensemble", folder.at("no.toml"), "-S", "9", "-o", folder.at("no"), "-q"}, mpirun), 65);
    expect(run({"ensemble", scene, "-S", "9", "-o", folder.at("two"), "-q"}, mpirun),
           64); // rank 0 alone knows
}
#endif

BOOST_AUTO_TEST_CASE(every_end_is_told_and_none_ends_another) {
    std::atomic<bool> stop{false};
    const Watch watch = run_shell(
        {"exit 0", "kill -SEGV $$", "exit 3", "", "no program", "sleep 0.05", "kill -KILL $$", "exit 2"}, 3, stop);
    BOOST_TEST(watch.ends.size() == 7U);
    BOOST_TEST(watch.ends.at(0).status == 0);
    BOOST_TEST(watch.ends.at(1).signal == SIGSEGV);
    BOOST_TEST(watch.ends.at(2).status == 3);
    BOOST_TEST(watch.ends.at(4).status == 127);
    BOOST_TEST(watch.ends.at(5).status == 0);
    BOOST_TEST(watch.ends.at(5).signal == 0);
    BOOST_TEST(watch.ends.at(6).signal == SIGKILL);
    std::vector<std::size_t> done = watch.done;
    std::ranges::sort(done);
    BOOST_TEST((done == std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

BOOST_AUTO_TEST_CASE(never_more_than_jobs_at_a_time_and_as_many_as_that) {
    for (const int jobs : {1, 3}) {
        std::atomic<bool> stop{false};
        const Watch watch = run_shell(std::vector<std::string>(6, "sleep 0.05"), jobs, stop);
        BOOST_TEST(watch.most == jobs);
        BOOST_TEST(watch.ends.size() == 6U);
    }
}

BOOST_FIXTURE_TEST_CASE(a_stop_reaches_those_that_run_and_starts_no_more, scratch::InFolder) {
    std::atomic<bool> stop{false};
    const std::string ready = folder.at("ready");
    const Watch watch = run_shell(
        {"exec sleep 6000", "trap 'exit 5' TERM; touch " + ready + "; while :; do sleep 0.01; done", "exec sleep 6000"},
        2, stop, [&] { stop = std::filesystem::exists(ready); });
    BOOST_TEST(watch.ends.size() == 2U);
    BOOST_TEST(watch.ends.at(0).signal == SIGTERM);
    BOOST_TEST(watch.ends.at(1).status == 5); // it had the time to end in order
}
