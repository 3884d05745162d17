// isostat import and isostat export, as a user runs them.
#include "cli/program.hpp"

#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

using namespace program;
using namespace isostat;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string crafted_files = ISOSTAT_EXAMPLES "/packings/";

/// The sample of 100 disks as soft grains would leave it: every length but the radii is shorter by this part.
struct Soft {
    State state = read_state(scratch::data("vertex100.txt")).state;
    Packing packing = state.packing;
    std::string box;

    explicit Soft(double part) {
        for (double& x : packing.q) {
            x *= 1 - part;
        }
        box = fmt::format("0:{},0:{}", packing.length(0), packing.length(1));
    }
    /// Rows with ids 1, 2, ..., the last disk first.
    [[nodiscard]] std::string table() const {
        std::string text = "id,x,y,radius\n";
        for (std::size_t i = packing.radius.size(); i-- > 0;) {
            text += fmt::format("{},{},{},{}\n", i + 1, packing.q[2 * i], packing.q[2 * i + 1], packing.radius[i]);
        }
        return text;
    }
    /// The contacts as a dump of style local, with a force 0 where disks only nearly touch; `left_out` of them.
    [[nodiscard]] std::string forces(std::size_t left_out) const {
        std::string rows;
        int count = 0;
        for (const Contact& c : state.contacts) {
            if (c.kind == ContactKind::disk_disk && left_out-- != 0) {
                rows += fmt::format("{} {} {} 0.5\n", ++count, c.j + 1, c.i + 1);
            }
        }
        return fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n{}\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n0 1\n"
                           "ITEM: ENTRIES index c_i[1] c_i[2] c_f\n{}{} 1 50 0\n",
                           count + 1, rows, count + 1);
    }
};

/// Runs import on a text; nothing is written unless the status is 0.
Outcome import_text(const scratch::Folder& folder, const std::string& text, std::vector<std::string> options) {
    scratch::write(folder / "p.txt", text);
    options.insert(options.begin(), {"import", folder.at("p.txt"), "-o", folder.at("s.json")});
    fs::remove(folder / "s.json");
    Outcome outcome = run(options);
    BOOST_TEST(fs::exists(folder / "s.json") == (outcome.status == 0));
    BOOST_TEST(!fs::exists(folder / "s.json.part"));
    return outcome;
}

} // namespace

BOOST_AUTO_TEST_CASE(soft_grains_end_at_the_vertex_that_they_came_from) {
    for (const double part : {1e-12, 1e-6, 1e-4}) {
        BOOST_TEST_INFO_SCOPE("overlap " << part);
        const scratch::Folder folder;
        const Soft soft(part);
        const std::string moved = folder.at("moved.csv");
        const auto answer = json_of(import_text(folder, soft.table(), {"--box", soft.box, "--json", "--moved", moved}));
        BOOST_TEST(answer.at("verdict") == "proved");
        BOOST_TEST(contains(answer.at("contacts").get<std::string>(), "188 carry a force, those of the file"));
        const double backbone = answer.at("moved").at("backbone").get<double>();
        BOOST_TEST(backbone < 25 * part + 1e-11);
        BOOST_TEST(backbone > 5 * part);
        BOOST_TEST(std::ranges::count(scratch::read(moved), '\n') == 101);
        // The vertex is that of the sample: its file has the disks in the opposite order.
        const Packing found = read_state(folder / "s.json").state.packing;
        for (std::size_t a = 0; a < 2; ++a) {
            BOOST_TEST(std::abs(found.length(static_cast<int>(a)) - soft.state.packing.length(static_cast<int>(a))) <
                       1e-11);
        }
        expect(run({"certify", folder.at("s.json"), "-o", folder.at("c.json")}), 0);
    }
}

BOOST_FIXTURE_TEST_CASE(an_imported_state_runs_under_its_load, scratch::InFolder) {
    const Soft soft(1e-6);
    expect(import_text(folder, soft.table(), {"--box", soft.box, "--stress", "2,2.01", "--load", "true"}), 0);
    const State state = read_state(folder / "s.json").state;
    BOOST_TEST(state.load.stress[0] == 2.0);
    BOOST_TEST(state.load.stress[1] == 2 * (2.01 / 2));
    BOOST_TEST((state.load.kind == LoadKind::true_stress));
    ran(folder, scene_from("s.json", up(1)));
}

/// `export.text` of YADE 2023.02a wrote the file, with six digits: 20 disks (seed 1), stiffness 1e6, its walls at
/// `box`.
BOOST_FIXTURE_TEST_CASE(soft_grains_of_yade_end_at_the_vertex_that_they_came_from, scratch::InFolder) {
    const std::string out = folder.at("s.json"), start = folder.at("start.json");
    const std::string box = "0:6.797743980394215,0:6.804741233269178";
    expect(run({"prepare", folder.file("prepared.toml", "[packing]\ndisks = 20\n"), "-o", start, "-q"}), 0);
    const State from = read_state(start).state;
    for (const std::string contacts : {"plateau", "nearest"}) {
        BOOST_TEST_INFO_SCOPE(contacts);
        const auto answer = json_of(import_text(folder, scratch::read(scratch::data("yade20.txt")),
                                                {"--box", box, "--contacts", contacts, "--json"}));
        BOOST_TEST(answer.at("file_format") == "table");
        BOOST_TEST(contains(answer.at("contacts").get<std::string>(), "34 carry a force"));
        const double moved = answer.at("moved").at("backbone").get<double>();
        BOOST_TEST(moved > 1e-6); // overlaps and digits
        BOOST_TEST(moved < 1e-4);
        std::vector<Contact> found = read_state(out).state.contacts, expected = from.contacts;
        std::ranges::sort(found);
        std::ranges::sort(expected);
        BOOST_TEST((found == expected));
        expect(run({"certify", out, "-o", folder.at("c.json")}), 0);
    }
    ran(folder, scene_from("s.json", up(2)));
}

BOOST_FIXTURE_TEST_CASE(forces_name_the_contacts_by_their_ids, scratch::InFolder) {
    const Soft soft(1e-6);
    const std::string dump = folder.at("pairs.dump");
    const std::vector<std::string> options{
        "--box", soft.box, "--contacts", dump, "--contact-columns", "c_i[1],c_i[2],c_f"};
    scratch::write(dump, soft.forces(1000));
    says(import_text(folder, soft.table(), options), 0, {"188 carry a force, those of the file"});
    scratch::write(dump, soft.forces(100));
    expect(import_text(folder, soft.table(), options), 1,
           {"moving: the contacts of the file", "k = ", "--contacts nearest"});
    scratch::write(dump, scratch::replaced(soft.forces(1000), "1 50 0\n", "1 501 0\n"));
    expect(import_text(folder, soft.table(), options), 65, {"pairs.dump:", "c_i[2]", "501", "id of a disk"});
    expect(import_text(folder, soft.table(), {"--box", soft.box, "--contacts", dump, "--contact-columns", "a,b,c"}), 65,
           {"no column 'a'", "c_i[1]"});
    expect(import_text(folder, soft.table(), {"--box", soft.box, "--contacts", dump}), 64, {"--contact-columns"});
}

BOOST_FIXTURE_TEST_CASE(what_no_vertex_is_near_is_refused_and_nothing_is_written, scratch::InFolder) {
    const Soft soft(1e-6);
    expect(import_text(folder, soft.table(), {"--box", "0:20,0:20"}), 65, {"no disk is near the right wall", "--box"});
    expect(import_text(folder, soft.table(), {"--box", "0:9,0:9"}), 65, {"centre between the walls"});
    expect(import_text(folder, soft.table(), {}), 65, {"walls", "--box"});
    const Soft deep(0.2);
    const std::string moved = folder.at("moved.csv");
    expect(import_text(folder, deep.table(), {"--box", deep.box, "--moved", moved}), 65,
           {"overlap by", "expected at most"});
    expect(import_text(folder, scratch::replaced(soft.table(), "radius", "size"), {"--box", soft.box}), 65,
           {"--radius"});
    expect(import_text(folder, "x,y\n1,1\n", {"--box", "0:2,0:2"}), 65, {"--radius"});
    std::string lattice = "x,y,r\n";
    for (int k = 0; k < 9; ++k) {
        lattice += fmt::format("{},{},1\n", 1 + 2 * (k % 3), 1 + 2 * (k / 3));
    }
    expect(import_text(folder, lattice, {"--box", "0:6,0:6"}), 1, {"isostatic at no threshold", "--contacts nearest"});
    expect(import_text(folder, lattice, {"--box", "0:6,0:6", "--threshold", "0"}), 1, {"h = 4", "isostatic one"});
    expect(import_text(folder, lattice, {"--box", "0:6,0:6", "--moved", moved}), 1, {"isostatic at no threshold"});
    BOOST_TEST(!fs::exists(moved));
    expect(import_text(folder, soft.table(), {"--box", soft.box, "--stress", "1"}), 64, {"--stress", "S1,S2"});
    expect(import_text(folder, soft.table(), {"--box", soft.box, "--walls", "none"}), 64, {"--walls", "box"});
    expect(import_text(folder, state_text(soft.state), {}), 65, {"is a state of this program", "--jitter"});
}

BOOST_FIXTURE_TEST_CASE(a_jitter_makes_equal_disks_different, scratch::InFolder) {
    const std::string lattice = "x,y,r\n1,1,1\n3,1,1\n1,3,1\n3,3,1\n";
    expect(import_text(folder, lattice, {"--box", "0:4,0:4", "--contacts", "nearest", "--jitter", "1e-3"}), 0);
    const State state = read_state(folder / "s.json").state;
    BOOST_TEST(state.packing.radius[0] != state.packing.radius[1]);
    BOOST_TEST(std::abs(state.packing.radius[0] - 1) <= 1e-3);
    // A state keeps its load.
    const std::string sample = ISOSTAT_EXAMPLES "/ties/equal-pair.json", out = folder.at("p.json");
    scratch::write(folder / "grid.json", scratch::replaced(state_text(state), "\"nominal\",\"stress\":[1.0,1.0]",
                                                           "\"true\",\"stress\":[3.0,3.5]"));
    expect(run({"import", folder.at("grid.json"), "--jitter", "1e-6", "--contacts", "nearest", "-o", out}), 0);
    const State again = read_state(out).state;
    BOOST_TEST(again.load.stress[0] == 3.0);
    BOOST_TEST(again.load.stress[1] == 3.5);
    BOOST_TEST((again.load.kind == LoadKind::true_stress));
    BOOST_TEST(again.packing.radius[0] != state.packing.radius[0]);
    fs::remove(out);
    expect(run({"import", sample, "-o", out}), 65, {"is a state", "--jitter"});
}

BOOST_FIXTURE_TEST_CASE(crafted_packings_keep_their_contacts_or_are_refused, scratch::InFolder) {
    const std::string out = folder.at("s.json");
    expect(run({"import", crafted_files + "two_disks.toml", "-o", out}), 0);
    expect(run({"inspect", out}), 0);
    BOOST_TEST(read_state(out).state.contacts.size() == 6U);
    fs::remove(out);
    expect(run({"import", crafted_files + "square_lattice_2.toml", "-o", out}), 1, {"h = 2", "isostatic"});
    expect(run({"import", crafted_files + "two_disks_past_the_limit.toml", "-o", out}), 1, {"force", "1-bottom"});
    expect(run({"import", crafted_files + "two_disks.toml", "-o", out, "--jitter", "1e-6"}), 65,
           {"crafted", "--jitter"});
    BOOST_TEST(!fs::exists(out));
}

BOOST_FIXTURE_TEST_CASE(a_vertex_text_says_its_walls_and_none_that_is_refuted_is_written, scratch::InFolder) {
    const std::string from = scratch::data("vertex100.txt"), out = folder.at("out.json");
    for (const auto& [option, value] : {std::pair{"--cell", "fixed"}, {"--walls", "fixed"}}) {
        expect(run({"import", from, "-o", out, option, value}), 65, {"vertex text", option});
        BOOST_TEST(!std::filesystem::exists(out));
    }
}

BOOST_FIXTURE_TEST_CASE(what_is_exported_comes_back_as_the_same_vertex, scratch::InFolder) {
    const std::string from = scratch::data("vertex100.txt"), back = folder.at("back.json");
    const State state = read_state(from).state;
    const std::string box = fmt::format("0:{},0:{}", state.packing.length(0), state.packing.length(1));
    for (const std::string end : {"data", "xyz", "csv"}) {
        BOOST_TEST_INFO_SCOPE(end);
        const std::string file = (folder / ("a." + end)).string();
        expect(run({"export", from, "-o", file}), 0);
        const Outcome outcome = done(run({"import", file, "--box", box, "-o", back, "--json"}));
        BOOST_TEST(nlohmann::json::parse(outcome.out).at("moved").at("backbone").get<double>() < 1e-11);
        expect(run({"inspect", file}), 65, {"isostat import"});
    }
    expect(run({"export", from, "-o", folder.at("a.pdf")}), 64, {".data", ".vtk"});
    expect(run({"export", folder.path().string(), "-o", folder.at("b.xyz")}), 65, {"states/eq_"});
}

BOOST_FIXTURE_TEST_CASE(a_run_is_exported_as_frames_with_displacements, scratch::InFolder) {
    expect(run({"export", ran(folder, scene_from(scratch::data("vertex100.txt"), up(2))), "-o", folder.at("run.xyz")}),
           0);
    const std::string text = scratch::read(folder / "run.xyz");
    const std::size_t second = text.find("\n100\n");
    BOOST_REQUIRE(second != std::string::npos);
    BOOST_TEST(text.find("\n100\n", second + 1) == std::string::npos);
    BOOST_TEST(contains(text, ":displacement:R:3"));
    const Packing last = read_state(folder / "run/states/eq_000002.json").state.packing;
    ForeignOptions options{.walls = ForeignWalls::box};
    const Packing read = read_foreign(folder / "run.xyz", options).packing;
    BOOST_TEST((read.q == last.q));
    BOOST_TEST((read.radius == last.radius));
}

namespace {

const std::string sphere_files = scratch::data("spheres/");
const std::string box_of_100 = "0:13.995847242391138,0:15.063850881057951,0:13.924292277825588";

} // namespace

/// Rounded to 9 to 12 digits and put into the cell: the contacts are those of the originals.
BOOST_FIXTURE_TEST_CASE(spheres_of_another_program_are_imported_with_the_contacts_that_they_have, scratch::InFolder) {
    const std::string out = folder.at("s.json");
    for (const auto& [file, options, contacts, rattlers, carrying] :
         {std::tuple{"box_uniform_100_1.txt", std::vector<std::string>{"--box", box_of_100}, 303, 7, 282},
          {"ortho_uniform_30_1.xyz", {"--cell", "rectangular"}, 90, 2, 84},
          {"tri_bidisperse_60_1.dump", {}, 183, 3, 174}}) {
        BOOST_TEST_INFO_SCOPE(file);
        const auto answer = json_of(run(plus({"import", sphere_files + file, "-o", out, "--json"}, options)));
        BOOST_TEST(answer.at("verdict") == "proved");
        BOOST_TEST(answer.at("moved").at("backbone").get<double>() < 1e-7);
        const State state = read_any_state(out, Dimensions::any).state;
        BOOST_TEST(state.contacts.size() == static_cast<std::size_t>(contacts));
        BOOST_TEST(state.packing.dimension == 3);
        const auto found = json_of(run({"inspect", out, "--json"}));
        has(found, {{"N_f", contacts}, {"h", 0}, {"k", 0}, {"backbone", carrying}});
        BOOST_TEST(found.at("rattlers").size() == static_cast<std::size_t>(rattlers));
        fs::remove(out);
    }
}

BOOST_FIXTURE_TEST_CASE(what_is_not_written_for_spheres_is_refused_by_name, scratch::InFolder) {
    const std::string file = sphere_files + "ortho_uniform_30_1.xyz", out = folder.at("s.json");
    expect(run({"import", file, "-o", out, "--contacts", "nearest"}), 64, {"packing of spheres", "--contacts"});
    expect(run({"import", file, "-o", out, "--jitter", "1e-6"}), 64, {"packing of spheres", "--jitter"});
    expect(run({"import", file, "-o", out, "--stress", "1,2"}), 64, {"--stress", "three positive numbers"});
    expect(run({"import", file, "-o", out, "--dimension", "2"}), 65, {"ortho_uniform_30_1.xyz:", "z of disk"});
    expect(run({"import", sphere_files + "box_uniform_100_1.txt", "-o", out, "--box", "0:14,0:15.1"}), 65,
           {"4 bounds", "expected 6"});
    says(run({"snap", file, "-o", out}), 1, {"snap      moving"}); // half of its contacts do not overlap
    BOOST_TEST(!fs::exists(out));
}
