// One process that dies must not touch the others.
#include "ensemble/processes.hpp"
#include "support/scratch.hpp"

#include <csignal>

using namespace isostat;

namespace {

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
    std::sort(done.begin(), done.end());
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

BOOST_AUTO_TEST_CASE(a_stop_reaches_those_that_run_and_starts_no_more) {
    std::atomic<bool> stop{false};
    const scratch::Folder folder;
    const std::string ready = folder.at("ready");
    const Watch watch = run_shell(
        {"exec sleep 6000", "trap 'exit 5' TERM; touch " + ready + "; while :; do sleep 0.01; done", "exec sleep 6000"},
        2, stop, [&] { stop = std::filesystem::exists(ready); });
    BOOST_TEST(watch.ends.size() == 2U);
    BOOST_TEST(watch.ends.at(0).signal == SIGTERM);
    BOOST_TEST(watch.ends.at(1).status == 5); // it had the time to end in order
}
