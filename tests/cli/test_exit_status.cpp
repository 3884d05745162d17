// What an exit status means: an internal failure and an answer that did not get out are no answers. No input crashes a
// command.
#include "cli/program.hpp"
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>

using namespace program;
namespace fs = std::filesystem;

namespace {

const std::string vertex = scratch::data("vertex100.txt");
const std::string packing = ISOSTAT_EXAMPLES "/packings/two_disks.toml";

/// `run`, with standard output to another place.
int status_with_output_to(const std::string& place, const Arguments& arguments) {
    std::string line = quoted(ISOSTAT_PROGRAM);
    for (const std::string& argument : arguments) {
        line += " " + quoted(argument);
    }
    const int status = std::system((line + " >" + place + " 2>/dev/null </dev/null").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// A scene with a short run from the sample of 100 disks.
fs::path small_scene(const scratch::Folder& folder) {
    scratch::write_scene(folder / "s.toml", scene_from(vertex, up(1)));
    return folder / "s.toml";
}

} // namespace

BOOST_FIXTURE_TEST_CASE(an_answer_that_does_not_get_out_is_74_for_every_command, scratch::InFolder) {
    const std::string scene = small_scene(folder).string();
    const std::string cert = folder.at("c.json"), done_run = folder.at("done");
    expect(run({"certify", vertex, "-o", cert}), 0);
    expect(run({"run", scene, "-o", done_run, "-q"}), 0);
    const std::vector<Arguments> commands{
        {"--version"},
        {"--help"},
        {"inspect", vertex},
        {"inspect", packing},
        {"inspect", vertex, "--json"},
        {"certify", vertex, "-o", folder.at("d.json")},
        {"verify", cert},
        {"verify", done_run},
        {"plan", scene},
        {"import", vertex, "-o", folder.at("v.json")},
        {"plateau", vertex, "--thresholds", "1e-9:1e-8"},
        {"genericity", packing, "--samples", "1"},
        {"report", done_run, "--no-charts"},
        {"run", scene, "-o", folder.at("run")},
        {"run", scene, "-o", folder.at("run2"), "--json"},
    };
    for (const Arguments& command : commands) {
        BOOST_TEST(status_with_output_to("/dev/full", command) == 74, command[0]);
    }
    BOOST_TEST(status_with_output_to("/dev/null", {"inspect", vertex}) == 0);
}

BOOST_FIXTURE_TEST_CASE(names_of_files_may_be_any_bytes, scratch::InFolder) {
    const std::string bad = folder.at("bad\xff.json");
    fs::copy(vertex, bad);
    for (const Arguments& command : std::vector<Arguments>{
             {"inspect", bad, "--json"},
             {"certify", bad, "-o", folder.at("\xfe.cert"), "--json"},
             {"verify", folder.at("\xfe.cert"), "--input", bad, "--json"},
             {"import", bad, "-o", folder.at("out\xff"), "--json"},
             {"plateau", bad, "--json", "--thresholds", "1e-9:1e-8"},
             {"report", bad, "-o", folder.at("fig\xff"), "--json", "--no-charts"},
         }) {
        const Outcome outcome = done(run(command));
        BOOST_TEST(contains(outcome.out, "\xEF\xBF\xBD"), command[0]); // U+FFFD stands for the byte
    }
    const std::string scene = folder.at("s\xff.toml");
    fs::copy(small_scene(folder), scene);
    const std::string out = folder.at("run\xff");
    expect(run({"run", scene, "-o", out, "-q"}), 0);
    expect(run({"run", scene, "-o", out, "--resume", "--json"}), 0);
    expect(run({"plan", scene, "--json"}), 0);
    expect(run({"report", out, "--no-charts", "--json"}), 0);
    expect(run({"verify", out, "--json"}), 0);
    expect(run({"inspect", folder.at("absent\xff")}), 65, {"absent\\xff:"});
}

BOOST_FIXTURE_TEST_CASE(nesting_without_end_is_bad_input_for_every_command, scratch::InFolder) {
    const std::string deep =
        folder.file("deep.json", "{\"format\":" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
    for (const Arguments& command : std::vector<Arguments>{
             {"inspect", deep},
             {"certify", deep, "-o", folder.at("c.json")},
             {"import", deep, "-o", folder.at("o.json")},
             {"plateau", deep},
             {"genericity", deep},
             {"report", deep, "-o", folder.path().string()},
             {"verify", deep},
         }) {
        expect(run(command), 65, {"deep.json", "64"});
    }
    std::string dotted = "a";
    for (int k = 1; k < 100'000; ++k) {
        dotted += ".a";
    }
    scratch::write(folder / "dotted.toml", dotted + " = 1\n");
    for (const std::string command : {"plan", "inspect"}) {
        expect(run({command, folder.at("dotted.toml")}), 65, {"dotted.toml:1:", "64 parts"});
    }
}

BOOST_FIXTURE_TEST_CASE(sizes_beyond_the_arithmetic_are_bad_input_and_sizes_at_its_ends_are_answered,
                        scratch::InFolder) {
    const auto prepared = [&](const std::string& diameters) {
        return run({"prepare", folder.file("p.toml", "[packing]\ndisks = 8\ndiameters = " + diameters + "\nseed = 2\n"),
                    "-o", folder.at("p.json"), "-q"});
    };
    expect(prepared("[1e-200, 1e200]"), 65, {"p.toml:3", "diameters", "1e+140"});
    for (const char* diameters : {"[1e-140, 1e140]", "[1.0, 1e100]", "[1e-140, 2e-140]", "[5e139, 1e140]"}) {
        const Outcome outcome = prepared(diameters);
        BOOST_TEST((outcome.status == 0 || outcome.status == 1 || outcome.status == 2),
                   diameters << ": " << outcome.status << ": " << outcome.err);
    }
}

BOOST_FIXTURE_TEST_CASE(a_packing_in_which_nothing_can_move_is_answered_by_every_command, scratch::InFolder) {
    isostat::State state = crafted::one_disk(1, 1);
    state.packing.fixed = {1};
    state.packing.walls.upper.fill(isostat::WallKind::fixed);
    state.contacts.clear();
    const std::string file = folder.file("still.json", state_text(state));
    says(run({"inspect", file}), 1, {"no degrees of freedom"});
    expect(run({"certify", file, "-o", folder.at("c.json")}), 1);
    expect(run({"report", file, "-o", folder.path().string(), "--no-charts"}), 0);
    scratch::write(folder / "s.toml", scene_from("still.json", up(6)));
    for (const Arguments& command :
         std::vector<Arguments>{{"run", folder.at("s.toml"), "-o", folder.at("out")}, {"plan", folder.at("s.toml")}}) {
        expect(run(command), 65, {"still.json", "no degrees of freedom"});
    }
    BOOST_TEST(!fs::exists(folder / "out"));
}

BOOST_FIXTURE_TEST_CASE(where_memory_allows_few_threads_the_records_are_the_same, scratch::InFolder) {
    const std::string scene = small_scene(folder).string();
    expect(run({"run", scene, "-o", folder.at("one"), "-q", "--threads", "1"}), 0);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) // they take terabytes of addresses
    expect(run({"run", scene, "-o", folder.at("few"), "-q", "--threads", "64"}, "ulimit -v 400000; "), 0);
    BOOST_TEST((scratch::read(folder / "one/events.jsonl") == scratch::read(folder / "few/events.jsonl")));
#endif
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
BOOST_AUTO_TEST_CASE(a_library_that_changed_the_rounding_is_an_internal_failure) {
    const std::string before = "LD_PRELOAD=" + quoted(ISOSTAT_ROUND_UP) + " ";
    for (const Arguments& command : std::vector<Arguments>{
             {"inspect", vertex}, {"inspect", packing}, {"plateau", vertex, "--thresholds", "1e-9:1e-8"}}) {
        expect(run(command, before), 70, {"rounded to nearest"});
    }
}

BOOST_FIXTURE_TEST_CASE(whatever_memory_there_is_a_command_answers_or_says_that_it_does_not_suffice,
                        scratch::InFolder) {
    const std::string out = folder.at("out");
    expect(run({"run", small_scene(folder).string(), "-o", out, "-q"}), 0);
    for (const char* limit : {"ulimit -v 400000; ", "ulimit -v 250000; ", "ulimit -v 200000; "}) {
        for (const Arguments& command : std::vector<Arguments>{{"verify", out, "-q"}, {"inspect", vertex}}) {
            Arguments many = command;
            many.insert(many.end(), {"--threads", "64"});
            const Outcome found = run(many, limit);
            const bool says = found.status == 70 && found.err.find("not enough memory") != std::string::npos;
            BOOST_TEST((found.status == 0 || says), limit << command[0] << ": " << found.status << " " << found.err);
        }
    }
}

BOOST_FIXTURE_TEST_CASE(memory_that_does_not_suffice_is_an_internal_failure, scratch::InFolder) {
    std::string table = "x y r\n";
    for (int k = 0; k < 400'000; ++k) {
        table += std::to_string(k % 1000) + ".25 " + std::to_string(k / 1000) + ".5 0.5\n";
    }
    expect(run({"plateau", folder.file("t.txt", table)}, "ulimit -v 80000; "), 70, {"not enough memory"});
}
#endif
