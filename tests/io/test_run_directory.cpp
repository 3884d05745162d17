#include "io/equilibria.hpp"
#include "support/bad_input.hpp"
#include "support/cells.hpp"
#include "support/scratch.hpp"
#include "support/segments.hpp"

#include <isostat/io/run_directory.hpp>
#include <isostat/io/state_file.hpp>

#include <atomic>

using namespace isostat;
namespace fs = std::filesystem;
using Mode = RunDirectory::Mode;

namespace {

RunHeader header() {
    return {.program = "isostat test",
            .command = "isostat run",
            .scene_name = "test.toml",
            .scene_text = "text",
            .programme = {"up"},
            .keep = {2},
            .checkpoint_seconds = 0};
}

/// The folder of a run, before its first record.
RunDirectory opened(const fs::path& run, Mode mode, const RunHeader& head = header()) {
    static const RunCounters none;
    return RunDirectory(run, head, mode, none);
}

/// Writes the records, and raises a flag during some rearrangement.
class Stopper final : public RunObserver {
  public:
    Stopper(RunDirectory& directory, std::atomic<bool>& stop, long at_step)
        : directory_(directory), stop_(stop), at_step_(at_step) {}
    void on_arc(const ArcRecord& arc) override {
        directory_.on_arc(arc);
        stop_ = stop_ || arc.step == at_step_;
    }
    void on_equilibrium(const EquilibriumRecord& r, const State& s, const std::vector<double>& f) override {
        directory_.on_equilibrium(r, s, f);
    }

  private:
    RunDirectory& directory_;
    std::atomic<bool>& stop_;
    long at_step_;
};

/// Runs from the sample, or from the checkpoint of the folder; stops during arc `stop_at` (-1: never). Returns whether
/// it completed.
bool play(const fs::path& path, Mode mode, long stop_at, bool finish, double checkpoint_seconds = 0) {
    RunCounters counters;
    RunHeader head = header();
    head.checkpoint_seconds = checkpoint_seconds;
    RunDirectory directory(path, head, mode, counters);
    State state = read_state(scratch::data("vertex100.txt")).state;
    int made = 0;
    if (const auto& point = directory.checkpoint()) {
        state = point->state;
        counters = point->counters;
        made = point->made;
    }
    std::atomic<bool> stop{false};
    RunOptions options{.stop = &stop};
    Stopper stopper(directory, stop, stop_at);
    directory.begin_segment(0, towards(6), made, state.equilibrium);
    const SegmentOutcome outcome = run_segment(state, towards(6 - made), 0, options, counters, stopper);
    if (finish) {
        directory.finish(outcome.completed ? RunStatus::completed : RunStatus::interrupted, "");
    }
    return outcome.completed;
}

} // namespace

BOOST_FIXTURE_TEST_CASE(a_run_leaves_records_states_and_a_summary, scratch::InFolder) {
    BOOST_TEST(play(folder / "run", Mode::fresh, -1, true));
    const std::vector<EquilibriumRow> rows = read_equilibria(folder / "run/equilibria.csv");
    BOOST_REQUIRE_EQUAL(rows.size(), 7U);
    BOOST_TEST(rows[0].previous == -1);
    BOOST_TEST(rows[6].previous == 5);
    BOOST_TEST(rows[6].proved);
    for (const char* name : {"eq_000000", "eq_000002", "eq_000006", "last"}) {
        BOOST_TEST(fs::exists(folder / ("run/states/" + std::string(name) + ".json")), name);
    }
    BOOST_TEST(!fs::exists(folder / "run/states/eq_000001.json"));
    const StateFile last = read_state(folder / "run/states/last.json");
    BOOST_TEST(last.state.equilibrium == 6);
    BOOST_TEST(last.forces.size() == last.state.contacts.size());
    BOOST_TEST(last.state.load.stress[1] == rows[6].stress);
    BOOST_TEST(scratch::read(folder / "run/run.json").find("\"status\": \"completed\"") != std::string::npos);
    BOOST_TEST(scratch::read(folder / "run/summary.json").find("\"equilibria\": 6") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(columns_are_named_before_the_first_equilibrium) {
    for (const bool tilted : {false, true}) {
        const scratch::Folder folder;
        RunDirectory directory = opened(folder / "run", Mode::fresh);
        directory.store_start(tilted ? cells::one_tilted_disk(2, 1, 0.25)
                                     : read_state(scratch::data("vertex100.txt")).state);
        const std::string text = scratch::read(folder / "run/equilibria.csv");
        BOOST_TEST(text.starts_with("# "));
        BOOST_TEST(text.ends_with("\n"));
        BOOST_TEST((text.find(",eps3,") != std::string::npos) == tilted);
        BOOST_TEST(read_equilibria(folder / "run/equilibria.csv").empty());
    }
}

BOOST_AUTO_TEST_CASE(every_row_has_the_columns_that_the_first_line_names_whatever_its_record_has_besides) {
    const State state = cells::one_tilted_disk(2, 1, 0.25);
    EquilibriumRecord record;
    for (auto* three : {&record.strain, &record.length, &record.strain_bound, &record.length_bound}) {
        three->assign(3, 0.5);
    }
    record.touching = 7;
    const auto commas = [](const std::string& line) { return std::ranges::count(line, ','); };
    for (const bool tilt : {false, true}) {
        for (const bool touching : {false, true}) {
            const std::string header = equilibria_header({tilt, touching});
            const std::string row = equilibrium_row(record, state, -1, {tilt, touching});
            BOOST_TEST(commas(row) == commas(header));
            BOOST_TEST((row.find(",7,0.000\n") != std::string::npos) == touching);
            const MoreColumns named = named_columns(header + row, "table");
            BOOST_TEST((named.tilt == tilt && named.touching == touching));
            const scratch::Folder folder;
            RunHeader with = ::header();
            with.touching = touching;
            RunDirectory directory = opened(folder / "run", Mode::fresh, with);
            directory.store_start(tilt ? state : read_state(scratch::data("vertex100.txt")).state);
            BOOST_TEST(scratch::read(folder / "run/equilibria.csv") == header);
        }
    }
}

BOOST_AUTO_TEST_CASE(columns_of_spheres_go_by_axis) {
    constexpr std::array stress{"sigma1", "sigma2", "sigma3", "shear_xy", "shear_xz", "shear_yz"};
    constexpr std::array strain{"eps1", "eps2", "eps3", "eps_xy", "eps_xz", "eps_yz"};
    for (int loaded = 0; loaded < 6; ++loaded) {
        const MoreColumns more{true, loaded % 2 == 0, 3, loaded};
        const MoreColumns named = named_columns(equilibria_header(more), "table");
        BOOST_TEST((named.tilt && named.touching == more.touching && named.dimension == 3));
        BOOST_TEST(named.loaded_axis == loaded);
        const RecordColumns columns = record_columns(more);
        BOOST_TEST(columns.stress == stress[static_cast<std::size_t>(loaded)]);
        BOOST_TEST(columns.strain == strain[static_cast<std::size_t>(loaded)]);
        BOOST_TEST(columns.measures.size() == 6U);
        for (const std::string& name : equilibria_columns(more)) {
            BOOST_TEST(name.find(loaded == 1 ? "sigma3" : "sigma2") == std::string::npos, name);
        }
    }
}

BOOST_FIXTURE_TEST_CASE(every_row_of_equilibria_has_a_number_for_every_column, scratch::InFolder) {
    play(folder / "run", Mode::fresh, -1, true);
    std::vector<std::string> lines = scratch::lines_of(folder / "run/equilibria.csv");
    BOOST_TEST(lines[0].starts_with("# number,previous,"));
    BOOST_TEST(scratch::split(lines[0], ',').size() == equilibria_columns().size());
    lines.erase(lines.begin());
    for (const std::string& line : lines) {
        const std::vector<std::string> fields = scratch::split(line, ',');
        BOOST_TEST(fields.size() == equilibria_columns().size());
        for (const std::string& field : fields) {
            std::size_t used = 0;
            BOOST_CHECK_NO_THROW((void)std::stod(field, &used));
            BOOST_TEST(used == field.size(), field);
        }
    }
}

BOOST_FIXTURE_TEST_CASE(numbers_of_a_table_of_equilibria_are_finite_and_its_integers_written_as_such,
                        scratch::InFolder) {
    play(folder / "run", Mode::fresh, -1, true);
    const fs::path file = folder / "run/equilibria.csv";
    const std::string text = scratch::read(file);
    const std::vector<std::string> names = equilibria_columns();
    /// The last row with a word in one column.
    const auto altered = [&](const std::string& name, const std::string& word) {
        std::size_t begin = text.rfind('\n', text.size() - 2) + 1;
        for (auto at = names.begin(); *at != name; ++at) {
            begin = text.find(',', begin) + 1;
        }
        scratch::write(file, text.substr(0, begin) + word + text.substr(text.find(',', begin)));
    };
    for (const char* name : {"sigma2", "ratio", "eps1", "eps2", "solid_fraction", "sigma2_high", "margin"}) {
        for (const char* word : {"nan", "1e301", "-1e400", "0x1p3", "1,5", "", "one"}) {
            altered(name, word);
            expect_bad_input([&] { (void)read_equilibria(file); }, {"equilibria.csv:8"});
        }
        altered(name, "inf");
        if (name == std::string("sigma2_high") || name == std::string("margin")) {
            BOOST_TEST(read_equilibria(file).size() == 7U);
        } else {
            expect_bad_input([&] { (void)read_equilibria(file); }, {name, "'inf'", "a finite number"});
        }
    }
    scratch::write(file, text + "\n");
    expect_bad_input([&] { (void)read_equilibria(file); }, {"equilibria.csv:9", "1 columns"});
    for (const char* name : {"number", "previous", "segment", "arcs", "rattlers", "backbone", "h", "proved"}) {
        for (const char* word : {"4.9", "4.0", "-0", "+4", "04", "1e1", "1e99", "2147483648", "-2", "nan"}) {
            altered(name, word);
            expect_bad_input([&] { (void)read_equilibria(file); }, {name, word, "an integer"});
        }
    }
}

BOOST_FIXTURE_TEST_CASE(an_interrupted_run_goes_on_to_the_same_files, scratch::InFolder) {
    BOOST_REQUIRE(play(folder / "whole", Mode::fresh, -1, true));
    // Arc 9 is inside the rearrangement of 7 arcs that leads to equilibrium 3; 1 is before the first equilibrium after
    // the start.
    for (const long stop_at : {1L, 9L, 14L}) {
        for (const bool finish : {true, false}) {
            BOOST_TEST_INFO_SCOPE("stopped at arc " << stop_at << (finish ? "" : ", killed"));
            const fs::path path = folder / ("cut" + std::to_string(stop_at) + (finish ? "f" : "k"));
            BOOST_TEST(!play(path, Mode::fresh, stop_at, finish));
            BOOST_TEST(scratch::read(path / "events.jsonl") != scratch::read(folder / "whole/events.jsonl"));
            BOOST_TEST(play(path, Mode::resume, -1, true));
            BOOST_TEST(scratch::read(path / "events.jsonl") == scratch::read(folder / "whole/events.jsonl"));
            BOOST_TEST(scratch::without_times(scratch::read(path / "equilibria.csv")) ==
                       scratch::without_times(scratch::read(folder / "whole/equilibria.csv")));
            for (const char* name : {"eq_000000.json", "eq_000002.json", "eq_000006.json", "last.json"}) {
                BOOST_TEST((scratch::read(path / "states" / name) == scratch::read(folder / "whole/states" / name)),
                           name);
            }
        }
    }
}

BOOST_FIXTURE_TEST_CASE(checkpoints_that_are_further_apart_lose_time_but_no_record, scratch::InFolder) {
    BOOST_REQUIRE(play(folder / "whole", Mode::fresh, -1, true));
    for (const bool finish : {true, false}) {
        const fs::path path = folder / (finish ? "finished" : "killed");
        BOOST_TEST(!play(path, Mode::fresh, 14, finish, 1000));
        {
            const RunDirectory directory = opened(path, Mode::resume);
            BOOST_REQUIRE(directory.checkpoint().has_value());
            // The first one comes at once; a run that ends in order writes the last one.
            BOOST_TEST(directory.checkpoint()->state.equilibrium == (finish ? 5 : 1));
        }
        BOOST_TEST(play(path, Mode::resume, -1, true));
        BOOST_TEST(scratch::read(path / "events.jsonl") == scratch::read(folder / "whole/events.jsonl"));
    }
}

BOOST_FIXTURE_TEST_CASE(a_record_cut_in_the_middle_by_a_kill_is_dropped, scratch::InFolder) {
    BOOST_REQUIRE(play(folder / "whole", Mode::fresh, -1, true));
    BOOST_REQUIRE(!play(folder / "cut", Mode::fresh, 9, false));
    std::ofstream(folder / "cut/events.jsonl", std::ios::app) << "{\"step\":10,\"equili";
    std::ofstream(folder / "cut/equilibria.csv", std::ios::app) << "3,2,0,1.05";
    BOOST_TEST(read_equilibria(folder / "cut/equilibria.csv").size() == 3U);
    BOOST_TEST(play(folder / "cut", Mode::resume, -1, true));
    BOOST_TEST(scratch::read(folder / "cut/events.jsonl") == scratch::read(folder / "whole/events.jsonl"));
}

BOOST_FIXTURE_TEST_CASE(two_runs_in_one_folder_are_refused, scratch::InFolder) {
    const RunDirectory first = opened(folder / "run", Mode::fresh);
    for (const auto mode : {Mode::fresh, Mode::force, Mode::resume}) {
        expect_error([&] { (void)opened(folder / "run", mode); }, ErrorKind::cannot_write,
                     {"run", "another running program"});
    }
}

BOOST_FIXTURE_TEST_CASE(a_folder_that_holds_a_run_is_kept_unless_told_otherwise, scratch::InFolder) {
    play(folder / "run", Mode::fresh, -1, true);
    const std::string events = scratch::read(folder / "run/events.jsonl");
    expect_error([&] { (void)opened(folder / "run", Mode::fresh); }, ErrorKind::usage,
                 {"holds a run already", "--resume", "--force"});
    BOOST_TEST(scratch::read(folder / "run/events.jsonl") == events);
    const RunDirectory forced = opened(folder / "run", Mode::force);
    BOOST_TEST(scratch::read(folder / "run/events.jsonl").empty());
    BOOST_TEST(!fs::exists(folder / "run/summary.json"));
    BOOST_TEST(!fs::exists(folder / "run/states/last.json"));
}

BOOST_FIXTURE_TEST_CASE(resuming_something_else_is_refused, scratch::InFolder) {
    expect_bad_input([&] { (void)opened(folder / "none", Mode::resume); }, {"run.json", "no run to resume"});
    BOOST_REQUIRE(!play(folder / "run", Mode::fresh, 9, false));
    RunHeader other = header();
    other.scene_text = "another";
    expect_bad_input([&] { (void)opened(folder / "run", Mode::resume, other); }, {"run.json", "another scene"});
    other = header();
    other.program = "isostat 99";
    expect_bad_input([&] { (void)opened(folder / "run", Mode::resume, other); }, {"isostat test", "isostat 99"});
    const std::string checkpoint = scratch::read(folder / "run/checkpoint.json");
    scratch::write(folder / "run/checkpoint.json", checkpoint.substr(0, checkpoint.size() / 2));
    expect_bad_input([&] { (void)opened(folder / "run", Mode::resume); }, {"checkpoint.json", "truncated"});
    scratch::write(folder / "run/checkpoint.json", checkpoint);
    scratch::write(folder / "run/events.jsonl", "");
    expect_bad_input([&] { (void)opened(folder / "run", Mode::resume); }, {"events.jsonl", "0 bytes"});
}

BOOST_FIXTURE_TEST_CASE(a_killed_run_has_no_summary_and_says_running, scratch::InFolder) {
    BOOST_REQUIRE(!play(folder / "run", Mode::fresh, 9, false));
    BOOST_TEST(!fs::exists(folder / "run/summary.json"));
    BOOST_TEST(scratch::read(folder / "run/run.json").find("\"status\": \"running\"") != std::string::npos);
}

BOOST_FIXTURE_TEST_CASE(a_run_that_was_killed_before_it_wrote_anything_is_begun_by_resume, scratch::InFolder) {
    scratch::write(folder / "lock", "");
    scratch::write(folder / "run.json.part", "{");
    {
        const RunDirectory directory = opened(folder.path(), Mode::resume);
        BOOST_TEST(directory.previous_status() == "killed before it began");
        BOOST_TEST(!directory.checkpoint().has_value());
        BOOST_TEST(!directory.start().has_value());
        BOOST_TEST(fs::exists(folder / "run.json"));
    }
    const scratch::Folder other;
    scratch::write(other / "lock", "");
    scratch::write(other / "notes.txt", "mine");
    BOOST_CHECK_THROW(opened(other.path(), Mode::resume), Error);
    const scratch::Folder empty;
    for (int again = 0; again < 2; ++again) { // a refusal leaves nothing that looks like a run
        BOOST_CHECK_THROW(opened(empty.path(), Mode::resume), Error);
        BOOST_TEST(fs::is_empty(empty.path()));
        BOOST_CHECK_THROW(opened(empty / "none", Mode::resume), Error);
    }
}
