// What the program answers for spheres, and what it refuses.
#include "cli/program.hpp"
#include "support/spheres.hpp"

#include <isostat/io/state_file.hpp>

using namespace program;

namespace {

/// A reference packing as a state file.
std::string state_file(const scratch::Folder& folder, const std::string& name) {
    const isostat::State state = isostat::test::state_of_spheres(isostat::test::read_spheres(name));
    scratch::write(folder / (name + ".json"), isostat::state_text(state));
    return folder.at(name + ".json");
}

} // namespace

BOOST_FIXTURE_TEST_CASE(inspect_answers_for_a_box_a_slab_and_cells, scratch::InFolder) {
    says(run({"inspect", state_file(folder, "box_uniform_30_1")}), 0,
         {"spheres                  30", "degrees of freedom N_f   93", "rattlers                 6 by forces",
          "(opens 5-28)", "(opens 13-23)", "isostatic equilibrium    proved", "stable                   proved",
          "smallest singular values "});
    says(run({"inspect", state_file(folder, "slab_uniform_30_1")}), 0, {"N_f   91", "(opens 4-22)", "proved"});
    says(run({"inspect", state_file(folder, "tri_uniform_30_1")}), 0,
         {"tilt 0.53779", "x, y, z, xy, xz, yz move, sphere 0 is pinned", "(opens 19-22(-1,0,0))",
          "backbone, 29 spheres", "jammed collectively      proved"});
    const auto json = nlohmann::json::parse(run({"inspect", "--json", folder.at("slab_uniform_30_1.json")}).out);
    BOOST_TEST(json["spheres"] == 30);
    BOOST_TEST(json["length"].size() == 3U);
    BOOST_TEST(json["rattlers"] == json["rattlers_by_coordination"]);
    BOOST_TEST(json["singular_values"].size() == 10U);
    const double smallest = isostat::test::read_spheres("slab_uniform_30_1")["expected"]["smallest_singular_value"];
    BOOST_TEST(json["singular_values"][0].get<double>() == smallest, boost::test_tools::tolerance(1e-5));
    const std::string disks = scratch::data("vertex100.txt");
    BOOST_TEST(!contains(says(run({"inspect", disks}), 0, {}).out, "singular values")); // not asked for, not computed
    says(run({"inspect", disks, "--singular-values", "3"}), 0, {"smallest singular values 0.0"});
}

BOOST_FIXTURE_TEST_CASE(a_table_of_contacts_has_a_row_for_each_and_forces_between_their_ends, scratch::InFolder) {
    expect(run({"inspect", state_file(folder, "slab_uniform_30_1"), "--contacts", folder.at("c.csv")}), 0);
    std::istringstream table(scratch::read(folder / "c.csv"));
    std::string line;
    std::getline(table, line);
    BOOST_TEST(line == "contact,i,j,mx,my,mz,x,y,z,nx,ny,nz,gap,force,force_low,force_high,force_infinitesimal");
    int rows = 0, infinitesimal = 0;
    while (std::getline(table, line)) {
        ++rows;
        infinitesimal += line.back() != ',' ? 1 : 0;
        const std::string rest = line.substr(line.rfind('"') + 2);
        std::vector<std::string> fields(1);
        for (const char c : rest) {
            c == ',' ? fields.emplace_back() : fields.back().append(1, c);
        }
        BOOST_TEST_REQUIRE(fields.size() == 16U);
        const auto number = [&](std::size_t k) { return std::stod(fields[k]); };
        BOOST_TEST(number(8) * number(8) + number(9) * number(9) + number(10) * number(10) == 1,
                   boost::test_tools::tolerance(1e-14));
        BOOST_TEST(std::abs(number(11)) < 1e-12);
        BOOST_TEST((number(13) <= number(12) && number(12) <= number(14)));
    }
    BOOST_TEST(rows == 91);
    BOOST_TEST(infinitesimal == 15);
    // The table is written over, another file is not.
    scratch::write(folder / "mine.csv", "x\n1\n");
    expect(run({"inspect", folder.at("slab_uniform_30_1.json"), "--contacts", folder.at("c.csv")}), 0);
    expect(run({"inspect", folder.at("slab_uniform_30_1.json"), "--contacts", folder.at("mine.csv")}), 64);
    BOOST_TEST(scratch::read(folder / "mine.csv") == "x\n1\n");
}

BOOST_FIXTURE_TEST_CASE(plateau_and_paraview_files_take_spheres, scratch::InFolder) {
    const std::string state = state_file(folder, "ortho_uniform_30_1");
    says(run({"plateau", state, "--cell", "diagonal"}), 0,
         {"spheres                     30", "N = 84 with 2 rattlers"});
    expect(run({"export", state, "-o", folder.at("o.vtk")}), 0);
    const std::string vtk = scratch::read(folder / "o.vtk");
    BOOST_TEST(contains(vtk, "VERTICES 30 60\n"));
    BOOST_TEST(contains(vtk, "LINES 96 ")); // 90 contacts, 2 sides and 4 edges of the cell
    BOOST_TEST(!contains(vtk, "nan"));
    expect(run({"export", state, "-o", folder.at("o.vtk")}), 0); // written over
    for (const auto& [name, text] : {std::pair("mine.vtk", "# vtk DataFile Version 3.0\nmine\nASCII\n"),
                                     {"mine.csv", "# mine\nid,x,y,mass\n0,1,2,3\n"}}) {
        scratch::write(folder / name, text); // another program's
        expect(run({"export", state, "-o", folder.at(name)}), 64);
        BOOST_TEST(scratch::read(folder / name) == text);
    }
}

BOOST_FIXTURE_TEST_CASE(a_contact_given_twice_is_named_with_all_its_periods, scratch::InFolder) {
    auto file = nlohmann::json::parse(scratch::read(state_file(folder, "tri_uniform_30_1")));
    for (const auto& contact : file["contacts"]) {
        if (contact == nlohmann::json{0, 12, {0, 0, 1}}) {
            file["contacts"].push_back(contact);
            break;
        }
    }
    scratch::write(folder / "twice.json", file.dump());
    expect(run({"inspect", folder.at("twice.json")}), 65, {"twice.json", "0-12(0,0,1)", "each contact once"});
}

BOOST_FIXTURE_TEST_CASE(a_picture_shows_every_sphere_its_forces_and_three_cuts, scratch::InFolder) {
    for (const std::string name : {"box_uniform_30_1", "slab_uniform_30_1", "tri_uniform_30_1"}) {
        expect(run({"report", state_file(folder, name), "-o", folder.at(name)}), 0);
        const std::string svg = scratch::read(folder / name / ("forces_" + name + ".svg"));
        const auto count = [&svg](const std::string& word) { return scratch::count(svg, word); };
        const auto file = isostat::test::read_spheres(name);
        BOOST_TEST(count("class=\"force\"") == file["expected"]["contacts_with_force"].get<int>());
        BOOST_TEST(count("<circle") > 30 + 3 * 5);
        BOOST_TEST(count("<clipPath") == 3);
        BOOST_TEST(count("nan") + count("inf,") == 0);
    }
}

BOOST_FIXTURE_TEST_CASE(a_run_of_spheres_names_what_it_loads_by_axis, scratch::InFolder) {
    (void)state_file(folder, "box_uniform_30_1");
    const auto scene = [&](const std::string& load, const std::string& programme) {
        scratch::write(folder / "s.toml", "[packing]\nfile = \"box_uniform_30_1.json\"\n" + load +
                                              "[run]\ncertify = \"arcs\"\nmax_strain = 1e6\n[[programme]]\n" +
                                              programme);
    };
    scene("", "do = \"up\"\nequilibria = 2\n");
    const std::string out = folder.at("out");
    says(run({"run", folder.at("s.toml"), "-o", out}), 0, {"sigma3/sigma1", "eps3", "35 arcs"});
    BOOST_TEST(scratch::read(folder / "out/equilibria.csv")
                   .starts_with("# number,previous,segment,sigma3,ratio,eps1,eps2,eps3,L1,L2,L3,solid_fraction,"));
    says(run({"verify", folder.at("out/certificates/eq_000002.json")}), 0, {"proved"});
    says(run({"verify", out}), 0, {"ends of 35 of 35 proved, ways of 35", "3 of 3 proved"});
    says(run({"report", out, "--html"}), 0, {"sigma3/sigma1", "triaxial.dat", "trajectory.html"});
    const std::string page = scratch::read(std::filesystem::path(out) / "figures/trajectory.html");
    BOOST_TEST((page.find("volumetric strain") != std::string::npos));
    BOOST_TEST((page.find("\"balls\":[[") != std::string::npos));
    says(run({"report", out + "/states/last.json", "--html", "-o", folder.at("one")}), 0, {"forces_last.html"});
    BOOST_TEST((scratch::read(folder / "one/forces_last.html").find("\"equilibrium\":2,") != std::string::npos));
    BOOST_TEST((scratch::read(folder / "one/forces_last.html").find("json\">[{\"equilibrium\"") != std::string::npos));
    for (const auto& [load, words] :
         {std::pair{"tilt", "an axis, x to z, or a tilt, xy to yz"}, {"xy", "that tilt does not move"}}) {
        scene(fmt::format("[load]\nloaded = \"{}\"\n", load), "do = \"up\"\nequilibria = 2\n");
        expect(run({"run", folder.at("s.toml"), "-o", folder.at("not")}), 65, {words, load});
    }
    scene("[load]\nloaded = \"x\"\n", "do = \"to\"\nto = -1\n");
    expect(run({"run", folder.at("s.toml"), "-o", folder.at("not")}), 65, {"sigma1/sigma3", "not negative"});
}

BOOST_FIXTURE_TEST_CASE(what_takes_disks_only_says_so_in_one_sentence, scratch::InFolder) {
    const std::string state = state_file(folder, "box_uniform_30_1");
    expect(run({"report", scratch::data("cells/tilt_16.json"), "--html", "-o", folder.at("no")}), 64,
           {"a view of spheres"});
    BOOST_TEST(!std::filesystem::exists(folder / "no"));
    expect(run({"import", state, "-o", folder.at("t.json")}), 65, {"spheres"});
    says(run({"snap", state, "-o", folder.at("t.json")}), 0, {"h = 0, k = 0, 6 rattlers", "snap      vertex"});
}
