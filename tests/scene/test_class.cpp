// A run under ties = "class" that is stopped and resumed: its choices are made again, with other arithmetic behind
// them.
#include "support/scratch.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/run_directory.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/scene/scene.hpp>

#include <boost/test/unit_test.hpp>

#include <atomic>

using namespace isostat;
namespace fs = std::filesystem;

namespace {

/// Another of a class opens twice, at arcs 48 and 57 of 63.
const std::string text = "[packing]\ndisks = 20\nlaw = \"equal\"\nseed = 11\njitter = 1e-9\n[run]\nties = \"class\"\n"
                         "[output]\npictures = false\ncheckpoint_seconds = 0\n"
                         "[[programme]]\ndo = \"up\"\nequilibria = 11\n";

/// Sets a flag when so many arcs are recorded.
class StopAt : public RunObserver<2> {
  public:
    explicit StopAt(long arcs) : arcs_(arcs) {}
    void on_arc(const ArcRecord<2>& arc) override { stop = stop || arc.step >= arcs_; }
    std::atomic<bool> stop{false};

  private:
    long arcs_;
};

RunStatus play(const Scene& scene, const State<2>& start, const fs::path& folder, RunDirectory::Mode mode,
               long stop_at) {
    RunCounters counters;
    RunDirectory directory(folder, header_of(scene, "test", ""), mode, counters);
    StopAt observer(stop_at);
    const SceneEnding ending = play_scene(scene, start, directory, "test", counters, observer.stop, observer);
    directory.finish(ending.status, ending.reason);
    return ending.status;
}

} // namespace

BOOST_AUTO_TEST_SUITE(scene)

BOOST_AUTO_TEST_CASE(choices_in_a_class_are_the_same_in_a_run_that_was_stopped_beside_them) {
    const scratch::Folder folder;
    const Scene scene = parse_scene(text, "s.toml", "");
    PreparationReport<2> report;
    const auto start = prepare<2>(scene.preparation, report);
    BOOST_REQUIRE(start.ok());
    const fs::path whole = folder / "whole";
    constexpr long never = 1'000'000;
    BOOST_TEST((play(scene, start.value(), whole, RunDirectory::Mode::fresh, never) == RunStatus::completed));
    const std::string events = scratch::read(whole / "events.jsonl");
    const auto chosen_before = [&](long arcs) {
        std::size_t end = 0;
        for (long k = 0; k < arcs; ++k) {
            end = events.find('\n', end) + 1;
        }
        const std::string head = events.substr(0, end);
        return (head.find("\"choice\":\"slope\"") != std::string::npos ? 1 : 0) +
               (head.find("\"choice\":\"slope\"") != head.rfind("\"choice\":\"slope\"") ? 1 : 0);
    };
    for (const auto& [arcs, chosen] : {std::pair{30L, 0}, {47L, 0}, {48L, 1}, {49L, 1}, {56L, 1}, {57L, 2}, {58L, 2}}) {
        BOOST_TEST_CONTEXT("stopped after arc " << arcs) {
            BOOST_TEST(chosen_before(arcs) == chosen);
            const fs::path cut = folder / ("cut" + std::to_string(arcs));
            BOOST_TEST((play(scene, start.value(), cut, RunDirectory::Mode::fresh, arcs) == RunStatus::interrupted));
            BOOST_TEST((play(scene, start.value(), cut, RunDirectory::Mode::resume, never) == RunStatus::completed));
            BOOST_TEST((scratch::read(cut / "events.jsonl") == events));
            BOOST_TEST(scratch::without_times(scratch::read(cut / "equilibria.csv")) ==
                       scratch::without_times(scratch::read(whole / "equilibria.csv")));
        }
    }
}

BOOST_AUTO_TEST_CASE(class_is_read_and_has_no_seed_and_proves_what_it_chooses) {
    const auto run = [](const std::string& keys) {
        return parse_scene("[packing]\ndisks = 9\n[run]\n" + keys, "s.toml", "").run;
    };
    BOOST_TEST((run("ties = \"class\"\n").ties == TiePolicy::by_class));
    BOOST_CHECK_THROW((void)run("ties = \"class\"\nties_seed = 2\n"), Error);
    BOOST_CHECK_THROW((void)run("ties = \"class\"\ncertify = \"plain\"\n"), Error);
}

BOOST_AUTO_TEST_SUITE_END()
