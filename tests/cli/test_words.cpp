// What the program says when the wrong file is given, and when it is stopped.
// What a file is comes before what else is missing on the command line; a file of no format is described.
#include "cli/program.hpp"

using namespace program;

BOOST_FIXTURE_TEST_CASE(the_wrong_kind_of_file_names_the_commands_that_take_it, scratch::InFolder) {
    const auto path = [this](const char* name) { return (folder / name).string(); };
    ran(folder, scene_from(scratch::data("vertex100.txt"), up(6)));
    expect(run({"import", scratch::data("vertex100.txt"), "-o", path("state.json")}), 0);
    expect(run({"certify", path("state.json"), "-o", path("cert.json")}), 0);
    const auto output_of = [&](const std::string& command) {
        return command == "run" || command == "prepare" || command == "certify" ? Arguments{"-o", path("o")}
                                                                                : Arguments{};
    };
    const std::string packing = ISOSTAT_EXAMPLES "/packings/square_lattice_3.toml";
    expect(run({"certify", path("s.toml"), "-o", path("c")}), 65,
           {"a scene, which says what to compute: for isostat run, plan, prepare, ensemble, not for certify"});
    expect(run({"inspect", path("s.toml")}), 65, {"a scene"});
    expect(run({"run", path("state.json"), "-o", path("o")}), 65, {"a state: for isostat inspect, certify"});
    expect(run({"verify", path("state.json")}), 65, {"a state: for isostat inspect, certify"});
    expect(run({"inspect", path("cert.json")}), 65, {"a certificate: for isostat verify, not for inspect"});
    expect(run({"run", packing, "-o", path("o")}), 65, {"a crafted packing: for isostat inspect"});
    expect(run({"inspect", path("run")}), 65, {"the folder of a run: for isostat report, verify"});
    for (const char* name : {"run.json", "events.jsonl", "equilibria.csv"}) {
        expect(run({"inspect", path("run") + "/" + name}), 65, {"a file of a run; its folder is meant"});
    }
    for (const char* command : {"inspect", "run", "verify"}) {
        expect(run(plus({command, scratch::data("series/disks.dump")}, output_of(command))), 65,
               {std::string("a LAMMPS dump: for isostat plateau, import, snap, not for ") + command});
    }
    for (const char* rows : {"x,y,r\n1,1,1\n", "#format x_y_z_r\n1\t1\t0\t1\n", "# disks\n\n1 1 1\n"}) {
        scratch::write(folder / "table.csv", rows);
        for (const char* command :
             {"run", "plan", "prepare", "inspect", "certify", "verify", "genericity", "compare"}) {
            expect(run(plus({command, path("table.csv")}, output_of(command))), 65,
                   {std::string("a table of disks: for isostat plateau, import, snap, not for ") + command});
        }
    }
    // The right kind with something wrong in it gets no such advice.
    scratch::write(folder / "bad.toml", "[packing]\ndisks = 4\nsede = 1\n");
    const Outcome bad = run({"plan", path("bad.toml")});
    expect(bad, 65, {"sede"});
    BOOST_TEST(!contains(bad.err, "not for"));
}

BOOST_FIXTURE_TEST_CASE(a_held_coordinate_is_not_counted_as_a_contact_that_carries_force, scratch::InFolder) {
    const std::string file = folder.at("few.json");
    expect(run({"import", scratch::data("vertex100.txt"), "-o", file}), 0);
    std::string state = scratch::read(file);
    const std::size_t list = state.find("\"contacts\": [") + std::string("\"contacts\": [").size();
    state.erase(list, state.find(']', list) + 2 - list); // the first contact: 201 of 202 are left
    scratch::write(file, state);
    const Outcome few = run({"inspect", file, "--json"});
    BOOST_TEST(contains(few.out, "\"N\":201"), few.out + few.err);
    BOOST_TEST(contains(few.out, "\"backbone\":185"), few.out.substr(0, 600));
}

BOOST_FIXTURE_TEST_CASE(a_run_that_is_stopped_says_how_to_go_on, scratch::InFolder) {
    scratch::write_scene(folder / "s.toml", scene_from(scratch::data("vertex1936.txt"), // longer than anyone waits
                                                       up(100000)));
    const std::string scene = folder.at("s.toml");
    // A second signal ends the program at once: `timeout` sends one to the group too, but in the foreground.
    for (const char* seconds : {"1", "8", "60", "600"}) { // on a busy machine it has not begun after one
        const std::string out = folder.at("run") + seconds;
        const Outcome stopped = run({"run", scene, "-o", out, "-q"},
                                    std::string("timeout --foreground --preserve-status -s INT ") + seconds + " ");
        if (scratch::read(out + "/equilibria.csv").find("\n0,") == std::string::npos) { // names of columns alone
            continue;
        }
        expect(stopped, 130, {"to go on: isostat run " + scene + " -o " + out + " --resume"});
        return;
    }
    BOOST_TEST(false, "the run had not begun after ten minutes");
}

BOOST_FIXTURE_TEST_CASE(a_file_that_is_not_there_or_is_for_others_is_told_before_a_missing_option, scratch::InFolder) {
    const std::string none = folder.at("none.toml"), scene = folder.at("s.toml");
    scratch::write(scene, "[packing]\ndisks = 10\n");
    for (const char* command : {"run", "ensemble", "certify", "import", "export"}) {
        expect(run({command, none}), 65, {none, "does not exist"});
    }
    expect(run({"certify", scene}), 65, {"is a scene", "not for certify"});
    expect(run({"run", scene}), 64, {"--output is required"});
    expect(run({"run"}), 64, {"required"});
}

BOOST_FIXTURE_TEST_CASE(a_file_of_no_format_is_shown_by_its_beginning, scratch::InFolder) {
    scratch::write(folder / "junk", "hello\x1b[2J, this is a letter and no packing at all\n1 2 3\n");
    for (const char* command : {"inspect", "report"}) {
        expect(run({command, folder.at("junk")}), 65, {"neither a state", "'hello\\x1b[2J, this is a letter and"});
    }
    expect(run({"report", folder.file("s.toml", "[packing]\ndisks = 10\n")}), 65,
           {"neither a state", "'[packing]'", "is a scene"});
}
