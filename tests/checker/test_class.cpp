// Runs under ties = "class": of forces that vanish together another one opens than the infinitesimal loads take, where
// the arc of that one is undecided. Re-checked from their records; forged ones must be found.
#include "support/course.hpp"
#include "support/forger.hpp"
#include "support/scratch.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/io/run_directory.hpp>
#include <isostat/preparation/preparation.hpp>

#include <boost/test/unit_test.hpp>

using namespace isostat;
using forger::altered;
namespace fs = std::filesystem;

namespace {

/// 16 disks, equal but for a jitter of 1e-9. At the limit after the second equilibrium the three forces on disk 8
/// vanish together; that in 8-11 falls with a slope of 4e-9.
State<2> nearly_equal() {
    PreparationOptions options;
    options.disks = 16;
    options.diameters.kind = RadiiLaw::equal;
    options.jitter = 1e-9;
    options.seed = 7;
    PreparationReport<2> report;
    auto prepared = prepare<2>(options, report);
    BOOST_REQUIRE(prepared.ok());
    return prepared.value();
}

/// The limit at which another opens is the third.
constexpr int third = 3;

void play(State<2> state, const fs::path& folder) {
    RunHeader header;
    header.program = "test";
    header.settings = R"({"run":{"rule":"most_negative","ties":"class"}})";
    header.states_every = 1;
    RunCounters counters;
    RunDirectory directory(folder, header, RunDirectory::Mode::fresh, counters);
    Segment segment;
    segment.equilibria = third;
    RunOptions options;
    options.ties = TiePolicy::by_class;
    directory.begin_segment(0, segment, 0, 0);
    const SegmentOutcome outcome = run_segment<2>(state, segment, 0, options, counters, directory);
    BOOST_REQUIRE(outcome.completed);
    BOOST_TEST(counters.tally.choices == 1);
    directory.finish(RunStatus::completed, "");
}

/// Two names exchanged wherever they are; in front of each there is a quotation mark.
std::string exchanged(std::string text, const std::string& a, const std::string& b) {
    const auto all = [&text](const std::string& from, const std::string& to) {
        for (std::size_t at = 0; (at = text.find('"' + from + '"', at)) != std::string::npos; at += to.size()) {
            text.replace(at + 1, from.size(), to);
        }
    };
    all(a, "other");
    all(b, a);
    all("other", b);
    return text;
}

void refuted(const RunVerification& forged, const std::string& said) {
    BOOST_TEST((forged.verdict == Verdict::refuted), (forged.undecided.empty() ? "" : forged.undecided[0]));
    BOOST_TEST(forged.wrong.find(said) != std::string::npos, forged.wrong);
}

} // namespace

BOOST_AUTO_TEST_SUITE(checker)

BOOST_AUTO_TEST_CASE(only_under_class_another_of_a_class_opens_and_it_falls_as_fast_as_any) {
    const State<2> start = nearly_equal();
    const crafted::Course stopped = crafted::follow_load(start, +1, third, TiePolicy::stop);
    BOOST_TEST(stopped.end() == "undecided");
    BOOST_TEST(mentions(stopped, "ties = \"class\""));
    const crafted::Course course = crafted::follow_load(start, +1, third, TiePolicy::by_class);
    BOOST_REQUIRE_MESSAGE(course.end() == "completed",
                          (course.outcome.failure ? course.outcome.failure->message() : ""));
    // The same path up to there.
    BOOST_REQUIRE(stopped.events.size() < course.events.size());
    BOOST_TEST(std::equal(stopped.events.begin(), stopped.events.end(), course.events.begin()));
    int chosen = 0;
    for (const ArcRecord<2>& arc : course.arcs) {
        for (const TieDecision& tie : arc.perturbed) {
            ++chosen;
            BOOST_TEST((arc.kind == ArcKind::limit && tie.choice == TieChoice::slope && tie.chosen == arc.opened));
            BOOST_TEST(mentions(stopped, isostat::to_string<2>(tie.against)), "the arc that is undecided");
            BOOST_TEST(std::abs(tie.first.value) >= 0.5 * std::abs(tie.other.value));
            BOOST_TEST(tie.other.decided());
        }
    }
    BOOST_TEST(chosen == 1);
}

BOOST_AUTO_TEST_CASE(a_forged_choice_in_a_class_is_refused) {
    const scratch::Folder scratch_folder;
    const fs::path folder = scratch_folder / "run";
    play(nearly_equal(), folder);
    const RunVerification run = verify_run(folder);
    BOOST_TEST(run.wrong == "");
    BOOST_TEST((run.verdict == Verdict::proved), (run.undecided.empty() ? "" : run.undecided[0]));
    BOOST_TEST(run.classes_checked == 1);
    BOOST_TEST(run.choices_checked == 0);
    const std::string events = scratch::read(folder / "events.jsonl");
    const std::size_t at = events.find("\"choice\":\"slope\"");
    BOOST_REQUIRE(at != std::string::npos);
    const std::size_t line = events.rfind('\n', at) + 1;
    const std::size_t begin = events.rfind('{', at);
    const std::string record = events.substr(line, events.find('\n', at) - line);
    const std::string entry = events.substr(begin, events.find('}', at) + 1 - begin);
    BOOST_TEST_MESSAGE(record);
    const auto said = [&](const std::string& from, const std::string& to) {
        return altered(folder, "events.jsonl", record, scratch::replaced(record, from, to));
    };
    refuted(altered(folder, "run.json", "\"class\"", "\"stop\""), "chooses none");
    refuted(said(",\"perturbed\":[" + entry + "]", ""), "first under the infinitesimal loads");
    refuted(said("\"slope\"", "\"names\""), "first under the infinitesimal loads");
    refuted(said("\"decision\":\"limit\"", "\"decision\":\"opening\""), "opens by its slope");
    refuted(said("\"against\":\"8-11\"", "\"against\":\"0-bottom\""), "does not vanish with it"); // no member
    refuted(said("\"against\":\"8-11\"", "\"against\":\"4-8\""), "does not vanish with it");      // itself
    refuted(said("\"contact\":\"4-8\"", "\"contact\":\"8-11\""), "does not vanish with it");      // not what opens
    refuted(said("\"first_order\":[-", "\"first_order\":["), "slopes are not as recorded");
    refuted(said("\"against_first_order\":[-", "\"against_first_order\":[-1"), "slopes are not as recorded");
    refuted(said("[" + entry, "[" + entry + "," + entry), "chooses none");
    // A slow one opens, by the record: its slope is 2e-9 of that of the other.
    const RunVerification wrong_member = altered(folder, "events.jsonl", record, exchanged(record, "4-8", "8-11"));
    BOOST_TEST((wrong_member.verdict != Verdict::proved));
    BOOST_TEST_MESSAGE(wrong_member.wrong);
}

BOOST_AUTO_TEST_CASE(a_choice_where_the_infinitesimal_loads_decide_is_refused) {
    const scratch::Folder scratch_folder;
    const fs::path folder = scratch_folder / "run";
    play(nearly_equal(), folder);
    const std::string events = scratch::read(folder / "events.jsonl");
    const std::size_t at = events.find("\"choice\":\"slope\"");
    const std::size_t begin = events.rfind('{', at);
    const std::string entry = events.substr(begin, events.find('}', at) + 1 - begin);
    // The same entry on the first arc, a limit whose arc was decided, of what opens there against another contact.
    const std::string first = events.substr(0, events.find('\n'));
    const std::size_t name = first.find("\"opened\":\"") + 10;
    const std::string opened = first.substr(name, first.find('"', name) - name);
    for (const std::string other : {"8-11", "4-8"}) {
        if (other != opened) {
            const std::string forged =
                scratch::replaced(scratch::replaced(scratch::replaced(entry, "8-11", "X"), "4-8", opened), "X", other);
            refuted(altered(folder, "events.jsonl", first,
                            first.substr(0, first.size() - 1) + ",\"perturbed\":[" + forged + "]}"),
                    "does not vanish with it");
        }
    }
}

BOOST_AUTO_TEST_SUITE_END()
