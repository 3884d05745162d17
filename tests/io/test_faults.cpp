// Damaged folders: a resume says which file is wrong and changes nothing; a disk without room loses no record.
#include "io/record_digests.hpp"
#include "support/bad_input.hpp"
#include "support/scratch.hpp"
#include "support/segments.hpp"

#include <isostat/io/run_directory.hpp>
#include <isostat/io/state_file.hpp>

#include <sys/resource.h>

#include <csignal>

using namespace isostat;
namespace fs = std::filesystem;

namespace {

constexpr int goal = 6;

RunHeader faulty_header() {
    RunHeader h;
    h.program = "isostat test";
    h.scene_text = "text";
    h.keep = {2};
    h.checkpoint_seconds = 0;
    return h;
}

/// Runs until `equilibria` have been made in all, as if killed then; to the end when they are `goal`.
void play(const fs::path& path, RunDirectory::Mode mode, int equilibria) {
    RunCounters counters;
    RunDirectory directory(path, faulty_header(), mode, counters);
    State state = read_state(scratch::data("vertex100.txt")).state;
    int made = 0;
    if (const auto& point = directory.checkpoint()) {
        state = point->state;
        counters = point->counters;
        made = point->made;
    } else {
        directory.store_start(state);
    }
    const Segment part = towards(equilibria - made);
    directory.begin_segment(0, towards(goal), made, state.equilibrium);
    BOOST_REQUIRE(run_segment(state, part, 0, RunOptions(), counters, directory).completed);
    if (equilibria == goal) {
        directory.finish(RunStatus::completed, "");
    }
}

std::map<std::string, std::string> content(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files[fs::relative(entry.path(), folder).string()] = scratch::read(entry.path());
        }
    }
    return files;
}

void restore(const fs::path& folder, const std::map<std::string, std::string>& files) {
    for (const auto& [name, text] : files) {
        scratch::write(folder / name, text);
    }
}

/// A run killed after four equilibria, and a whole one.
struct Killed {
    scratch::Folder folder;
    fs::path run = folder / "run";
    std::map<std::string, std::string> files;
    Killed() {
        play(run, RunDirectory::Mode::fresh, 4);
        files = content(run);
    }
    /// A resume is refused, names the file, and leaves every byte.
    void refused(const std::string& name) {
        const auto damaged = content(run);
        expect_bad_input([&] { play(run, RunDirectory::Mode::resume, goal); }, {name});
        BOOST_TEST((content(run) == damaged), name);
        restore(run, files);
    }
};

const std::vector<std::string> needed{"checkpoint.json", "events.jsonl",          "equilibria.csv",
                                      "start.json",      "states/eq_000000.json", "states/eq_000002.json"};

} // namespace

BOOST_FIXTURE_TEST_CASE(a_flipped_bit_in_any_file_that_a_resume_needs_is_found, Killed) {
    std::mt19937 random(4);
    for (const std::string& name : needed) {
        for (int k = 0; k < 12; ++k) {
            std::string text = files.at(name);
            const std::size_t at = random() % text.size();
            text[at] = static_cast<char>(text[at] ^ (1 << (random() % 7)));
            scratch::write(run / name, text);
            BOOST_TEST_INFO_SCOPE(name << " byte " << at);
            refused(name);
        }
    }
    play(run, RunDirectory::Mode::resume, goal); // restored, it goes on
    play(folder / "whole", RunDirectory::Mode::fresh, goal);
    BOOST_TEST(scratch::read(run / "events.jsonl") == scratch::read(folder / "whole/events.jsonl"));
}

BOOST_FIXTURE_TEST_CASE(a_changed_number_in_a_record_or_in_a_state_is_found, Killed) {
    // Well-formed files that say something else.
    for (const std::string& name : needed) {
        std::string text = files.at(name);
        const std::size_t at = text.find_last_of("12345678");
        BOOST_REQUIRE(at != std::string::npos);
        text[at] = static_cast<char>(text[at] + 1);
        scratch::write(run / name, text);
        refused(name);
    }
}

BOOST_FIXTURE_TEST_CASE(a_file_cut_short_or_missing_is_found, Killed) {
    for (const std::string& name : needed) {
        const std::string& text = files.at(name);
        for (const std::size_t length : {std::size_t{0}, text.size() / 3, text.size() - 2}) {
            scratch::write(run / name, text.substr(0, length));
            refused(name);
        }
        if (name != "checkpoint.json") { // without it a run starts again from its start
            fs::remove(run / name);
            const auto damaged = content(run);
            BOOST_CHECK_THROW(play(run, RunDirectory::Mode::resume, goal), Error);
            auto after = content(run);
            after.erase("events.jsonl"); // may be made, empty
            after.erase("equilibria.csv");
            for (const auto& [other, bytes] : after) {
                BOOST_TEST((damaged.at(other) == bytes), other);
            }
            restore(run, files);
        }
    }
}

/// A checkpoint that is signed again, with something else in one of its fields.
void forge_checkpoint(const fs::path& run, const std::string& from, const std::string& to) {
    const std::string old = scratch::read(run / "checkpoint.json");
    std::string text = scratch::replaced(old.substr(0, old.rfind(before_digest)), from, to);
    BOOST_REQUIRE(text != old.substr(0, old.rfind(before_digest)));
    scratch::write(run / "checkpoint.json", text + before_digest + '"' + sha256(text) + "\"}\n");
}

BOOST_FIXTURE_TEST_CASE(a_checkpoint_names_no_file_but_those_of_its_run, Killed) {
    scratch::write(folder / "thesis.txt", "precious");
    scratch::write(run / "notes.txt", "precious");
    for (const std::string& name :
         {std::string("../thesis.txt"), folder.at("thesis.txt"), std::string("notes.txt"),
          std::string("states/../events.jsonl"), std::string("run.json"), std::string("start.json")}) {
        forge_checkpoint(run, "\"bytes\":{", "\"bytes\":{\"" + name + "\":0,");
        forge_checkpoint(run, "\"digests\":{", "\"digests\":{\"" + name + "\":\"\",");
        refused("checkpoint.json: bytes." + name);
    }
    for (const std::string name : {"../thesis.txt", "states/last.json", "events.jsonl", "states/eq_1.json"}) {
        forge_checkpoint(run, "\"files\":{", "\"files\":{\"" + name + "\":\"\",");
        refused("checkpoint.json: files." + name);
    }
    BOOST_TEST(scratch::read(folder / "thesis.txt") == "precious");
    BOOST_TEST(scratch::read(run / "notes.txt") == "precious");
}

BOOST_FIXTURE_TEST_CASE(a_checkpoint_has_a_strain_for_each_axis_and_a_segment_of_the_run, Killed) {
    const std::string text = files.at("checkpoint.json");
    const std::size_t begin = text.find("\"strain\":[");
    const std::string strain = text.substr(begin, text.find(']', begin) + 1 - begin);
    for (const char* other : {"\"strain\":[]", "\"strain\":[0.5]", "\"strain\":[0,0,0]", "\"strain\":[0,null]"}) {
        forge_checkpoint(run, strain, other);
        refused("checkpoint.json: strain");
    }
    forge_checkpoint(run, "\"segment\":0", "\"segment\":7");
    refused("checkpoint.json: segment");
}

BOOST_FIXTURE_TEST_CASE(no_link_leads_out_of_the_folder_of_a_run, Killed) {
    for (const std::string& name : needed) {
        fs::rename(run / name, folder / "elsewhere");
        fs::create_symlink(folder / "elsewhere", run / name);
        expect_bad_input([&] { play(run, RunDirectory::Mode::resume, goal); }, {name, "no link"});
        const RunCounters counters;
        expect_error([&] { const RunDirectory forced(run, faulty_header(), RunDirectory::Mode::force, counters); },
                     ErrorKind::usage, {name, "no link"});
        BOOST_TEST(scratch::read(folder / "elsewhere") == files.at(name));
        fs::remove(run / name);
        fs::rename(folder / "elsewhere", run / name);
    }
    fs::rename(run / "states", folder / "states");
    fs::create_directory_symlink(folder / "states", run / "states");
    expect_bad_input([&] { play(run, RunDirectory::Mode::resume, goal); }, {"states", "no link"});
}

BOOST_FIXTURE_TEST_CASE(what_a_kill_left_is_removed_by_a_resume_and_what_others_put_there_stays, Killed) {
    const std::vector<std::string> left{"preparation_failed.json", "checkpoint.json.0123456789abcdef.part",
                                        "states/last.json.fedcba9876543210.part", "run.json.part"};
    const std::vector<std::string> of_others{"notes.txt", "states/notes.json", "notes.txt.0123456789abcdef.part",
                                             "states/eq_7.json"};
    for (const std::string& name : left) {
        scratch::write(run / name, "left");
    }
    for (const std::string& name : of_others) {
        scratch::write(run / name, "mine");
    }
    const RunCounters counters;
    {
        const RunDirectory directory(run, faulty_header(), RunDirectory::Mode::resume, counters);
        BOOST_TEST(directory.notes().size() == of_others.size());
    }
    for (const std::string& name : left) {
        BOOST_TEST(!fs::exists(run / name), name);
    }
    const RunDirectory forced(run, faulty_header(), RunDirectory::Mode::force, counters);
    for (const std::string& name : of_others) {
        BOOST_TEST(scratch::read(run / name) == "mine", name);
    }
    for (const std::string name : {"states/eq_000000.json", "checkpoint.json", "start.json"}) {
        BOOST_TEST(!fs::exists(run / name), name);
    }
}

BOOST_FIXTURE_TEST_CASE(a_run_that_met_a_limit_of_the_file_size_goes_on_to_the_same_records, scratch::InFolder) {
    play(folder / "whole", RunDirectory::Mode::fresh, goal);
    const auto size = static_cast<rlim_t>(fs::file_size(folder / "whole/events.jsonl"));
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit old{};
    BOOST_REQUIRE(::getrlimit(RLIMIT_FSIZE, &old) == 0);
    int met = 0;
    // From a limit that lets not even the start be written to one that only the last event meets.
    for (const rlim_t limit : {rlim_t{100}, size / 2, size - 1}) {
        const fs::path run = folder / ("run" + std::to_string(limit));
        rlimit low = old;
        low.rlim_cur = limit;
        BOOST_REQUIRE(::setrlimit(RLIMIT_FSIZE, &low) == 0);
        try {
            play(run, RunDirectory::Mode::fresh, goal);
        } catch (const Error& error) {
            ++met;
            BOOST_TEST((error.kind() == ErrorKind::cannot_write), error.what());
        }
        BOOST_REQUIRE(::setrlimit(RLIMIT_FSIZE, &old) == 0);
        const bool begun = fs::exists(run / "run.json");
        play(run, begun ? RunDirectory::Mode::resume : RunDirectory::Mode::fresh, goal);
        BOOST_TEST(scratch::read(run / "events.jsonl") == scratch::read(folder / "whole/events.jsonl"));
        BOOST_TEST(scratch::without_times(scratch::read(run / "equilibria.csv")) ==
                   scratch::without_times(scratch::read(folder / "whole/equilibria.csv")));
    }
    BOOST_TEST(met >= 2);
    std::signal(SIGXFSZ, handler);
}
