// Every bad input: the exit status, a message with file, line or field, value and expectation, and nothing left that
// looks complete.
// Numbers on the command line: finite, all of their word, in their range.
#include "cli/program.hpp"
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>

using namespace program;
using isostat::state_text;
using scratch::replaced;
namespace fs = std::filesystem;

namespace {

/// A scene whose start file has a given content; `run` must refuse it before it makes a folder.
void run_refuses(const std::string& start, const Arguments& words) {
    const scratch::Folder folder;
    scratch::write(folder / "start.json", start);
    scratch::write(folder / "s.toml", scene_from("start.json", up(6)));
    const Outcome outcome = run({"run", folder.at("s.toml"), "-o", folder.at("run"), "-q"});
    expect(outcome, 65, plus(words, {"start.json"}));
    BOOST_TEST(!fs::exists(folder / "run"));
    BOOST_TEST(outcome.out.empty());
}

/// A scene that every command must refuse.
void scene_refused(const std::string& scene, const Arguments& words) {
    const scratch::Folder folder;
    scratch::write_scene(folder / "s.toml", scene);
    for (const std::string command : {"run", "prepare"}) {
        expect(run({command, folder.at("s.toml"), "-o", folder.at("out")}), 65, plus(words, {"s.toml"}));
        BOOST_TEST(!fs::exists(folder / "out"));
    }
    expect(run({"plan", folder.at("s.toml")}), 65, words);
}

const std::string two = state_text(crafted::two_disks(1, 2, 1, 1));

struct Called {
    const scratch::Folder folder;
    std::string state = folder.at("state.json"), out = folder.at("out");
    Called() { scratch::write(state, isostat::state_text(::crafted::two_disks(1, 2, 1, 1), {})); }
    /// Each option with the words that its command needs besides.
    [[nodiscard]] std::vector<Arguments> with_numbers() const {
        return {{"inspect", state, "--at"},
                {"report", out, "--stiffness"},
                {"snap", state, "-o", out, "--stiffness"},
                {"import", state, "-o", out, "--jitter"},
                {"import", state, "-o", out, "--threshold"},
                {"genericity", state, "--stress"},
                {"genericity", state, "--size"}};
    }
    [[nodiscard]] std::vector<Arguments> with_integers() const {
        return {{"inspect", state, "--threads"},
                {"ensemble", state, "-o", out, "--samples"},
                {"ensemble", state, "-o", out, "--samples", "1", "--jobs"},
                {"ensemble", state, "-o", out, "--samples", "1", "--first-seed"},
                {"import", state, "-o", out, "--seed"},
                {"snap", state, "-o", out, "--seed"},
                {"genericity", state, "--seed"},
                {"genericity", state, "--samples"},
                {"genericity", state, "--lists"},
                {"plateau", state, "--rows"},
                {"compare", state, "--bundle"},
                {"compare", state, "--frames"},
                {"plateau", state, "--frame"}};
    }
};

void refuses(Arguments call, const std::string& word) {
    const std::string option = call.back();
    call.back() += "=" + word;
    const Outcome outcome = run(call);
    BOOST_TEST(outcome.status == 64, option << " " << word << ": " << outcome.status << " " << outcome.err);
    BOOST_TEST(contains(outcome.err, option), outcome.err);
}

} // namespace

BOOST_FIXTURE_TEST_CASE(overlapping_disks, scratch::InFolder) {
    isostat::State state = crafted::two_disks(1, 2, 1, 1);
    state.packing.q[2] -= 0.5;
    run_refuses(state_text(state), {"overlap", "0-1", "-0.4659", "expected every gap >= 0"});
    expect(run({"inspect", folder.file("s.json", state_text(state))}),
           2); // no true configuration has these contacts near: nothing is proved
}

BOOST_AUTO_TEST_CASE(radii_that_are_not_positive_numbers) {
    run_refuses(replaced(two, "[1.0,1.0,1.0]", "[1.0,1.0,0.0]"), {"disks[0][2]", "0.0", "positive"});
    run_refuses(replaced(two, "[1.0,1.0,1.0]", "[1.0,1.0,-1.0]"), {"disks[0][2]", "-1.0", "positive"});
    run_refuses(replaced(two, "[1.0,1.0,1.0]", "[1.0,1.0,NaN]"), {"start.json:", "JSON"});
    run_refuses("1\nnan 1 1 0 0\n", {":2:", "radius of disk 0", "nan", "finite"});
    run_refuses("1\n-3 1 1 0 0\n", {":2:", "radius of disk 0", "-3", "positive"});
    scene_refused("[packing]\nradii = [1.0, nan]\n", {":2:", "radii[1]", "nan", "finite"});
    scene_refused("[packing]\nradii = [1.0, 0.0]\n", {":2:", "radii[1]", "0", "positive"});
}

BOOST_AUTO_TEST_CASE(unknown_keys) {
    scene_refused("[packing]\ndisks = 4\nsede = 1\n" + up(6), {":3:", "unknown key 'sede'", "seed"});
    scene_refused("[packing]\ndisks = 4\n[lode]\n", {":3:", "'lode'", "load"});
    run_refuses(replaced(two, "\"length\"", "\"lenght\""), {"unknown field 'lenght'", "length"});
}

BOOST_FIXTURE_TEST_CASE(empty_files, scratch::InFolder) {
    run_refuses("", {"empty"});
    scene_refused("", {"empty"});
    scratch::write(folder / "e.json", "");
    expect(run({"inspect", folder.at("e.json")}), 65, {"e.json", "empty"});
    expect(run({"import", folder.at("e.json"), "-o", folder.at("o.json")}), 65, {"e.json", "empty"});
    expect(run({"report", folder.at("e.json")}), 65, {"e.json", "empty"});
    BOOST_TEST(!fs::exists(folder / "o.json"));
    expect(run({"inspect", folder.at("absent.json")}), 65, {"absent.json", "No such file"});
    expect(run({"report", folder.path().string()}), 65, {"run.json", "folder of a run"});
}

BOOST_AUTO_TEST_CASE(truncated_states) {
    run_refuses(two.substr(0, two.size() / 2), {"start.json:", "truncated"});
    const std::string sample = scratch::read(scratch::data("vertex100.txt"));
    run_refuses(sample.substr(0, sample.find('\n', sample.size() / 2)), {"start.json:", "ends here", "expected"});
}

BOOST_AUTO_TEST_CASE(a_start_with_self_stresses) {
    run_refuses(state_text(crafted::square_lattice(3)), {"N_f = 20", "N = 24", "rank 20", "h = 4", "k = 0", "N = N_f"});
}

BOOST_AUTO_TEST_CASE(disks_larger_than_the_box) {
    run_refuses(replaced(two, "[1.0,1.0,1.0]", "[1.0,1.0,50.0]"), {"disk 0", "100", "larger than the box"});
}

BOOST_FIXTURE_TEST_CASE(folders_that_cannot_be_written, scratch::InFolder) {
    scratch::write(folder / "plain", "a file");
    scratch::write_scene(folder / "s.toml", scene_from(scratch::data("vertex100.txt"), up(6)));
    scratch::write(folder / "p.toml", "[packing]\ndisks = 2000\n"); // would take a while: it must be refused before
    const std::string below = folder.at("plain/below");
    expect(run({"run", folder.at("s.toml"), "-o", below, "-q"}), 74, {"plain/below", "cannot write"});
    expect(run({"run", folder.at("s.toml"), "-o", folder.at("plain"), "-q"}), 74, {"plain", "cannot write"});
    expect(run({"prepare", folder.at("p.toml"), "-o", below, "-q"}), 74, {"plain/below", "cannot write"});
    expect(run({"prepare", folder.at("p.toml"), "-o", folder.at("no/p.json"), "-q"}), 74,
           {"no/p.json", "cannot write"});
    expect(run({"import", scratch::data("vertex100.txt"), "-o", below}), 74, {"plain/below", "cannot write"});
    expect(run({"report", scratch::data("vertex100.txt"), "-o", below}), 74, {"plain/below", "cannot write"});
    BOOST_TEST(scratch::read(folder / "plain") == "a file");
    BOOST_TEST(!fs::exists(folder / "no"));
}

BOOST_FIXTURE_TEST_CASE(contradictory_programmes, scratch::InFolder) {
    const std::string packing = "[packing]\ndisks = 4\n";
    scene_refused(packing + "[[programme]]\ndo = \"up\"\n", {":3:", "no end"});
    scene_refused(packing + "[[programme]]\ndo = \"up\"\nto = 0.5\n",
                  {":3:", "0.5", "ratio at its start is 1", "larger"});
    scene_refused(packing + up(6) + "[[programme]]\ndo = \"down\"\nfrom = 7\nto = 1.0\n",
                  {":6:", "equilibrium 7", "number 6"});
    scratch::write(folder / "s.toml", packing);
    expect(run({"run", folder.at("s.toml"), "-o", folder.at("out")}), 65, {"s.toml", "no [[programme]]"});
    // Only the start file tells that 1.5 is behind.
    isostat::State state = crafted::two_disks(1, 2, 1, 2);
    scratch::write(folder / "start.json", state_text(state));
    scratch::write(folder / "f.toml", scene_from("start.json", "[[programme]]\ndo = \"up\"\nto = 1.5\n"));
    expect(run({"run", folder.at("f.toml"), "-o", folder.at("out")}), 65, {"f.toml:3", "start is 2", "larger"});
    expect(run({"prepare", folder.at("f.toml"), "-o", folder.at("o.json")}), 65, {"f.toml", "nothing to prepare"});
    BOOST_TEST(!fs::exists(folder / "out"));
}

BOOST_FIXTURE_TEST_CASE(a_folder_that_holds_a_run, scratch::InFolder) {
    const std::string out = folder.at("run");
    scratch::write_scene(folder / "s.toml", scene_from(scratch::data("vertex100.txt"), up(6)));
    expect(run({"run", folder.at("s.toml"), "-o", out, "--resume", "-q"}), 65, {"run.json", "no run to resume"});
    expect(run({"run", folder.at("s.toml"), "-o", out, "-q"}), 0);
    expect(run({"run", folder.at("s.toml"), "-o", out, "-q"}), 64, {"holds a run already", "--resume", "--force"});
    expect(run({"run", folder.at("s.toml"), "-o", out, "-q", "--force"}), 0);
    scratch::write_scene(folder / "t.toml",
                         scene_from(scratch::data("vertex100.txt"), up(6), "[run]\nrule = \"least_index\"\n"));
    expect(run({"run", folder.at("t.toml"), "-o", out, "-q", "--resume"}), 65, {"run.json", "another scene", "t.toml"});
}

BOOST_FIXTURE_TEST_CASE(a_cell_that_is_refused_after_reading_is_refused_with_its_file, scratch::InFolder) {
    // Pairs up to just 29 periods apart may touch: the search reaches a little farther, and refuses what was read.
    const std::string file = folder.at("leaning.toml");
    scratch::write(file, "format = \"isostat-packing 1\"\ndisks = [[0, 0, 1]]\n[cell]\nperiod = [2, 2]\n"
                         "moves = [\"x\"]\ntilt = \"8077051742094299/140737488355328\"\n");
    for (const std::string command : {"inspect", "genericity", "import", "plateau"}) {
        const Arguments output = command == "import" ? Arguments{"-o", folder.at("o.json")} : Arguments{};
        expect(run(plus({command, file}, output)), 65, {file + ": disk 0", "periods apart"});
    }
}

BOOST_FIXTURE_TEST_CASE(a_manifest_without_a_table_is_told_which_table_and_which_key, scratch::InFolder) {
    const std::string head = "format = \"isostat-series 1\"\n", files = "[files]\ndisks = \"a\"\nframes = \"b\"\n";
    for (const auto& [text, words] : {std::pair(head, ":1: no disks in [files]: expected the name of a LAMMPS dump"),
                                      std::pair(head + files, ":1: no reference_length in [load]: expected [L1, L2]"),
                                      std::pair(head + "[files]\ndisks = \"\"\n", ":3: disks in [files] is ''")}) {
        scratch::write(folder / "m.toml", text);
        expect(run({"compare", folder.at("m.toml"), "-o", folder.at("out")}), 65, {folder.at("m.toml") + words});
    }
}

BOOST_AUTO_TEST_CASE(numbers_of_options_are_finite_and_in_their_range) {
    const Called called;
    for (const auto& call : called.with_numbers()) {
        for (const char* word :
             {"nan", "NaN", "inf", "-inf", "infinity", "1e400", "1e101", "0x1p3", "1,5x", "1 2", "one"}) {
            refuses(call, word);
        }
    }
    for (const auto& call :
         {Arguments{"report", called.out, "--stiffness"}, {"snap", called.state, "-o", called.out, "--stiffness"}}) {
        for (const char* word : {"1e-320", "0", "-1", "1e-101"}) {
            refuses(call, word);
        }
    }
    refuses({"import", called.state, "-o", called.out, "--jitter"}, "0.11");
    for (const char* word : {"nan,1", "1,inf", "1", "1,2,3", "0,1", "1e-320,1"}) {
        refuses({"snap", called.state, "-o", called.out, "--stress"}, word);
    }
    for (const char* word : {"nan:1", "0:inf", "1:0", "1"}) {
        refuses({"plateau", called.state, "--thresholds"}, word);
    }
    expect(run({"inspect", called.state, "--at", "1.5"}), 0);
    expect(run({"inspect", called.state, "--at=-1e98"}), 1);
    expect(run({"inspect", called.state, "--at=-1e100"}), 2); // times a length it is beyond what is computed with
}

BOOST_AUTO_TEST_CASE(integers_of_options_are_written_as_integers) {
    const Called called;
    for (const auto& call : called.with_integers()) {
        for (const char* word : {"4.9", "4.0", "1e1", "-0", "+4", "010", "0x10", "nan", "99999999999999999999", "4 "}) {
            refuses(call, word);
        }
    }
    expect(run({"inspect", called.state, "--threads", "1"}), 0);
}
