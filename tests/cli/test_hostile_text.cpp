// Names and words that other people wrote are text: no shell, no terminal and no reader takes them for more.
#include "cli/program.hpp"
#include "io/text.hpp"
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>

using namespace program;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Whoever takes one of them for a command leaves a file TRACE.
const std::vector<std::string> commands{"`touch TRACE`",
                                        "system(\"touch TRACE\")",
                                        "' . system(\"touch TRACE\") . '",
                                        "\" . system(\"touch TRACE\") . \"",
                                        "\\`touch TRACE\\`",
                                        "$(touch TRACE)",
                                        "'; ! touch TRACE #",
                                        "</text><script>TRACE</script>",
                                        "{/=99 large} ^_{TRACE} @TRACE %s {}"};
const std::vector<std::string> controls{"\x1b]0;owned\a\x1b[2J", "two\n! touch TRACE",
                                        "\xC2\x9B"
                                        "31m",
                                        "\u2028 line", "\x7f"};

/// Nothing but text and line feeds.
bool harmless(const std::string& words) {
    return isostat::text::shown_lines(words) == words;
}

void expect_harmless(const Outcome& outcome) {
    BOOST_TEST((outcome.status < 128 && outcome.status != 70), outcome.status << ": " << outcome.err);
    BOOST_TEST(harmless(outcome.out), isostat::text::shown(outcome.out));
    BOOST_TEST(harmless(outcome.err), isostat::text::shown(outcome.err));
}

/// No file of that name, and every file of text is harmless.
void expect_no_trace(const fs::path& folder) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        BOOST_TEST(!contains(entry.path().filename().string(), "TRACE"), entry.path());
        const std::string type = entry.path().extension().string();
        if (type == ".gp" || type == ".dat" || type == ".txt" || type == ".html" || type == ".vtk") {
            BOOST_TEST(harmless(scratch::read(entry.path())), entry.path());
        }
    }
}

std::string in_toml(const std::string& name) {
    return json(name).dump(-1, ' ', true); // all escaped, as TOML asks of control characters
}

/// Up and down by turns: no sample of 10 disks goes far one way.
std::string scene_of_names(const std::vector<std::string>& names) {
    std::string text = "[packing]\ndisks = 10\nseed = 2\n";
    for (std::size_t k = 0; k < names.size(); ++k) {
        text += "[[programme]]\nname = " + in_toml(names[k]) + "\ndo = \"" + (k % 2 == 0 ? "up" : "down") +
                "\"\nequilibria = 1\n";
    }
    return text;
}

} // namespace

BOOST_FIXTURE_TEST_CASE(names_of_segments_are_text_for_gnuplot_and_in_every_figure, scratch::InFolder) {
    scratch::write(folder / "s.toml", scene_of_names(commands));
    const std::string here = "cd '" + folder.path().string() + "'; ";
    const Outcome made = done(run({"run", "s.toml", "-o", "run"}, here));
    BOOST_TEST(made.err.empty(), made.err);
    expect(run({"report", "run", "--html", "--vtk", "--pdf"}, here), 0);
    expect(run({"ensemble", "s.toml", "--samples", "1", "-o", "many", "-q"}, here), 0);
    expect_no_trace(folder.path());
    for (const std::string& name : commands) {
        BOOST_TEST(contains(scratch::read(folder / "run/figures/report.txt"), name), name);
    }
    const std::string drawn = scratch::read(folder / "run/figures/staircase.svg");
    BOOST_TEST(contains(drawn, "`touch TRACE`"));
    BOOST_TEST(contains(drawn, "&lt;script"));
    BOOST_TEST(!contains(drawn, "<script"));
    BOOST_TEST(contains(drawn, "^_{TRACE}"));
}

BOOST_FIXTURE_TEST_CASE(a_name_in_a_scene_is_one_line_without_control_characters, scratch::InFolder) {
    for (const std::string& name : controls) {
        const Outcome refused = run({"plan", folder.file("s.toml", scene_of_names({name}))});
        expect(refused, 65, {"s.toml:", "name", "one line of text"});
        expect_harmless(refused);
    }
}

BOOST_FIXTURE_TEST_CASE(names_in_a_folder_of_somebody_else_are_text, scratch::InFolder) {
    scratch::write(folder / "s.toml", scene_of_names({"one", "two"}));
    const std::string here = "cd '" + folder.path().string() + "'; ";
    expect(run({"run", "s.toml", "-o", "run", "-q"}, here), 0);
    fs::remove_all(folder / "run/figures");
    json header = json::parse(scratch::read(folder / "run/run.json"));
    for (const std::vector<std::string>& names : {commands, controls}) {
        for (std::size_t k = 0; k + 1 < names.size(); ++k) {
            header["programme"] = {names[k], names[k + 1]};
            header["scene_file"] = header["program"] = names[k];
            scratch::write(folder / "run/run.json", header.dump());
            expect_harmless(done(run({"report", "run", "--html", "--vtk"}, here)));
        }
        header["status"] = "completed: " + names.back();
        scratch::write(folder / "run/run.json", header.dump());
        for (const char* option : {"--quiet", "--json"}) {
            expect_harmless(run({"verify", "run", option}, here));
            expect_harmless(run({"report", "run", option}, here));
        }
    }
    expect_no_trace(folder.path());
}

BOOST_FIXTURE_TEST_CASE(names_of_files_do_not_command_the_terminal, scratch::InFolder) {
    const std::string state = isostat::state_text(::crafted::two_disks(1, 2, 1, 1), {});
    for (const std::string& name : {std::string("\x1b[31mred\a"), std::string("two\nlines"), std::string("\xff\x9b")}) {
        const std::string file = (folder / (name + ".json")).string();
        const std::string scene = (folder / (name + ".toml")).string();
        const std::string out = (folder / (name + ".out")).string();
        for (const std::string& content : {state, std::string("nonsense")}) {
            scratch::write(file, content);
            scratch::write(scene, content);
            const std::vector<Arguments> calls{{"inspect", file},
                                               {"inspect", scene},
                                               {"certify", file, "-o", out},
                                               {"verify", file},
                                               {"verify", out, "--input", file},
                                               {"export", file, "-o", out + ".xyz"},
                                               {"plateau", file},
                                               {"import", file, "-o", out},
                                               {"snap", file, "-o", out},
                                               {"genericity", file, "--samples", "1"},
                                               {"report", file, "-o", out + ".d"},
                                               {"plan", scene},
                                               {"prepare", scene, "-o", out},
                                               {"run", scene, "-o", out + ".d"},
                                               {"ensemble", scene, "--samples", "1", "-o", out},
                                               {"compare", scene, "-o", out},
                                               {"inspect", file + "absent"},
                                               {file},
                                               {"inspect", file, "--" + name},
                                               {"inspect", file, "--at", name}};
            for (Arguments call : calls) {
                expect_harmless(run(call));
                call.emplace_back("--json");
                const Outcome machine = run(call);
                expect_harmless(machine);
                BOOST_TEST((machine.out.empty() || json::accept(machine.out)), machine.out);
            }
        }
    }
}

BOOST_FIXTURE_TEST_CASE(words_of_files_of_other_programs_do_not_command_the_terminal, scratch::InFolder) {
    const std::string bad = "\x1b[31m\a";
    const std::vector<std::string> files{
        "1\nProperties=species:S:1:pos:R:2:" + bad + ":R:1\nA 1 1 1\n",
        "2\nProperties=species:S:1:pos:R:2:radius:R:1:type:S:1\nA 1 1 1 " + bad + "\nA 4 1 1 B\n",
        "x,y,r," + bad + "\n1,1,1\n",
        "x,y,r,type\n1,1,1," + bad + "\n3,1,1,b\n",
        "x,y," + bad + "\n1,1,1\n",
        "x,y,r\n1," + bad + ",1\n",
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS " + bad + "\n",
        "comment\n\n1 atoms " + bad + "\n",
        "{\"format\": \"" + std::string("\\u001b[31m\\u009b") + "\"}",
        "format = \"isostat-packing 1\"\ntitle = \"\\u001b[31m\"\n" + std::string("disks = \"\\u009b\"\n"),
    };
    for (const std::string& content : files) {
        scratch::write(folder / "file", content);
        for (const char* command : {"plateau", "inspect", "genericity"}) {
            expect_harmless(run({command, folder.at("file")}));
        }
        expect_harmless(run({"inspect", folder.file("file.toml", content)}));
    }
}
