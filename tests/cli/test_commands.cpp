#include "cli/program.hpp"
#include "support/crafted.hpp"

#include <isostat/io/run_directory.hpp>
#include <isostat/io/state_file.hpp>

using namespace program;
using isostat::state_text;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string back_twice = "[[programme]]\ndo = \"down\"\nto = 1\n[[programme]]\ndo = \"down\"\nfrom = 3\nto = 1\n";

} // namespace

BOOST_AUTO_TEST_CASE(help_of_every_subcommand_has_an_example) {
    for (const char* name : {"prepare", "run", "ensemble", "inspect", "certify", "verify", "plateau", "genericity",
                             "plan", "report", "import"}) {
        const Outcome outcome = done(run({name, "--help"}));
        BOOST_TEST(contains(outcome.out, "isostat " + std::string(name) + " "), name);
        BOOST_TEST(contains(outcome.out, "Example"), name);
        BOOST_TEST(contains(run({"--help"}).out, name));
    }
    BOOST_TEST(run({"--version"}).out.starts_with("isostat "));
}

BOOST_AUTO_TEST_CASE(wrong_use_is_64) {
    says(run({}), 64, {"Subcommands:", "inspect"});
    BOOST_TEST(run({}).out == run({"--help"}).out); // line by line
    expect(run({"fly"}), 64, {"'fly' is no command", "--help"});
    expect(run({"runn", "scene.toml"}), 64, {"did you mean 'run'?"});
    expect(run({"ceritfy"}), 64, {"did you mean 'certify'?"});
    expect(run({"run"}), 64, {"scene"});
    expect(run({"run", ISOSTAT_EXAMPLES "/biaxial-400.toml"}), 64, {"--output"});
    expect(run({"inspect", "a", "b"}), 64);
    expect(run({"run", "scene.toml", "-o", "x", "--resume", "--force"}), 64);
    expect(run({"plan", "scene.toml", "--fast"}), 64, {"--fast"});
}

BOOST_FIXTURE_TEST_CASE(inspect_tells_the_closed_form_of_two_disks, scratch::InFolder) {
    scratch::write(folder / "two.json", state_text(crafted::two_disks(1, 2, 1, 1)));
    const auto j = json_of(run({"inspect", folder.at("two.json"), "--json"}));
    has(j, {{"N_f", 6}, {"N", 6}, {"rank", 6}, {"h", 0}, {"k", 0}});
    BOOST_TEST(j["rattlers"].empty());
    BOOST_TEST(j["verdict"] == "proved");
    const double t = 1 / (2 * std::sqrt(2.0));
    BOOST_TEST(j["supported_interval"][0].get<double>() == t, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(j["supported_interval"][1].is_null()); // unbounded
    BOOST_TEST(j["opens"][0] == "1-bottom");
    BOOST_TEST(j["min_force"].get<double>() == t, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(j["min_force_contact"] == "0-bottom");
    says(run({"inspect", folder.at("two.json")}), 0,
         {"degrees of freedom N_f   6", "self-stresses h          0", "opens 1-bottom", "unbounded",
          "equilibrium    proved"});
}

BOOST_FIXTURE_TEST_CASE(inspect_refutes_what_is_no_isostatic_equilibrium, scratch::InFolder) {
    const auto inspected = [&](const isostat::State& state) {
        return run({"inspect", folder.file("s.json", state_text(state)), "--json"});
    };
    has(json_of(inspected(crafted::square_lattice(3)), 1), {{"h", 4}, {"verdict", "refuted"}});
    isostat::State open = crafted::two_disks(1, 2, 1, 1);
    open.contacts.pop_back();
    has(json_of(inspected(open), 1), {{"k", 1}});
    says(inspected(crafted::two_disks(1, 2, 1, 0.3)), 1, {"1-bottom"}); // pulls below the limit 0.3535
}

BOOST_FIXTURE_TEST_CASE(import_keeps_every_number_of_a_vertex_text_and_proves_it, scratch::InFolder) {
    const std::string target = folder.at("state.json");
    expect(run({"import", scratch::data("vertex100.txt"), "-o", target}), 0);
    const isostat::State a = isostat::read_state(scratch::data("vertex100.txt")).state;
    const isostat::State b = isostat::read_state(target).state;
    BOOST_TEST((a.packing.q == b.packing.q));
    BOOST_TEST((a.packing.radius == b.packing.radius));
    BOOST_TEST((a.load.infinitesimal == b.load.infinitesimal));
    BOOST_TEST((a.contacts == b.contacts));
    BOOST_TEST(json::parse(b.provenance)["command"].get<std::string>().find("import") != std::string::npos);
    for (const char* stated : {"--stress=1,2", "--load=true", "--contacts=nearest", "--threshold=1e-9"}) {
        expect(run({"import", scratch::data("vertex100.txt"), "-o", target, stated}), 65, {"vertex text"});
    }
    const std::string rows = scratch::read(scratch::data("vertex100.txt")), pulled = folder.at("pulled.txt");
    const std::size_t last = rows.rfind("\n4 ");
    scratch::write(pulled, rows.substr(0, last + 1) + rows.substr(rows.find('\n', last + 1) + 1));
    BOOST_TEST(run({"import", pulled, "-o", folder.at("none.json")}).status != 0); // a contact is missing
    BOOST_TEST(!fs::exists(folder / "none.json"));
}

BOOST_FIXTURE_TEST_CASE(prepare_makes_a_state_with_its_history_and_the_same_bits_again, scratch::InFolder) {
    scratch::write(folder / "s.toml", "[packing]\ndisks = 25\nseed = 5\n");
    const std::string first = folder.at("1.json"), second = folder.at("2.json");
    expect(run({"prepare", folder.at("s.toml"), "-o", first}), 0);
    const Outcome quiet = done(run({"prepare", folder.at("s.toml"), "-o", second, "--quiet"}));
    BOOST_TEST(quiet.out.empty());
    BOOST_TEST(quiet.err.empty());
    const isostat::State a = isostat::read_state(first).state;
    const isostat::State b = isostat::read_state(second).state;
    BOOST_TEST((a.packing.q == b.packing.q));
    BOOST_TEST((a.contacts == b.contacts));
    BOOST_TEST(a.contacts.size() == 52U);
    const json provenance = json::parse(a.provenance);
    BOOST_TEST(provenance["settings"]["packing"]["seed"] == 5);
    BOOST_TEST(provenance["settings"]["load"]["kind"] == "nominal");
    BOOST_TEST(provenance.contains("infinitesimal_seed"));
    BOOST_TEST(provenance["program"].get<std::string>().starts_with("isostat "));
    expect(run({"inspect", first}), 0);
}

BOOST_FIXTURE_TEST_CASE(plan_prints_a_scene_that_gives_the_same_plan, scratch::InFolder) {
    for (const std::string name : {"biaxial-400.toml", "biaxial-1936.toml", "biaxial-4900.toml", "periodic-1936.toml",
                                   "shear-400.toml", "spheres-100.toml"}) {
        const auto plan = says(run({"plan", ISOSTAT_EXAMPLES "/" + name}), 0, {"max_arcs = 20000", "# default"});
        const Outcome again = done(run({"plan", folder.file("again.toml", plan.out)}));
        const auto settings = [](const std::string& text) { // without the remarks on lines
            std::string kept;
            for (const std::string& line : scratch::split(text.substr(text.find("\n[packing]")), '\n')) {
                kept += line.substr(0, line.find(" #")) + "\n";
            }
            return kept;
        };
        BOOST_TEST(settings(again.out) == settings(plan.out));
    }
    const json j = json_of(run({"plan", ISOSTAT_EXAMPLES "/biaxial-400.toml", "--json"}));
    BOOST_TEST(j["plan"].size() > 10U);
    BOOST_TEST(j["programme"].size() == 5U);
}

BOOST_FIXTURE_TEST_CASE(a_run_with_cycles_writes_everything_and_says_so, scratch::InFolder) {
    const std::string out = folder.at("run");
    scratch::write_scene(folder / "s.toml", scene_from(scratch::data("vertex100.txt"), up(6) + back_twice));
    says(run({"run", folder.at("s.toml"), "-o", out}), 0,
         {"sigma2/sigma1", "eps2", "arcs", "margin", "precision", "elapsed", "rest", "completed", "segment 3 of 3"});
    const auto rows = isostat::read_equilibria(out + "/equilibria.csv");
    BOOST_REQUIRE(rows.size() > 9U);
    for (const auto& row : rows) {
        BOOST_TEST(row.proved);
        BOOST_TEST(row.hyperstaticity == 0);
        BOOST_TEST(row.backbone == 2 * (100 - row.rattlers) + 2);
    }
    BOOST_TEST(rows.back().ratio == 1.0);
    const auto branch = std::ranges::find_if(rows, [](const auto& r) { return r.segment == 2; });
    BOOST_REQUIRE((branch != rows.end()));
    BOOST_TEST(branch->previous == 3);
    for (const char* name : {"eq_000000", "eq_000003", "eq_000006", "last"}) {
        BOOST_TEST(fs::exists(out + "/states/" + name + ".json"), name);
        expect(run({"inspect", out + "/states/" + name + ".json"}), 0);
    }
    const json run_json = json::parse(scratch::read(out + "/run.json"));
    BOOST_TEST(run_json["status"] == "completed");
    BOOST_TEST(contains(run_json["scene"].get<std::string>(), "equilibria = 6"));
    BOOST_TEST(run_json["settings"]["run"]["rule"] == "most_negative");
    long step = 0;
    for (const std::string& line : scratch::lines_of(out + "/events.jsonl")) {
        const json event = json::parse(line);
        BOOST_TEST(event["step"] == ++step);
        BOOST_TEST(event["margin"].get<double>() > 1);
        BOOST_TEST(event["decided_by"].get<std::string>() != "none");
    }
    BOOST_TEST(json::parse(scratch::read(out + "/summary.json"))["counters"]["arcs"] == step);
}

BOOST_FIXTURE_TEST_CASE(json_output_is_one_object_and_nothing_else, scratch::InFolder) {
    scratch::write_scene(folder / "s.toml", scene_from(scratch::data("vertex100.txt"), up(6)));
    const Outcome outcome = run({"run", folder.at("s.toml"), "-o", folder.at("run"), "--json"});
    has(json_of(outcome), {{"status", "completed"}, {"counters/equilibria", 6}, {"counters/decisions/undecided", 0}});
    BOOST_TEST(outcome.err.empty());
    const std::string nine = folder.file("p.toml", "[packing]\ndisks = 9\n");
    has(json_of(run({"prepare", nine, "-o", folder.at("p.json"), "--json"})), {{"contacts", 20}});
    has(json_of(run({"import", scratch::data("vertex100.txt"), "-o", folder.at("q.json"), "--json"})),
        {{"disks", 100}});
    BOOST_TEST(json_of(run({"report", folder.at("run"), "--json", "--no-charts"}))["files"].size() > 3U);
}

BOOST_AUTO_TEST_CASE(every_line_of_an_answer_has_a_value_in_its_object) {
    const std::vector<std::array<const char*, 2>> keys{{"degrees of freedom N_f", "N_f"},
                                                       {"contacts N", "N"},
                                                       {"rank, stored", "rank"},
                                                       {"self-stresses h", "h"},
                                                       {"mechanisms k", "k"},
                                                       {"box", "length"},
                                                       {"solid fraction", "solid_fraction_without_rattlers"},
                                                       {"force-carrying contacts", "backbone"},
                                                       {"supported interval", "interval_low"},
                                                       {" ", "interval_high"},
                                                       {"smallest force", "min_force_between"},
                                                       {"smallest gap", "min_gap"},
                                                       {"largest gap of a contact", "gap_residual"},
                                                       {"smallest singular value", "sigma_min_bound"},
                                                       {"decided by", "decided_by"},
                                                       {"isostatic equilibrium", "verdict"},
                                                       {"true configuration", "true_configuration/exists"},
                                                       {"  its forces", "true_configuration/forces"},
                                                       {"coordination number", "coordination"},
                                                       {"stress of the contacts", "contact_stress"},
                                                       {"walls held", "box/grains"},
                                                       {"jammed collectively", "box/jammed/collective"}};
    const json object = json_of(run({"inspect", scratch::data("vertex100.txt"), "--json"}));
    std::istringstream lines(run({"inspect", scratch::data("vertex100.txt")}).out);
    for (std::string line; std::getline(lines, line);) {
        std::string key = line.substr(0, line.find(' ')); // where the table has none
        for (const auto& [label, known] : keys) {
            key = line.starts_with(label) ? known : key;
        }
        const json::json_pointer where("/" + key);
        BOOST_TEST((object.contains(where) && !object.at(where).is_null()), "not in the object: " << line);
    }
}

BOOST_AUTO_TEST_CASE(the_mechanisms_of_the_true_configuration_are_those_of_the_text) {
    const std::string file = scratch::data("clumps/dimer_20_2.json");
    const int k = json_of(run({"inspect", file, "--json"}))["true_configuration"]["k"].get<int>();
    BOOST_TEST(k > 0);
    BOOST_TEST(contains(run({"inspect", file}).out, fmt::format("h = 0, k = {} there", k)));
}

BOOST_AUTO_TEST_CASE(shear_and_cell_of_a_state_are_in_its_object) {
    has(json_of(run({"inspect", std::string(ISOSTAT_EXAMPLES) + "/cells/flowing.json", "--json"})),
        {{"shear/0", 0.5}, {"cell/moves", {"x", "y", "xy"}}, {"cell/tilt", 1}});
    has(json_of(run({"inspect", scratch::data("coq/slab.json"), "--json"})), // no strains are counted with walls
        {{"cell/axes", {"periodic", "periodic", "walls"}}, {"cell/tilt/0", 0.875}, {"cell/pin", 0}});
}

BOOST_FIXTURE_TEST_CASE(what_a_rounding_leaves_open_of_spheres_in_a_cell_has_one_name, scratch::InFolder) {
    std::string text = scratch::read(std::string(ISOSTAT_EXAMPLES) + "/spheres/cell-30.json");
    text.insert(text.find('{') + 1, R"("provenance": {"command": "isostat import", "rounding": 1e-3},)");
    const std::string file = folder.file("rounded.json", text);
    const std::string said = run({"inspect", file}).out;
    const json untold = json_of(run({"inspect", file, "--json"}), 2)["untold"];
    for (const char* kind : {"gaps", "forces"}) {
        const auto names = untold[kind].get<std::vector<std::string>>();
        BOOST_TEST(names.size() > 3U);
        BOOST_TEST(contains(said, fmt::format("{} {} ({})", names.size(), kind, fmt::join(names, " "))), said);
    }
}

BOOST_FIXTURE_TEST_CASE(a_sample_that_fails_is_a_result_and_a_tie_is_undecided, scratch::InFolder) {
    ran(folder, scene_from(scratch::data("vertex100.txt"), up(6), "[run]\nmax_arcs = 3\n"), 1, {"failed", "max_arcs"});
    BOOST_TEST(contains(scratch::read(folder / "run/run.json"), "\"status\": \"failed: "));
    BOOST_TEST(fs::exists(folder / "run/summary.json"));

    scratch::write(folder / "three.json", state_text(crafted::three_disks(1, 1, 1, 1, 1)));
    const Outcome tie =
        run({"run", folder.file("tie.toml", scene_from("three.json", up(1))), "-o", folder.at("tie"), "-q"});
    expect(tie, 2, {"undecided", "tie"});
    BOOST_TEST(isostat::read_equilibria(folder / "tie/equilibria.csv").size() == 1U);
    BOOST_TEST(contains(scratch::read(folder / "tie/summary.json"), "\"status\": \"undecided\""));
}

BOOST_FIXTURE_TEST_CASE(a_ratio_that_lies_behind_when_its_turn_comes_fails_the_run, scratch::InFolder) {
    ran(folder, scene_from(scratch::data("vertex100.txt"), up(6) + "[[programme]]\ndo = \"up\"\nto = 1.01\n"), 1,
        {"s.toml:6", "larger ratio than 1.01"});
    BOOST_TEST(contains(scratch::read(folder / "run/run.json"), "failed"));
}

BOOST_FIXTURE_TEST_CASE(figures_are_drawn_and_without_gnuplot_data_and_scripts_remain, scratch::InFolder) {
    const std::string out = ran(folder, scene_from(scratch::data("vertex100.txt"), up(6) + back_twice));
    BOOST_TEST(!fs::exists(out + "/figures"));
    expect(run({"report", out}, "PATH= "), 0, {"gnuplot", "cannot be started", "gnuplot-nox"});
    for (const char* name : {"staircase", "cycles", "stress_increments", "strain_increments"}) {
        BOOST_TEST(fs::exists(out + "/figures/" + name + ".dat"), name);
        BOOST_TEST(fs::exists(out + "/figures/" + name + ".gp"), name);
        BOOST_TEST(!fs::exists(out + "/figures/" + name + ".svg"), name);
    }
    const Outcome with = done(run({"report", out, "--vtk", "--pdf"}));
    BOOST_TEST(with.err.empty(), with.err);
    for (const char* name : {"staircase", "cycles", "stress_increments", "strain_increments"}) {
        BOOST_TEST(contains(scratch::read(out + "/figures/" + name + ".svg"), "</svg>"), name);
        BOOST_TEST(scratch::read(out + "/figures/" + name + ".png").starts_with("\x89PNG"), name);
        BOOST_TEST(scratch::read(out + "/figures/" + name + ".pdf").starts_with("%PDF"), name);
        BOOST_TEST(!fs::exists(out + "/figures/" + name + ".gp.log"), name);
    }
    BOOST_TEST(contains(scratch::read(out + "/figures/forces_last.svg"), "class=\"force\""));
    BOOST_TEST(scratch::read(out + "/figures/forces_last.vtk").starts_with("# vtk DataFile"));
    const json series = json::parse(scratch::read(out + "/figures/forces.vtk.series"));
    double before = -1;
    for (const json& file : series["files"]) {
        BOOST_TEST(fs::exists(out + "/figures/" + file["name"].get<std::string>()));
        BOOST_TEST(file["time"].get<double>() > before);
        before = file["time"].get<double>();
    }
    BOOST_TEST(series["files"].size() >= 3U); // the first, the one that the last segment starts from, the last
    BOOST_TEST(contains(with.out, "left of peak strain"));
    BOOST_TEST(contains(scratch::read(out + "/figures/report.txt"), "equilibria proved"));
}

BOOST_FIXTURE_TEST_CASE(a_state_without_forces_gets_them_for_its_picture, scratch::InFolder) {
    expect(run({"report", scratch::data("vertex100.txt"), "-o", folder.path().string(), "--vtk"}), 0);
    BOOST_TEST(contains(scratch::read(folder / "forces_vertex100.svg"), "class=\"force\""));
    BOOST_TEST(contains(scratch::read(folder / "forces_vertex100.svg"), "class=\"rattler\""));
    BOOST_TEST(fs::exists(folder / "forces_vertex100.vtk"));
}
