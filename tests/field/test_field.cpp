// Files of the kinds that people bring: README.md has the table.

#include "cli/program.hpp"

#include <isostat/foreign/foreign.hpp>

namespace {

using namespace program;

/// "FILE words": the file among those of the table.
program::Outcome in_field(const std::string& command, const std::string& file, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {command, scratch::data("field/" + file)});
    return run(more);
}

/// The packing of sixteen disks that most files hold: N = 33 on this range of thresholds.
void expect_base(const std::string& file, std::vector<std::string> more, double digits = 1e-11) {
    BOOST_TEST_INFO_SCOPE(file);
    more.insert(more.end(), {"--cell", "full", "--json"});
    const auto found = json_of(in_field("plateau", file, more));
    const auto& widest = found["widest"];
    has(widest, {{"N", 33}, {"counts/h", 0}, {"counts/k", 0}});
    BOOST_TEST(widest["contacts"].size() == 33U);
    BOOST_TEST(found["smallest_gap_of"] == "9-13");
    BOOST_TEST(std::abs(widest["first"].get<double>() + 8.34698575139887e-5) < digits);
    BOOST_TEST(std::abs(widest["last"].get<double>() - 0.00265559752709983) < digits);
}

const std::vector<std::string> cell{"--lattice", "9.539360729179307,9.569336627546415,0.06305756549215252"};

std::vector<std::string> with_cell(std::vector<std::string> more) {
    more.insert(more.end(), cell.begin(), cell.end());
    return more;
}

/// Every word in the message of a file that is refused.
void refused(const std::string& file, const std::vector<std::string>& more, const std::vector<std::string>& words) {
    BOOST_TEST_INFO_SCOPE(file);
    expect(in_field("plateau", file, more), 65, words);
}

/// The base with a list of contacts.
program::Outcome snapped(const std::string& contacts, const std::string& columns, std::vector<std::string> more,
                         const scratch::Folder& folder) {
    more.insert(more.end(), {"--contacts", scratch::data("field/" + contacts), "--contact-columns", columns, "--cell",
                             "tilted", "-o", folder.at("state.json"), "--json"});
    return in_field("snap", "00_base16.dump", more);
}

/// Optimal packings of circles in the unit square: the radius is half less the largest coordinate.
std::vector<std::string> in_square(const char* walls, const char* radius) {
    return {"--columns", "-,x,y", "--radius", radius, "--walls", walls, "--box=-0.5:0.5,-0.5:0.5"};
}
constexpr const char* radius_of_7 = "0.174457630187009438959427204500";
constexpr const char* radius_of_10 = "0.148204322565228798668007362743";
constexpr const char* radius_of_13 = "0.133993513499008491414263236065";
constexpr const char* radius_of_19 = "0.112265437570936304737847917535";

} // namespace

BOOST_AUTO_TEST_CASE(kind_1_a_tilted_cell_and_the_text_between_braces) {
    expect_base("00_base16.xyz", {});
    expect_base("01_braces.txt", {});
}

BOOST_AUTO_TEST_CASE(kind_2_a_box_that_is_flipped_is_the_same_path) {
    for (const char* series : {"02_flip.toml", "02_noflip.toml"}) {
        const auto found = json_of(in_field("compare", series, {"--bundle", "0", "--json"}));
        BOOST_TEST(found["counts"]["same"] == 2);
    }
}

BOOST_AUTO_TEST_CASE(kind_3_thresholds_that_nobody_asked_for_do_not_count) {
    says(in_field("plateau", "03_soft14.xyz", {"--cell", "diagonal", "--thresholds=-1e-9:1e-9"}), 1,
         {"backbone isostatic, proved  at no threshold of [-1e-09, 1e-09]", "h = 3"});
    says(in_field("plateau", "03_soft14.xyz", {"--cell", "diagonal", "--thresholds=-4e-3:-3.5e-3"}), 0,
         {"-0.0040000000000000001 <= threshold <= -0.0035"});
    // Below the rounding no list is known.
    expect(in_field("plateau", "05_torus11.xyz", {"--thresholds=-1e-17:1e-17"}), 2);
}

BOOST_FIXTURE_TEST_CASE(kind_4_circles_in_a_square, scratch::InFolder) {
    auto more = in_square("fixed", radius_of_13);
    more.emplace_back("--json");
    const auto thirteen = json_of(in_field("plateau", "04_square13.txt", more), 1);
    has(thirteen, {{"widest/N", 25}, {"widest/rattlers", 1}, {"widest/counts/N_f", 24}, {"widest/counts/h", 1}});
    BOOST_TEST(thirteen["isostatic"].empty());
    BOOST_TEST(thirteen["rounding"].get<double>() < 1e-15);
    more = in_square("fixed", radius_of_19);
    more.emplace_back("--json");
    const auto nineteen = json_of(in_field("plateau", "04_square19.txt", more), 1);
    BOOST_TEST(nineteen["widest"]["N"] == 37);
    BOOST_TEST(nineteen["widest"]["rattlers"] == 2);
    // The size alone moves: 21 = 2 x 10 + 1 contacts, and the square of this size is jammed.
    for (const auto& [file, radius, contacts] :
         {std::tuple{"04_square10.txt", radius_of_10, 21}, {"04_square13.txt", radius_of_13, 25}}) {
        const std::string state = folder.at(file) + ".json";
        more = in_square("square", radius);
        more.insert(more.end(), {"-o", state});
        says(in_field("import", file, more), 0, {"their size alone moves", "proved"});
        const auto found = json_of(run({"inspect", state, "--json"}));
        has(found, {{"box/N", contacts}, {"box/h", 1}, {"box/k", 0}, {"box/jammed/collective/verdict", "proved"}});
    }
}

BOOST_FIXTURE_TEST_CASE(kind_4_a_hyperstatic_packing_is_not_isostatic_by_rounding_wherever_it_is, scratch::InFolder) {
    isostat::ForeignOptions options{.columns = {"-", "x", "y"}};
    options.size = isostat::SizeStatement{isostat::SizeMeaning::radius, "", std::stod(radius_of_13)};
    const isostat::Packing read = isostat::read_foreign(scratch::data("field/04_square13.txt"), options).packing;
    const std::string file = folder.at("p.txt");
    for (int k = 0; k < 24; ++k) {
        const double scale = 0.3 + 0.37 * k, shift = 0.1 * k * k, sign = k % 2 == 0 ? 1 : -1;
        const int digits = k % 3 == 0 ? 17 : k % 3 == 1 ? 12 : 8;
        std::string text = "x y r\n";
        for (std::size_t i = 0; i < read.radius.size(); ++i) {
            text += fmt::format("{:.{}g} {:.{}g} {:.{}g}\n", sign * scale * read.q[2 * i] + shift, digits,
                                scale * read.q[2 * i + 1] - shift, digits, scale * read.radius[i], digits);
        }
        scratch::write(file, text);
        const std::string box = fmt::format("--box={:.17g}:{:.17g},{:.17g}:{:.17g}", shift - 0.5 * scale,
                                            shift + 0.5 * scale, -shift - 0.5 * scale, -shift + 0.5 * scale);
        const Outcome outcome = run({"plateau", file, "--walls", "fixed", box, "--json"});
        BOOST_TEST_INFO_SCOPE("placement " << k << ", " << digits << " digits");
        expect(outcome, 1);
        BOOST_TEST(
            (digits == 8 || nlohmann::json::parse(outcome.out).at("widest").at("N") == 25)); // the next gap is 4.9e-5
    }
}

BOOST_FIXTURE_TEST_CASE(kind_4_import_into_walls_that_stay_writes_the_list_and_inspect_says_whether_it_is_jammed,
                        scratch::InFolder) {
    const std::string state = folder.at("fixed.json"), moved = folder.at("moved.csv");
    auto more = in_square("fixed", radius_of_7);
    more.insert(more.end(), {"-o", state, "--moved", moved});
    says(in_field("import", "04_square7.txt", more), 0,
         {"7 disks, 1 rattlers by coordination, 14 contacts", "written"});
    BOOST_TEST(contains(scratch::read(moved), ",0,1\n")); // the rattler, which has not moved
    const auto seven = json_of(run({"inspect", state, "--json"}), 1)["box"];
    has(seven, {{"grains", 6}, {"h", 2}, {"k", 0}, {"jammed/collective/if_contacts_close/verdict", "proved"}});
    for (const auto& [file, radius, grains, h] : {std::tuple{"04_square10.txt", radius_of_10, 10, 1},
                                                  {"04_square13.txt", radius_of_13, 12, 1},
                                                  {"04_square19.txt", radius_of_19, 17, 3}}) {
        more = in_square("fixed", radius);
        more.insert(more.end(), {"-o", state, "--json"});
        const auto written = json_of(in_field("import", file, more));
        BOOST_TEST(written["verdict"].is_null());
        BOOST_TEST(written["load"].is_null());
        const auto box = json_of(run({"inspect", state, "--json"}), 1)["box"];
        BOOST_TEST(box["grains"] == grains);
        BOOST_TEST(box["h"] == h);
        const auto& answer = box["jammed"]["collective"];
        BOOST_TEST(answer["verdict"] == (h == 1 ? "proved" : "undecided")); // h = 1: the size of the square closes it
        BOOST_TEST(answer.contains("if_contacts_close") == (h > 1));
        if (h > 1) {
            BOOST_TEST(answer["if_contacts_close"]["verdict"] == "proved");
        }
    }
    for (const auto& [option, value] : {std::pair{"--contacts", "nearest"}, {"--jitter", "1e-9"}}) {
        more = in_square("fixed", radius_of_10);
        more.insert(more.end(), {"-o", state, option, value});
        expect(in_field("import", "04_square10.txt", more), 64, {option, "in walls or a cell that stays"});
    }
}

BOOST_AUTO_TEST_CASE(kind_4_a_fixed_square_counts_no_rattlers_and_exact_numbers_prove_it_jammed) {
    const auto found = json_of(in_field("inspect", "04_square7_fixed.json", {"--json"}), 1);
    BOOST_TEST(found["k"] == 2); // of all disks
    has(found, {{"box/grains", 6}, {"box/h", 2}, {"box/k", 0}, {"box/jammed/collective/verdict", "undecided"}});
    BOOST_TEST(contains(found["box"]["jammed"]["collective"]["reason"], "exact numbers"));
    const auto& closed = found["box"]["jammed"]["collective"]["if_contacts_close"];
    BOOST_TEST(closed["verdict"] == "proved");
    BOOST_TEST(closed["contacts"] == 14);
    BOOST_TEST(closed["within"].get<double>() > 1e-5);
    BOOST_TEST(closed["within"].get<double>() < 2e-4);
    says(in_field("inspect", "04_square7_fixed.json"), 1,
         {"jammed collectively      undecided: h = 2", "  if contacts close      proved, of each packing within 0.0001",
          "in which the 14 contacts all close; whether there is one is not asked"});
    const auto exact = json_of(in_field("inspect", "04_square7_exact.toml", {"--json"}));
    BOOST_TEST(exact["jammed"]["collective"] == "proved");
    BOOST_TEST(exact["jammed"]["strict"].is_null());
    BOOST_TEST(exact["jammed"]["disks"] == 6);
}

BOOST_FIXTURE_TEST_CASE(kind_4_a_square_whose_walls_stay_is_jammed_by_its_size, scratch::InFolder) {
    // The ten circles again, every wall fixed in the state: its size gives the self-stress.
    auto more = in_square("square", radius_of_10);
    more.insert(more.end(), {"-o", folder.at("ten.json")});
    expect(in_field("import", "04_square10.txt", more), 0);
    auto state = nlohmann::json::parse(scratch::read(folder / "ten.json"));
    state["walls"]["upper"] = {"fixed", "fixed"};
    state.erase("forces");
    state.erase("load");
    const auto found = json_of(run({"inspect", folder.file("fixed.json", state.dump()), "--json"}), 1);
    BOOST_TEST(found["box"]["h"] == 1);
    BOOST_TEST(found["box"]["jammed"]["collective"]["verdict"] == "proved");
    state["contacts"].erase(state["contacts"].begin()); // one less holds nothing
    const auto loose = nlohmann::json::parse(run({"inspect", folder.file("loose.json", state.dump()), "--json"}).out);
    BOOST_TEST(loose["box"]["jammed"]["collective"]["verdict"] == "undecided");
    BOOST_TEST(loose["box"]["jammed"]["collective"]["if_contacts_close"]["verdict"] == "refuted");
}

BOOST_FIXTURE_TEST_CASE(kind_5_gaps_and_forces_below_the_digits_are_not_told_from_0, scratch::InFolder) {
    for (const char* lattice :
         {"05_torus3_triangular.xyz", "05_torus_n7_c1.xyz", "05_torus_n8_c2.xyz", "05_torus11.xyz"}) {
        BOOST_TEST(json_of(in_field("plateau", lattice, {"--json"}), 1)["isostatic"].empty(), lattice);
    }
    const std::string state = folder.at("seven.json");
    says(in_field("import", "05_torus_n7_c1.xyz", {"--cell", "isotropic", "-o", state}), 2,
         {"8 gaps", "with these gaps closed N = 21 and h = 8"});
    const auto found = json_of(run({"inspect", state, "--json"}), 2);
    // Of the doubles it is no answer; with the 8 gaps closed it is the triangular lattice.
    for (const char* kind : {"local", "collective", "strict"}) {
        const auto& answer = found["cell"]["jammed"][kind];
        BOOST_TEST(answer["verdict"] == "undecided", kind);
        BOOST_TEST(answer["if_contacts_close"]["verdict"] == "proved", kind);
        BOOST_TEST(answer["if_contacts_close"]["contacts"] == 21, kind);
    }
    // A copy with other radii says so, in import and in inspect.
    const std::string copy = folder.at("copy.json");
    says(in_field("import", "05_torus3_triangular.xyz", {"--cell", "isotropic", "--jitter", "1e-9", "-o", copy}), 0,
         {"this is a copy with other radii"});
    says(run({"inspect", copy}), 0, {"copy                     of", "may be others of the file"});
}

BOOST_FIXTURE_TEST_CASE(kind_5_an_imported_state_says_what_its_file_cannot_tell, scratch::InFolder) {
    const std::string state = folder.at("s.json");
    for (const auto& [name, gaps] :
         {std::pair{"05_torus_n7_c1.xyz", 8}, {"05_torus_n8_c2.xyz", 1}, {"05_torus11.xyz", 1}}) {
        BOOST_TEST_INFO_SCOPE(name);
        const auto answer = json_of(in_field("import", name, {"--cell", "isotropic", "-o", state, "--json"}), 2);
        BOOST_TEST(answer.at("verdict") == "undecided");
        BOOST_TEST(static_cast<int>(answer.at("untold").at("gaps").size()) == gaps);
        BOOST_TEST(answer.at("untold").at("verdict_of_the_doubles") == "proved");
        says(run({"inspect", state}), 2,
             {"isostatic equilibrium    undecided: ", "jammed strictly          undecided: "});
        says(run({"certify", state, "-o", folder.at("c.json")}), 2,
             {"undecided      the claims are of the stored doubles"});
    }
    // A forged rounding is no way round it.
    std::string text = scratch::read(state);
    text.replace(text.find("\"rounding\":") + 11, 1, "-");
    scratch::write(state, text);
    expect(run({"inspect", state}), 65, {});
}

BOOST_FIXTURE_TEST_CASE(kind_5_a_lattice_in_a_cell_that_stays_is_jammed_if_its_contacts_close, scratch::InFolder) {
    const std::string state = folder.at("lattice.json");
    for (const auto& [file, contacts, strict] : {std::tuple{"05_torus3_triangular.xyz", 9, "proved"},
                                                 {"05_torus_n7_c1.xyz", 21, "proved"},
                                                 {"05_torus_n8_c2.xyz", 16, "refuted"},
                                                 {"05_torus11.xyz", 22, "refuted"}}) {
        BOOST_TEST_INFO_SCOPE(file);
        says(in_field("import", file, {"--cell", "fixed", "--threshold", "1e-6", "-o", state}), 0,
             {"written", "inspect says whether"});
        const auto found = json_of(run({"inspect", state, "--json"}), 1)["cell"];
        BOOST_TEST(found["moves"].empty());
        for (const auto& [kind, verdict] : {std::pair{"collective", "proved"}, {"strict", strict}}) {
            const auto& answer = found["jammed"][kind];
            has(answer, {{"verdict", "undecided"},
                         {"if_contacts_close/verdict", verdict},
                         {"if_contacts_close/contacts", contacts}});
        }
    }
}

BOOST_AUTO_TEST_CASE(kind_5_published_contact_counts_on_the_hexagonal_torus) {
    for (const auto& [file, contacts] : {std::pair{"05_torus3_triangular.xyz", 9},
                                         {"05_torus_n7_c1.xyz", 21},
                                         {"05_torus_n8_c2.xyz", 16},
                                         {"05_torus11.xyz", 22}}) {
        const auto found = nlohmann::json::parse(in_field("plateau", file, {"--thresholds=-1e-6:1e-6", "--json"}).out);
        BOOST_TEST(found["widest"]["N"] == contacts, file);
    }
}

BOOST_AUTO_TEST_CASE(kind_6_a_column_that_comes_twice_and_agrees) {
    expect_base("06_type_twice.dump", {});
}

BOOST_FIXTURE_TEST_CASE(kind_7_vectors_of_forces, scratch::InFolder) {
    for (const auto& [file, columns] : {std::pair{"07_force_vector.dump", "c_1[1],c_1[2],c_2[1],c_2[2],c_2[3]"},
                                        {"07_positions_ids_force.dump", "c_cpl[7],c_cpl[8],c_cpl[10],c_cpl[11]"},
                                        {"07_contacts_fx_fy.csv", "i,j,fx,fy"}}) {
        const auto found = json_of(snapped(file, columns, {"--stress", "0.001,0.001"}, folder));
        BOOST_TEST(found["N"] == 33, file);
        BOOST_TEST(found["h"] == 0);
        BOOST_TEST(found["forces"]["rest"].get<double>() < 1e-11);
        BOOST_TEST(contains(found["contacts"], "normal parts"));
    }
    const auto component = json_of(snapped("07_force_vector.dump", "c_1[1],c_1[2],c_2[1]", {}, folder), 1);
    BOOST_TEST(contains(component["contacts"], "19 more are negative: is c_2[1] a component?"));
    // Friction, and components in the wrong order.
    scratch::write(folder / "friction.csv",
                   scratch::replaced(scratch::read(scratch::data("field/07_contacts_fx_fy.csv")),
                                     "1,8,0.001957927890048041,-0.00150217509421125",
                                     "1,8,0.002957927890048041,-0.00050217509421125"));
    expect(in_field("snap", "00_base16.dump",
                    {"--contacts", folder.at("friction.csv"), "--contact-columns", "i,j,fx,fy", "--cell", "tilted",
                     "-o", folder.at("state.json")}),
           65, {"the tangential force of 0-7", "without friction"});
    expect(snapped("07_contacts_fx_fy.csv", "i,j,fy,fx", {}, folder), 65, {"07_contacts_fx_fy.csv"});
}

BOOST_FIXTURE_TEST_CASE(kind_8_forces_in_other_units_and_a_column_of_something_else, scratch::InFolder) {
    const auto units = json_of(snapped("00_base16_contacts.csv", "id1,id2,fn", {}, folder));
    BOOST_TEST(std::abs(units["forces"]["factor"].get<double>() - 1e-3) < 1e-12);
    BOOST_TEST(units["forces"]["rest_in_units"].get<double>() < 1e-11);
    BOOST_TEST(contains(units["forces"]["units"], "other units, or another load"));
    const auto right = json_of(snapped("00_base16_contacts.csv", "id1,id2,fn", {"--stress", "1e-3,1e-3"}, folder));
    BOOST_TEST(right["forces"]["units"] == "");
    std::string table = scratch::read(scratch::data("field/00_base16_contacts.csv")), distances;
    int row = 0;
    for (std::size_t at = 0; at < table.size(); at = table.find('\n', at) + 1, ++row) {
        const std::string line = table.substr(at, table.find('\n', at) - at);
        distances += row == 0 ? line + "\n" : line.substr(0, line.rfind(',')) + (row % 2 == 0 ? ",2.0\n" : ",2.4\n");
    }
    const auto found = json_of(in_field("snap", "00_base16.dump",
                                        {"--contacts", folder.file("distances.csv", distances), "--contact-columns",
                                         "id1,id2,fn", "--cell", "tilted", "-o", folder.at("state.json"), "--json"}));
    BOOST_TEST(contains(found["forces"]["units"], "is the column that of the forces?"));
    // The same in a series, against its law.
    for (const char* file : {"02_flip_disks_same.dump", "02_flip_contacts.dump", "02_flip_frames.csv"}) {
        scratch::write(folder / file, scratch::read(scratch::data(std::string("field/") + file)));
    }
    const std::string manifest = scratch::read(scratch::data("field/02_noflip.toml"));
    const auto frames =
        json_of(run({"compare", folder.file("ten.toml", scratch::replaced(manifest, "stiffness = 1", "stiffness = 10")),
                     "--bundle", "0", "--json"}),
                1)["frames"];
    BOOST_TEST(frames[0]["status"] == "file");
    BOOST_TEST(contains(frames[0]["reason"], "they are 0.1 times those"), frames[0]["reason"]);
    scratch::write(folder / "none.toml",
                   scratch::replaced(manifest, "kind = \"linear\"\nstiffness = 1", "kind = \"none\""));
    says(run({"compare", folder.at("none.toml"), "--bundle", "0"}), 0, {"2 same", "stiffness not tested"});
}

BOOST_FIXTURE_TEST_CASE(kind_9_names_in_a_comment_and_kind_26_lists_that_count_rows, scratch::InFolder) {
    const std::vector<std::string> stress{"--stress", "0.001,0.001"};
    BOOST_TEST(json_of(snapped("09_comment_header.txt", "i,j,f", stress, folder))["N"] == 33);
    BOOST_TEST(json_of(snapped("09_comment_header_zero_based.txt", "id1,id2,fn",
                               {"--ids", "0", "--stress", "0.001,0.001"}, folder))["forces"]["rest"]
                   .get<double>() < 1e-11);
    const std::vector<std::string> import{
        "--contacts",           scratch::data("field/00_base16_contacts.csv"), "--contact-columns", "id1,id2,fn", "-o",
        folder.at("state.json")};
    expect(in_field("import", "00_base16.xyz", import), 65, {"no column id", "--ids"});
    auto with_ids = import;
    with_ids.insert(with_ids.end(), {"--ids", "1"});
    says(in_field("import", "00_base16.xyz", with_ids), 0, {"33 carry a force", "solid fraction 0.813004"});
}

BOOST_AUTO_TEST_CASE(kind_10_radius_by_type_or_species) {
    expect_base("10_type_only.dump", {"--radius", "type:1=1,2=1.4"});
    expect_base("10_species_only.xyz", {"--radius", "species:A=1,B=1.4"});
    expect_base("10_species_only.xyz", {"--diameter", "species:A=2,B=2.8"});
    refused("10_species_only.xyz", {"--radius", "species:A=1"}, {"species is 'B'", "whose radius was stated"});
    refused("10_type_only.dump", {}, {"--radius type:1=1,2=1.4", "id type xs ys zs"});
    expect(in_field("plateau", "10_type_only.dump", {"--radius", "type:1=0"}), 64, {"positive"});
}

BOOST_AUTO_TEST_CASE(kind_11_a_table_and_its_cell) {
    expect_base("11_table_of_a_cell.csv", cell);
    expect_base("11_table_of_a_cell.csv", {"--lattice", "9.539360729179307,0,0.06305756549215252,9.569336627546415"});
    says(in_field("plateau", "11_table_of_a_cell.csv"), 1, {"neither walls nor a cell: --lattice"});
    refused("11_table_of_a_cell.csv", {"--lattice", "1,2,3,4,5"}, {"5 numbers"});
    refused("00_base16.xyz", cell, {"the file has one"});
    refused("11_table_of_a_cell.csv", {"--lattice", "1,1"}, {"2.8 wide in a period of 1"});
}

BOOST_FIXTURE_TEST_CASE(kind_12_a_file_packed_with_gzip_is_read_whole_or_refused, scratch::InFolder) {
    expect_base("12_packed.dump.gz", {});
    const std::string packed = scratch::read(scratch::data("field/12_packed.dump.gz"));
    for (const std::size_t kept : {std::size_t{3}, packed.size() / 2, packed.size() - 1}) {
        expect(run({"plateau", folder.file("cut.gz", packed.substr(0, kept))}), 65, {"damaged or cut"});
    }
    expect(run({"plateau", folder.file("more.gz", packed + "x")}), 65, {"damaged or cut"});
}

BOOST_AUTO_TEST_CASE(kind_12_files_that_are_known_and_not_read_are_named) {
    refused("12_binary.xyzd", {}, {"a binary file?"});
    refused("12_dump.yaml", {}, {"YAML"});
    refused("12_points.vtk", {}, {"VTK"});
    refused("12_records.json", {}, {"JSON"});
    refused("12_utf16.csv", {}, {"UTF-16", "iconv"});
}

BOOST_AUTO_TEST_CASE(kind_13_general_triclinic_cells_are_turned) {
    expect_base("13_abc_aligned.dump", {});
    expect_base("13_abc_rotated.dump", {});
    expect_base("13_general.data", {"--periodic"});
    expect_base("13_old_header.dump", {"--periodic"});
    says(in_field("plateau", "13_abc_rotated.dump", {"--cell", "full"}), 0, {"the cell is turned"});
}

BOOST_AUTO_TEST_CASE(kind_14_data_files_whose_style_is_stated) {
    expect_base("14_no_style.data", {"--periodic", "--style", "sphere"});
    expect_base("14_no_style.data", {"--periodic", "--columns", "id,type,d,-,x,y,z"});
    expect_base("14_hybrid.data", {"--periodic"});
    refused("14_no_style.data", {"--periodic"}, {"--style sphere", "--columns"});
    refused("14_no_style.data", {"--periodic", "--style", "hybrid sphere line"}, {"has style 'hybrid sphere line'"});
    refused("14_hybrid.data", {"--periodic", "--style", "sphere"}, {"7 values"});
}

BOOST_AUTO_TEST_CASE(kind_15_tables_after_lines_of_another_kind) {
    expect_base("15_count_time_box.data", with_cell({"--skip", "1", "--columns", "x,y,-,-,r,-,-,-"}));
    says(in_field("plateau", "15_ls.dat",
                  {"--skip", "7", "--columns", "x,y", "--diameter", "2", "--lattice",
                   "9.539360729179307,0,0,9.569336627546415"}),
         1, {"candidates                  6"});
    refused("15_ls.dat", {}, {"--columns x,y,r"});
    says(in_field("plateau", "15_dim_n_diameter_lattice.dat"), 1, {"diameter 2 for every disk, as line 3 says"});
    refused("15_dim_n_length.dat", {"--periodic", "--box", "0:1,0:1"}, {"2 wide in a period of 1"});
    refused("15_count_time_box.data", {"--columns", "x,y,-,-,r,-,-,-"}, {"--skip N"});
}

BOOST_AUTO_TEST_CASE(kind_16_planes) {
    expect_base("16_z_noise.dump", {});
    says(in_field("plateau", "16_xz_plane.dump", {"--plane", "xz", "--cell", "full"}), 0,
         {"the plane of xz is taken", "from N = 33"});
    refused("16_xz_plane.dump", {}, {"wide in a period of 1 along y", "--plane"});
    refused("16_three_dimensions.dump", {}, {"wide in a period of 1 along z"});
    refused("17_upper.csv", {"--plane", "yz", "--columns", "x,y,r"}, {"no column z"});
}

BOOST_AUTO_TEST_CASE(kind_17_tables_of_other_programs) {
    expect_base("17_fortran.txt", cell);
    expect_base("17_percent.txt", cell, 1e-9); // fifteen digits
    refused("17_upper.csv", cell, {"the columns are X Y R", "--columns x,y,radius"});
    refused("17_units.csv", cell, {"x (m) y (m) radius (m)", "--columns x,y,radius"});
    refused("17_paraview.csv", cell, {"Points:0", "--columns id,radius,-,-,-,x,y,z"});
    refused("17_decimal_comma.csv", cell, {":2", "x of disk 0 is '8,876706966229836'", "comma"});
    expect_base("17_upper.csv", with_cell({"--columns", "x,y,radius"}));
    expect_base("17_units.csv", with_cell({"--columns", "x,y,radius"}));
    expect_base("17_paraview.csv", with_cell({"--columns", "id,radius,-,-,-,x,y,z"}));
}

BOOST_AUTO_TEST_CASE(kind_18_plain_xyz_and_lattices_of_any_kind) {
    expect_base("18_plain.xyz", with_cell({"--columns", "-,x,y,-,r"}));
    expect_base("18_rotated.xyz", {});
    expect_base("18_lattice4.xyz", {});
}

BOOST_FIXTURE_TEST_CASE(kind_19_atoms_that_are_walls, scratch::InFolder) {
    const auto selected = json_of(in_field("plateau", "19_wall_atoms.dump", {"--select", "type=1,2", "--json"}), 1);
    BOOST_TEST(selected["disks"] == 4);
    const auto fixed =
        json_of(in_field("plateau", "19_wall_atoms.dump", {"--fixed", "type=3", "--thresholds", "0:0.1", "--json"}), 1);
    BOOST_TEST(fixed["disks"] == 24);
    BOOST_TEST(fixed["widest"]["N"] == 20); // four pairs, and each disk touches four atoms of the walls
    BOOST_TEST(fixed["widest"]["counts"]["N_f"] == 8);
    refused("00_base16.dump", {"--fixed", "type=3"}, {"cannot move", "periodic"});
    expect(in_field("import", "19_wall_atoms.dump", {"--fixed", "type=3", "-o", folder.at("s.json")}), 64, {"--fixed"});
}

BOOST_FIXTURE_TEST_CASE(kind_20_sizes_that_are_wrong_by_a_factor, scratch::InFolder) {
    says(in_field("plateau", "20_half_radii.xyz"), 2,
         {"the smallest gap is 1.99 of the smallest radius", "are the sizes wrong by a factor"});
    const std::string state = folder.at("s.json");
    expect(in_field("import", "20_half_radii.xyz", {"--cell", "isotropic", "-o", state}), 65,
           {"of its radius: expected at most one", "wrong by a factor", "--far"});
    BOOST_TEST(!std::filesystem::exists(state));
    says(in_field("import", "20_half_radii.xyz", {"-o", state, "--far"}), 0,
         {"more than a tenth: the vertex may not be that of the file", "(taken by default: --stress, --load)"});
    const auto of_size = [](const char* file, const char* option, const char* size) {
        return in_field("plateau", file, {option, size}).out;
    };
    BOOST_TEST(contains(of_size("20_half_radii.xyz", "--diameter", "radius"), "are the sizes wrong by a factor"));
    BOOST_TEST(contains(of_size("03_soft14.xyz", "--radius", "1"), "are the sizes diameters, taken for radii"));
}

BOOST_AUTO_TEST_CASE(kind_22_the_pair_of_the_deepest_overlap_and_the_list) {
    const auto found =
        json_of(in_field("plateau", "22_square26_unequal.csv", {"--walls", "fixed", "--box", "0:1,0:1", "--json"}), 1);
    BOOST_TEST(found["widest"]["N"] == 78);
    BOOST_TEST(found["widest"]["contacts"].size() == 78U);
    BOOST_TEST(found["smallest_gap_of"] == "8-12");
}

BOOST_AUTO_TEST_CASE(kind_23_decimals_and_their_digits) {
    const std::vector<std::string> box{"--walls", "fixed", "--box", "0:0.3404,0:0.3404", "--json"};
    const auto corner = json_of(in_field("plateau", "23_corner.csv", box), 1);
    BOOST_TEST(corner["widest"]["N"] == 12);
    BOOST_TEST(-corner["smallest_gap"].get<double>() < corner["rounding"].get<double>());
    const auto over = json_of(in_field("plateau", "23_over.csv", box), 1);
    BOOST_TEST(over["smallest_gap_of"] == "0-left");
    BOOST_TEST(std::abs(over["smallest_gap"].get<double>() + 1e-5) < 1e-15);
}

BOOST_FIXTURE_TEST_CASE(kind_23_where_every_gap_is_told_the_answer_is_that_of_the_doubles, scratch::InFolder) {
    const std::string state = folder.at("s.json");
    const auto answer =
        json_of(run({"import", scratch::data("yade20.txt"), "--box", "0:6.797743980394215,0:6.804741233269178", "-o",
                     state, "--stress", "1,1", "--json"}));
    BOOST_TEST(answer.at("rounding").get<double>() > 1e-6); // six digits
    BOOST_TEST(answer.at("rounding").get<double>() < 1e-4);
    BOOST_TEST(answer.at("load").at("by_default").at("stress") == false);
    BOOST_TEST(answer.at("load").at("by_default").at("kind") == true);
    expect(run({"inspect", state}), 0);
}

BOOST_AUTO_TEST_CASE(kind_24_lattices_have_their_categories) {
    for (const auto& [file, collective, strict] : {std::tuple{"24_honey.toml", "proved", "refuted"},
                                                   {"24_honey2.toml", "refuted", "refuted"},
                                                   {"24_kagome.toml", "refuted", "refuted"},
                                                   {"24_square.toml", "refuted", "refuted"}}) {
        const auto jammed = json_of(in_field("inspect", file, {"--json"}))["jammed"];
        BOOST_TEST(jammed["collective"] == collective, file);
        BOOST_TEST(jammed["strict"] == strict, file);
    }
}

BOOST_FIXTURE_TEST_CASE(kind_25_one_pair_through_three_images, scratch::InFolder) {
    const auto found =
        json_of(in_field("snap", "25_three_images.xyz",
                         {"--contacts", scratch::data("field/25_three_images_contacts.csv"), "--contact-columns",
                          "i,j,f", "--cell", "isotropic", "-o", folder.at("s.json"), "--json"}));
    BOOST_TEST(found["outcome"] == "vertex");
    BOOST_TEST(found["N"] == 3);
}

BOOST_FIXTURE_TEST_CASE(kind_27_our_own_table_is_read_whole, scratch::InFolder) {
    says(in_field("import", "27_own_export.csv", {"-o", folder.at("s.json")}), 0,
         {"periodic along x and y", "solid fraction 0.813004"});
    expect(run({"export", folder.at("s.json"), "-o", folder.at("again.csv")}), 0);
    says(run({"plateau", folder.at("again.csv"), "--cell", "full"}), 0, {"from N = 33"});
    // A box, with walls where the first line says.
    expect(run({"export", scratch::data("vertex100.txt"), "-o", folder.at("box.csv")}), 0);
    says(run({"plateau", folder.at("box.csv"), "--walls", "box"}), 0, {"from N = 188 with 7 rattlers"});
    says(run({"plateau", folder.file("other.csv", "# box of three disks\nx,y,r\n0,0,1\n2,0,1\n")}), 1,
         {"neither walls nor a cell"});
}

BOOST_FIXTURE_TEST_CASE(kind_28_a_manifest_to_begin_with, scratch::InFolder) {
    scratch::write(folder / "disks.dump", scratch::read(scratch::data("field/02_flip_disks.dump")));
    const std::string series = folder.at("series.toml");
    says(run({"compare", series, "--init", folder.at("disks.dump")}), 0, {"fill in the loads"});
    expect(run({"compare", series, "--bundle", "0"}), 65, {"series.frames.csv:2", "sigma2 is ''"});
    scratch::write(folder / "series.frames.csv", "timestep,sigma2\n0,0.001\n100,0.001\n");
    scratch::write(folder / "series.toml",
                   scratch::replaced(scratch::replaced(scratch::read(series), "sigma1 = 1.0", "sigma1 = 0.001"),
                                     "kind = \"none\"", "kind = \"linear\"\nstiffness = 1"));
    BOOST_TEST(json_of(run({"compare", series, "--bundle", "0", "--json"}))["counts"]["same"] == 2);
    // Without sigma1 in the manifest each frame has its own.
    const std::string one = scratch::read(series);
    scratch::write(folder / "series.toml", scratch::replaced(one, "sigma1 = 0.001", ""));
    expect(run({"compare", series, "--bundle", "0"}), 65, {"no column 'sigma1'"});
    scratch::write(folder / "series.frames.csv", "timestep,sigma1,sigma2\n0,0.001,0.001\n100,0.001,0.001\n");
    says(run({"compare", series, "--bundle", "0"}), 0, {"sigma2 is over sigma1"});
    scratch::write(folder / "series.toml", one);
    expect(run({"compare", series, "--init", folder.at("disks.dump")}), 64, {"series.toml exists"});
    scratch::write(folder / "other.txt", "mine");
    expect(run({"compare", folder.at("other.txt"), "--init", folder.at("disks.dump")}), 64,
           {"exists: expected a new name"});
    BOOST_TEST(scratch::read(folder / "other.txt") == "mine");
    // Strain-controlled series are not compared, and the message says it.
    scratch::write(folder / "series.frames.csv", "timestep\n0\n100\n");
    expect(run({"compare", series, "--bundle", "0"}), 65, {"no column 'sigma2'", "strain"});
}

BOOST_FIXTURE_TEST_CASE(lines_of_a_megabyte_end_no_reader, scratch::InFolder) {
    const std::string much(1'000'000, '1');
    const std::string blank(1'000'000, ' ');
    for (const std::string& line : {"# box " + much + ":4,0:2", "# box 0:4,0:2" + blank}) { // comments like any other
        const program::Outcome outcome = run({"plateau", folder.file("long.csv", line + "\nx,y,r\n1,1,0.5\n")});
        BOOST_TEST((outcome.status >= 0 && outcome.status <= 2), outcome.status);
    }
    for (const std::string& line : {"N = 1 ,L1= { " + much + " , 0 }", "N = 1 ," + blank + "L1= {"}) {
        expect(run({"plateau", folder.file("long.txt", line + "\n{\n1 , 1 , 0.5 ,\n}\n"), "--format", "braces"}), 65,
               {"at most 4096 characters"});
    }
}
