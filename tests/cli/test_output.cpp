// Files of the user are never lost, whatever is written where, and files that a file names are no way out of its
// folder.
#include "cli/program.hpp"
#include "io/record_digests.hpp"

#include <isostat/io/state_file.hpp>

#include <sys/stat.h>

using namespace program;
namespace fs = std::filesystem;

namespace {

const std::string small_run = "[packing]\ndisks = 10\nseed = 2\n[[programme]]\ndo = \"up\"\nequilibria = 2\n";

struct Desk {
    scratch::Folder folder;
    std::string scene = at("s.toml");
    Desk() { scratch::write(scene, small_run); }
    [[nodiscard]] std::string at(const std::string& name) const { return (folder / name).string(); }
    /// A file of the user.
    [[nodiscard]] std::string precious(const std::string& name) const {
        fs::create_directories((folder / name).parent_path());
        scratch::write(folder / name, "precious");
        return at(name);
    }
    /// The command is refused and the file is as it was.
    void refused(const std::string& name, const Arguments& arguments, const std::string& word) const {
        const std::string before = scratch::read(folder / name);
        expect(run(arguments), 64, {word});
        BOOST_TEST(scratch::read(folder / name) == before, arguments.front() << " " << name);
    }
};

} // namespace

BOOST_FIXTURE_TEST_CASE(no_command_writes_into_a_folder_of_the_user, Desk) {
    for (const char* name :
         {"u/equilibria.csv", "u/states/eq_000000.json", "u/figures/staircase.svg", "u/samples.csv"}) {
        const std::string out = at("u");
        (void)precious(name);
        refused(name, {"run", scene, "-o", out, "-q"}, "expected an empty folder");
        refused(name, {"run", scene, "-o", out, "-q", "--force"}, "expected an empty folder");
        refused(name, {"ensemble", scene, "-S", "1", "-o", out, "-q", "--force"}, "expected an empty folder");
        refused(name, {"compare", scratch::data("series/series.toml"), "-o", out, "-q"}, "expected an empty folder");
        fs::remove_all(out);
    }
    (void)precious("v/figures/mine.svg");
    scratch::write(folder / "v/run.json", "{\"of\":\"another program\"}");
    refused("v/figures/mine.svg", {"run", scene, "-o", at("v"), "-q", "--force"}, "run.json");
    expect(run({"run", scene, "-o", at("w"), "-q"}), 0);
    (void)precious("w/figures/mine.svg");
    (void)precious("x/staircase.svg");
    refused("x/staircase.svg", {"report", at("w"), "-o", at("x")}, "expected an empty folder");
    expect(run({"report", at("w"), "-o", at("y"), "-q"}), 0);
    expect(run({"report", at("w"), "-o", at("y"), "-q"}), 0); // again
    expect(run({"run", scene, "-o", at("w"), "-q", "--force"}), 0);
    BOOST_TEST(scratch::read(folder / "w/figures/mine.svg") == "precious");
}

BOOST_FIXTURE_TEST_CASE(no_command_writes_over_its_input_or_a_file_of_the_user, Desk) {
    const std::string state = at("a.json");
    expect(run({"prepare", scene, "-o", state, "-q"}), 0);
    expect(run({"prepare", scene, "-o", state, "-q"}), 0); // a state in the place of a state
    expect(run({"export", state, "-o", at("a.csv")}), 0);
    (void)precious("mine");
    fs::create_hard_link(state, folder / "b.json");
    refused("s.toml", {"prepare", scene, "-o", scene}, "is the input");
    refused("a.json", {"certify", state, "-o", state}, "is the input");
    refused("a.json", {"certify", state, "-o", at("b.json")}, "is the input");
    refused("a.json", {"snap", state, "-o", state}, "is the input");
    refused("a.json", {"export", state, "-o", state, "--format", "csv"}, "is the input");
    refused("a.csv", {"plateau", at("a.csv"), "--csv", at("a.csv")}, "is the input");
    refused("a.json", {"genericity", state, "--samples", "1", "--csv", state}, "is the input");
    for (const Arguments& command :
         std::vector<Arguments>{{"prepare", scene, "-o"},
                                {"certify", state, "-o"},
                                {"snap", state, "-o"},
                                {"export", state, "--format", "xyz", "-o"},
                                {"plateau", at("a.csv"), "--csv"},
                                {"genericity", state, "--samples", "1", "--csv"},
                                {"import", at("a.csv"), "--walls", "box", "-o"},
                                {"import", at("a.csv"), "--walls", "box", "-o", at("i.json"), "--moved"}}) {
        refused("mine", plus(command, {at("mine")}), "expected a new name");
    }
    (void)precious("pictures/forces_a.svg");
    refused("pictures/forces_a.svg", {"report", state, "-o", at("pictures")}, "expected a new name");
}

BOOST_FIXTURE_TEST_CASE(a_program_without_descriptors_keeps_its_files_clean, Desk) {
    scratch::write(scene, small_run + "[run]\ncertify = \"arcs\"\n[output]\nstates_every = 1\n");
    const std::string command = quoted(ISOSTAT_PROGRAM) + " run " + program::quoted(scene) + " -o ";
    BOOST_TEST(std::system((command + quoted(at("a")) + " <&- >&- 2>&-").c_str()) == 0);
    BOOST_TEST(std::system((command + quoted(at("b")) + " >&-").c_str()) == 0);
    for (const char* name : {"a", "b"}) {
        expect(run({"verify", at(name), "-q"}), 0);
        BOOST_TEST(fs::file_size(folder / name / "lock") == 0U);
    }
    scratch::write(scene, small_run + "[run]\nmax_arcs = 1\n"); // it fails and has something to say
    BOOST_TEST(std::system((command + quoted(at("c")) + " -q <&- >&- 2>&-").c_str()) != 0);
    BOOST_TEST(!contains(scratch::read(folder / "c/equilibria.csv"), "isostat"));
}

BOOST_FIXTURE_TEST_CASE(a_scene_or_a_series_names_regular_files_beside_it, Desk) {
    BOOST_REQUIRE(::mkfifo(at("pipe").c_str(), 0600) == 0);
    (void)precious("outside.txt");
    fs::create_directories(folder / "in");
    for (const std::string& name :
         {std::string("/dev/zero"), std::string("../pipe"), std::string("../outside.txt"), at("outside.txt")}) {
        for (const char* key : {"radii_file", "file"}) {
            scratch::write(folder / "in/s.toml", std::string("[packing]\n") + key + " = \"" + name + "\"\n" + up(6));
            for (const char* command : {"plan", "run"}) {
                const Arguments output = std::string(command) == "run" ? Arguments{"-o", at("out")} : Arguments{};
                expect(run(plus({command, at("in/s.toml")}, output), "timeout 60 "), 65,
                       {"s.toml:2: " + std::string(key), "beside"});
            }
        }
        for (const char* key : {"disks", "contacts", "frames"}) {
            const std::string text = scratch::read(scratch::data("series/series.toml"));
            const std::size_t begin = text.find(std::string("\n") + key + " = \"") + 1;
            scratch::write(folder / "in/series.toml",
                           text.substr(0, begin) + key + " = \"" + name + "\"" + text.substr(text.find('\n', begin)));
            for (const char* other : {"disks.dump", "contacts.dump", "frames.csv"}) {
                fs::copy_file(scratch::data(std::string("series/") + other), folder / "in" / other,
                              fs::copy_options::overwrite_existing);
            }
            expect(run({"compare", at("in/series.toml")}, "timeout 60 "), 65, {key, "beside"});
        }
    }
    BOOST_TEST(!fs::exists(folder / "out"));
}

BOOST_FIXTURE_TEST_CASE(a_foreign_file_among_the_states_is_a_note, Desk) {
    expect(run({"run", scene, "-o", at("r"), "-q"}), 0);
    (void)precious("r/states/notes.json");
    expect(run({"run", scene, "-o", at("r"), "-q", "--resume"}), 0, {"states/notes.json", "left alone"});
    expect(run({"report", at("r"), "-q"}), 0, {"states/notes.json", "left alone"});
    expect(run({"export", at("r"), "-o", at("r.xyz")}), 0);
    BOOST_TEST(scratch::read(folder / "r/states/notes.json") == "precious");
    fs::remove(folder / "r/states/eq_000000.json");
    BOOST_REQUIRE(::mkfifo(at("r/states/eq_000000.json").c_str(), 0600) == 0);
    for (const char* command : {"verify", "report"}) {
        expect(run({command, at("r")}, "timeout 60 "), 65, {"eq_000000.json", "regular file"});
    }
}

BOOST_FIXTURE_TEST_CASE(a_forged_checkpoint_cuts_no_file, Desk) {
    expect(run({"run", scene, "-o", at("r"), "-q"}), 0);
    (void)precious("thesis.txt");
    const std::string old = scratch::read(folder / "r/checkpoint.json");
    std::string text = old.substr(0, old.rfind(isostat::before_digest));
    text = scratch::replaced(text, "\"bytes\":{", "\"bytes\":{\"../thesis.txt\":0,");
    text = scratch::replaced(text, "\"digests\":{", "\"digests\":{\"../thesis.txt\":\"\",");
    scratch::write(folder / "r/checkpoint.json", text + isostat::before_digest + '"' + isostat::sha256(text) + "\"}\n");
    expect(run({"run", scene, "-o", at("r"), "-q", "--resume"}), 65, {"checkpoint.json", "thesis.txt"});
    expect(run({"report", at("r"), "-q"}), 65, {"checkpoint.json", "thesis.txt"});
    BOOST_TEST(run({"verify", at("r"), "-q"}).status != 0);
    BOOST_TEST(scratch::read(folder / "thesis.txt") == "precious");
}

BOOST_FIXTURE_TEST_CASE(an_ensemble_has_as_many_rows_as_there_are_samples, Desk) {
    expect(run({"ensemble", scene, "-S", "2", "-o", at("e"), "-q"}), 0);
    const std::string header = scratch::read(folder / "e/ensemble.json");
    scratch::write(folder / "e/ensemble.json", scratch::replaced(header, "\"samples\": 2", "\"samples\": 2147483647"));
    expect(run({"verify", at("e")}, "timeout 60 "), 65, {"ensemble.json", "samples"});
    scratch::write(folder / "e/ensemble.json", scratch::replaced(header, "\"samples\": 2", "\"samples\": 1000"));
    const auto some = says(run({"verify", at("e")}, "timeout 300 "), 2, {"missing, and 997 after it"});
    BOOST_TEST(std::ranges::count(some.out, '\n') < 30);
}
