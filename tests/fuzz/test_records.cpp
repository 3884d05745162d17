// Records of a run: run.json, events.jsonl, equilibria.csv, checkpoint.json, stored states.

#include "checker/run_records.hpp"
#include "fuzz/harness.hpp"
#include "io/files.hpp"
#include "io/state_json.hpp"
#include "io/text.hpp"
#include "report/charts.hpp"
#include "report/run_report.hpp"
#include "support/crafted.hpp"
#include "support/forger.hpp"
#include "support/scratch.hpp"
#include "support/segments.hpp"

#include <isostat/io/run_directory.hpp>

#include <sys/resource.h>

using namespace fuzz;
namespace fs = std::filesystem;

namespace {

RunHeader header() {
    RunHeader header;
    header.program = "test";
    header.settings = R"({"run":{"rule":"most_negative","ties":"stop","certify":"decisions"}})";
    header.programme = {"up"};
    header.states_every = 1;
    return header;
}

/// Two disks, two equilibria.
void play(const fs::path& folder) {
    RunCounters counters;
    RunDirectory directory(folder, header(), RunDirectory::Mode::fresh, counters);
    State state = ::crafted::two_disks(1, 2, 1, 1);
    const Segment segment = towards(-1);
    RunOptions options{.max_strain = 1e9};
    directory.begin_segment(0, segment, 0, 0);
    const SegmentOutcome outcome = run_segment(state, segment, 0, options, counters, directory);
    BOOST_TEST_REQUIRE(outcome.completed);
    directory.finish(RunStatus::completed, "");
}

/// A run with one file of it changed and its digests made to fit; `read` reads the run.
struct Damaged {
    scratch::Folder folder;
    fs::path run = folder / "run";
    Damaged() { play(run); }

    Count fuzz(const std::string& name, int samples, const std::function<std::string(const std::string&)>& read) {
        const std::string original = scratch::read(run / name);
        const Count tally = fuzz::fuzz(name, original, samples, [&](const std::string& changed) {
            scratch::write(run / name, changed);
            forger::seal(run);
            try {
                return read(changed);
            } catch (const Error& error) {
                const std::string message = error.what();
                BOOST_TEST((message.find(run.string()) == 0), message);
                throw Error(error.kind(), "FILE" + message);
            }
        });
        scratch::write(run / name, original);
        forger::seal(run);
        return tally;
    }
};

std::size_t lines_with_something(const std::string& text) {
    const std::vector<std::string> lines = lines_of(text);
    return static_cast<std::size_t>(
        std::ranges::count_if(lines, [](const std::string& line) { return !line.empty(); }));
}

} // namespace

BOOST_AUTO_TEST_CASE(mutated_records_are_refused_by_name_or_lose_no_row, *boost::unit_test::label("slow")) {
    Damaged run;
    BOOST_TEST(run.fuzz("events.jsonl", 3000,
                        [&](const std::string& changed) {
                            const auto records = checker::read_records(run.run);
                            return rows_differ(records.events.size(), lines_with_something(changed));
                        })
                   .refused > 500);
    BOOST_TEST(run.fuzz("equilibria.csv", 3000,
                        [&](const std::string& changed) {
                            const auto records = checker::read_records(run.run);
                            return rows_differ(records.equilibria.size() + 1,
                                               std::max<std::size_t>(lines_with_something(changed), 1));
                        })
                   .refused > 500);
    BOOST_TEST(run.fuzz("run.json", 3000,
                        [&](const std::string&) {
                            (void)checker::read_records(run.run);
                            return std::string();
                        })
                   .refused > 200);
}

BOOST_AUTO_TEST_CASE(mutated_tables_of_equilibria_are_refused_by_name_or_lose_no_row_in_reports,
                     *boost::unit_test::label("slow")) {
    Damaged run;
    const Count tally = run.fuzz("equilibria.csv", 3000, [&](const std::string& changed) {
        const std::vector<EquilibriumRow> rows = read_equilibria(run.run / "equilibria.csv");
        (void)run_tables(rows, {"up"}, "completed");
        // The last line may be one that was being written when the run was killed.
        const std::vector<std::string> lines = lines_of(changed);
        const std::size_t complete = lines.size() - (changed.empty() || changed.ends_with('\n') ? 0 : 1);
        return rows_differ(rows.size() + 1, std::max<std::size_t>(complete, 1));
    });
    BOOST_TEST(tally.refused > 500);
}

BOOST_AUTO_TEST_CASE(mutated_checkpoints_are_refused_by_name_or_are_resumed, *boost::unit_test::label("slow")) {
    Damaged run;
    const auto resume = [&](const std::string&) {
        // A resume changes files: of a copy.
        fs::remove_all(run.folder / "copy");
        fs::copy(run.run, run.folder / "copy", fs::copy_options::recursive);
        const RunCounters counters;
        try {
            const RunDirectory again(run.folder / "copy", header(), RunDirectory::Mode::resume, counters);
            return again.checkpoint() ? unsound(again.checkpoint()->state) : std::string();
        } catch (const Error& error) {
            throw Error(error.kind(),
                        scratch::replaced(error.what(), (run.folder / "copy").string(), run.run.string()));
        }
    };
    const std::string original = scratch::read(run.run / "checkpoint.json");
    BOOST_TEST(fuzz::fuzz("checkpoint.json", original, 300, [&](const std::string& changed) {
                   scratch::write(run.run / "checkpoint.json", changed);
                   try {
                       return resume(changed);
                   } catch (const Error& error) {
                       throw Error(error.kind(), std::string("FILE ") + error.what());
                   }
               }).refused > 200);
    scratch::write(run.run / "checkpoint.json", original);
    // With a digest that fits.
    const std::string mark = ",\n\"digest\": ";
    const std::string whole = scratch::read(run.run / "checkpoint.json");
    const std::string body = whole.substr(0, whole.rfind(mark));
    const Count tally = fuzz::fuzz("checkpoint with its digest", body, 700, [&](const std::string& changed) {
        scratch::write(run.run / "checkpoint.json", changed + mark + '"' + sha256(changed) + "\"}\n");
        try {
            return resume(changed);
        } catch (const Error& error) {
            throw Error(error.kind(), std::string("FILE ") + error.what());
        }
    });
    BOOST_TEST(tally.refused > 100);
}

BOOST_AUTO_TEST_CASE(the_replay_of_mutated_records_ends_with_an_answer, *boost::unit_test::label("slow")) {
    Damaged run;
    const auto replay = [&](const std::string&) {
        (void)verify_run(run.run);
        return std::string();
    };
    for (const char* name :
         {"events.jsonl", "equilibria.csv", "run.json", "states/eq_000000.json", "states/eq_000001.json"}) {
        run.fuzz(name, 300, replay);
    }
}

BOOST_AUTO_TEST_CASE(reports_of_mutated_records_are_refused_by_name_or_are_text) {
    Damaged run;
    ReportOptions options{.charts = false};
    options.vtk = options.html = true;
    const auto draw = [&](const std::string&) {
        const ReportResult report = report_run(run.run, run.folder / "figures", options);
        for (const fs::path& file : report.files) {
            const std::string text = scratch::read(file);
            if (!file.string().ends_with(".html") && text::shown_lines(text) != text) {
                return file.filename().string() + " commands a terminal";
            }
        }
        return text::shown_lines(report.text) == report.text ? std::string()
                                                             : std::string("the report commands a terminal");
    };
    for (const char* name : {"run.json", "events.jsonl", "equilibria.csv", "summary.json", "states/eq_000001.json"}) {
        BOOST_TEST(run.fuzz(name, 150, draw).refused > 10);
    }
}

BOOST_AUTO_TEST_CASE(all_files_took_bounded_time_and_memory) {
    const Count& all = all_files();
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    BOOST_TEST_MESSAGE(all.accepted + all.refused << " files, " << all.refused << " refused, " << all.seconds
                                                  << " s, slowest " << all.slowest << " s, at most "
                                                  << used.ru_maxrss / 1024 << " MB");
#if !defined(__SANITIZE_ADDRESS__)
    BOOST_TEST(used.ru_maxrss / 1024 < 1000);
#endif
}
