// Packings of other programs: every format, what each says of sizes, walls and boundaries, and what is refused.

#include "certificate/averages.hpp"
#include "snap/frame_file.hpp"
#include "support/bad_input.hpp"
#include "support/scratch.hpp"

#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

namespace {

using namespace isostat;
using scratch::replaced;

const std::string dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n-0.5 0.5\n"
                         "ITEM: ATOMS id x y radius\n1 0.5 0.5 0.5\n"
                         "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff pp\n-1 3\n0.5 2.5\n"
                         "-0.5 0.5\nITEM: ATOMS id type x y z radius\n2 1 2 1.5 0 0.75\n1 1 0 1.25 0 0.25\n";

const std::string data_file = "LAMMPS data file\n\n2 atoms\n1 atom types\n\n-1 3 xlo xhi\n0.5 2.5 ylo yhi\n"
                              "-0.5 0.5 zlo zhi\n\nAtoms # sphere\n\n1 1 0.5 2.5 0 1.25 0\n2 1 1.5 2.5 2 1.5 0 # c\n\n"
                              "Velocities\n\n1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n";

const std::string xyz = "2\nLattice=\"4 0 0 0 2 0 0 0 1\" Origin=\"-1 0.5 0\" pbc=\"F F F\" "
                        "Properties=species:S:1:pos:R:3:radius:R:1 Time=3\nA 0 1.25 0 0.25\nB 2 1.5 0 0.75\n";

ForeignPacking read(const std::string& text, const ForeignOptions& options = {}) {
    return parse_foreign(text, "FILE", options);
}

ForeignOptions with_walls(ForeignWalls walls) {
    ForeignOptions out{.walls = walls};
    return out;
}

ForeignOptions stated(SizeMeaning meaning, const std::string& column, double value = 0) {
    ForeignOptions out{.size = SizeStatement{meaning, column, value}};
    return out;
}

bool says(const ForeignPacking& packing, const std::string& words) {
    return std::ranges::any_of(packing.notes,
                               [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// The two disks of all the samples, whatever their order.
void expect_disks(const ForeignPacking& file, const std::string& format) {
    BOOST_TEST_INFO_SCOPE(format);
    BOOST_TEST(file.format == format);
    BOOST_REQUIRE_EQUAL(file.packing.radius.size(), 2u);
    const std::size_t small = file.packing.radius[0] < file.packing.radius[1] ? 0 : 1;
    BOOST_TEST(file.packing.radius[small] == 0.25);
    BOOST_TEST(file.packing.radius[1 - small] == 0.75);
    BOOST_TEST(file.packing.q[2 * small] == 0.0);
    BOOST_TEST(file.packing.q[2 * small + 1] == 1.25);
    BOOST_TEST(file.packing.q[2 - 2 * small] == 2.0);
    BOOST_TEST(file.packing.q[3 - 2 * small] == 1.5);
    BOOST_TEST((file.packing.walls == Walls::none()));
}

} // namespace

BOOST_AUTO_TEST_CASE(the_same_two_disks_in_every_format) {
    expect_disks(read(dump), "lammps-dump");
    expect_disks(read(data_file), "lammps-data");
    expect_disks(read(xyz), "xyz");
    for (const char* text :
         {"# x y r\n0 1.25 0.25\n2 1.5 0.75\n", "x y r\n0 1.25 0.25\n\n2\t1.5  0.75\n",
          "#format x_y_z_r\n0 1.25 7 0.25\n2 1.5 7 0.75\n", "id,x,y,diameter,name\n7,0,1.25,0.5,a\n3,2,1.5,1.5,b\n",
          "\"x\";\"y\";\"radius\"\r\n0;1.25;0.25\r\n2;1.5;0.75\r\n",
          "# made by hand\n# x y d\n+0 1.25 5e-1\n2 1.5 1.5"}) {
        expect_disks(read(text), "table");
    }
    ForeignOptions columns{.columns = {"-", "x", "y", "d"}};
    expect_disks(read("9 0 1.25 0.5\n9 2 1.5 1.5\n", columns), "table");
}

BOOST_AUTO_TEST_CASE(a_frame_is_the_last_one_or_the_one_asked_for) {
    ForeignOptions options{.frame = 0};
    BOOST_TEST(read(dump, options).packing.disk_count() == 1);
    options.frame = 1;
    expect_disks(read(dump, options), "lammps-dump");
    options.frame = 2;
    expect_bad_input([&] { read(dump, options); }, {"FILE", "2 frames", "frame 2"});
    options.frame = 1;
    const std::string two = "1\nProperties=pos:R:2:r:R:1\n5 5 1\n" + xyz;
    expect_disks(read(two, options), "xyz");
    options.frame = 0;
    BOOST_TEST(read(two, options).packing.disk_count() == 1);
    options.frame = 1;
    expect_bad_input([&] { read(data_file, options); }, {"frame 1"});
    expect_bad_input([&] { read("# x y r\n1 2 3\n", options); }, {"frame 1"});
}

BOOST_AUTO_TEST_CASE(an_earlier_frame_is_read_from_a_file_cut_in_a_later_one) {
    ForeignOptions options{.frame = 0};
    const std::string cut = dump.substr(0, dump.size() - 20);
    BOOST_TEST(read(cut, options).packing.disk_count() == 1);
    expect_bad_input([&] { read(cut); }, {"FILE:"});
}

BOOST_AUTO_TEST_CASE(walls_are_the_bounds_of_the_box_and_the_lower_ones_are_at_zero) {
    for (const std::string& text : {dump, data_file, xyz}) {
        const ForeignPacking box = read(text, with_walls(ForeignWalls::box));
        BOOST_TEST((box.packing.walls == Walls::box()));
        const std::size_t small = box.packing.radius[0] < box.packing.radius[1] ? 0 : 1;
        BOOST_TEST(box.packing.q[2 * small] == 1.0);
        BOOST_TEST(box.packing.q[2 * small + 1] == 0.75);
        BOOST_TEST(box.packing.length(0) == 4.0);
        BOOST_TEST(box.packing.length(1) == 2.0);
        BOOST_TEST(!says(box, "rounded by"));
        const ForeignPacking fixed = read(text, with_walls(ForeignWalls::fixed));
        BOOST_TEST((fixed.packing.walls.upper[0] == WallKind::fixed));
    }
    ForeignOptions options = with_walls(ForeignWalls::box);
    expect_bad_input([&] { read("# x y r\n1 2 3\n", options); }, {"FILE", "--box"});
    options.box = {0.1, 4, 1, 4};
    const ForeignPacking shifted = read("# x y r\n1 2 0.25\n", options);
    BOOST_TEST(shifted.packing.q[0] == 1 - 0.1);
    BOOST_TEST(says(shifted, "rounded by up to")); // 1 - 0.1 is no double
    options.box = {1, 4, 1, 4};
    expect_bad_input([&] { read("# x y r\n1 2 0.25\n", options); }, {"x of disk 0", "between the walls"});
}

BOOST_AUTO_TEST_CASE(whether_a_size_is_radius_or_diameter_is_never_guessed) {
    expect_bad_input([&] { read("1 2 3\n4 5 6\n"); }, {"FILE:1", "--columns x,y,r"});
    expect_bad_input([&] { read("x,y,size\n1,2,3\n"); }, {"FILE:1", "x y size", "--radius COLUMN"});
    expect_bad_input([&] { read("x,y,radius,diameter\n1,2,3,6\n"); }, {"'radius' and 'diameter'"});
    BOOST_TEST(read("x,y,size\n1,2,3\n", stated(SizeMeaning::radius, "size")).packing.radius[0] == 3.0);
    BOOST_TEST(read("x,y,size\n1,2,3\n", stated(SizeMeaning::diameter, "size")).packing.radius[0] == 1.5);
    BOOST_TEST(read("x,y,radius,diameter\n1,2,3,6\n", stated(SizeMeaning::diameter, "diameter")).packing.radius[0] ==
               3.0);
    BOOST_TEST(read("x,y\n1,2\n", stated(SizeMeaning::diameter, "", 3)).packing.radius[0] == 1.5);
    BOOST_TEST(read("1\ncomment\nAr 1 2 0\n", stated(SizeMeaning::radius, "", 2)).packing.radius[0] == 2.0);
    expect_bad_input([&] { read("1\ncomment\nAr 1 2 0\n"); }, {"FILE:2", "species pos.0"});
    expect_bad_input([&] { read("x,y,size\n1,2,3\n", stated(SizeMeaning::radius, "R")); },
                     {"no column 'R'", "x y size"});
    expect_bad_input([&] { read("x,y\n1,2\n", stated(SizeMeaning::radius, "", -1)); }, {"-1"});
    // By definition of the atom style a diameter: a contrary statement is refused.
    BOOST_TEST(says(read(data_file), "diameters, as atom style sphere defines"));
    expect_bad_input([&] { read(data_file, stated(SizeMeaning::radius, "diameter")); }, {"diameter by definition"});
    expect_bad_input([&] { read(scratch::replaced(data_file, " # sphere", "")); }, {"FILE:10", "Atoms # sphere"});
    expect_bad_input([&] { read(scratch::replaced(data_file, "# sphere", "# atomic")); },
                     {"no column states the size"});
    expect_bad_input([&] { read(scratch::replaced(data_file, "# sphere", "# line")); }, {"style 'line'"});
}

BOOST_AUTO_TEST_CASE(periodic_boundaries_are_refused_unless_the_user_takes_them_for_open) {
    ForeignOptions open{.not_periodic = true};
    const std::string periodic_dump =
        scratch::replaced(dump, "-0.5 0.5\nITEM: ATOMS id x", "-0.5 0.5\nITEM: ATOMS id x");
    std::string p = dump;
    for (std::size_t at = p.find("ff ff pp"); at != std::string::npos; at = p.find("ff ff pp")) {
        p.replace(at, 8, "pp ff pp");
    }
    expect_bad_input([&] { read(p); }, {"along x are periodic", "--not-periodic"});
    expect_disks(read(p, open), "lammps-dump");
    const std::string q = scratch::replaced(xyz, "pbc=\"F F F\" ", "");
    expect_bad_input([&] { read(q); }, {"periodic"}); // a lattice without pbc is periodic by convention
    expect_disks(read(q, open), "xyz");
    expect_bad_input([&] { read(scratch::replaced(xyz, "F F F", "F T F")); }, {"along y"});
    BOOST_TEST(says(read(data_file), "does not say whether x is periodic"));
    // Image flags tell that the box was periodic.
    const std::string flags = scratch::replaced(scratch::replaced(data_file, "0 1.25 0\n", "0 1.25 0 0 1 0\n"),
                                                "2 1.5 0 #", "2 1.5 0 0 0 0 #");
    expect_bad_input([&] { read(flags); }, {"along y"});
    std::string s = scratch::replaced(dump, "ff ff pp\n-1", "ss ff pp\n-1");
    expect_disks(read(s), "lammps-dump");
    expect_bad_input([&] { read(s, with_walls(ForeignWalls::box)); }, {"shrink-wrapped", "--box"});
}

BOOST_AUTO_TEST_CASE(gaps_are_known_to_the_digits_of_the_file) {
    const auto rounding = [](const std::string& x, const std::string& r) {
        return read("x y r\n" + x + " 0.25 " + r + "\n1.5 0.25 " + r + "\n").rounding;
    };
    // Places off by half a unit, 2 sqrt 2 of it for a pair; radii twice.
    const auto near = [](double found, double expected) { return std::abs(found - expected) < 1e-3 * expected; };
    BOOST_TEST(rounding("0.5", "0.5") < 2e-15); // as they stand, but for doubles
    BOOST_TEST(rounding("0.5", "0.5") > 0);
    BOOST_TEST(near(rounding("1.234567", "0.5"), std::sqrt(8.0) * 5e-7));
    BOOST_TEST(near(rounding("1.23457e1", "0.5"), std::sqrt(8.0) * 5e-5));
    BOOST_TEST(near(rounding("0.5", "0.123456"), 2 * 5e-7));
    BOOST_TEST(near(rounding("0.500000", "0.5"), std::sqrt(8.0) * 5e-6)); // digits as written, of the largest
    BOOST_TEST(rounding("0.12345678901234567890123", "0.5") < 2e-15);
    // In other formats, of a box, of diameters, and scaled to the box.
    const std::string digits = replaced(dump, "1 1 0 1.25", "1 1 0 1.234567");
    BOOST_TEST(near(read(digits).rounding, std::sqrt(8.0) * 5e-7));
    const std::string scaled = replaced(digits, "id type x y z radius", "id type xs ys zs radius");
    BOOST_TEST(near(read(scaled).rounding, 4 * std::sqrt(8.0) * 5e-7));
    BOOST_TEST(near(read(replaced(data_file, "1 1 0.5 2.5", "1 1 0.500001 2.5")).rounding, 5e-6));
    const std::string box = replaced(dump, "-1 3\n", "-1 3.000001\n");
    BOOST_TEST(near(read(box, with_walls(ForeignWalls::box)).rounding, 4 * 5e-7));
    BOOST_TEST(read(box).rounding < 1e-14); // without walls they are not used
    const std::string longer = replaced(box, "1 1 0 1.25", "1 1 0 1.2345678901234567");
    BOOST_TEST(read(longer, with_walls(ForeignWalls::box)).rounding < 1e-14); // fewer digits than others: as it stands
    BOOST_TEST(near(read(replaced(xyz, "4 0 0", "4.000001 0 0"), with_walls(ForeignWalls::box)).rounding, 4 * 5e-7));
}

BOOST_AUTO_TEST_CASE(scaled_and_unwrapped_coordinates) {
    const std::string scaled =
        scratch::replaced(scratch::replaced(scratch::replaced(dump, "id type x y z", "id type xs ys zs"), "2 1 2 1.5 0",
                                            "2 1 0.75 0.5 0.5"),
                          "1 1 0 1.25 0", "1 1 0.25 0.375 0.5");
    expect_disks(read(scaled), "lammps-dump");
    BOOST_TEST(says(read(scaled), "scaled"));
    const std::string unwrapped = scratch::replaced(dump, "id type x y z", "id type xu yu zu");
    expect_disks(read(unwrapped), "lammps-dump");
    BOOST_TEST(says(read(unwrapped), "unwrapped"));
}

BOOST_AUTO_TEST_CASE(what_does_not_fit_is_refused_with_line_value_and_what_was_expected) {
    const auto refused = [&](const std::string& text, const std::vector<std::string>& words) {
        expect_bad_input([&] { read(text); }, words);
    };
    using scratch::replaced;
    ForeignOptions disks{.dimension = 2};
    expect_bad_input([&] { read(replaced(dump, "1 1 0 1.25 0 0.25", "1 1 0 1.25 1 0.25"), disks); },
                     {"FILE:21", "z of disk 1", "in a plane"});
    refused(replaced(dump, "1 1 0 1.25 0 0.25", "2 1 0 1.25 0 0.25"), {"FILE:21", "id 2", "line 20"});
    refused(replaced(dump, "1 1 0 1.25 0 0.25", "1 1 0 1.25 0 -0.25"),
            {"FILE:21", "radius of disk 1", "-0.25", "positive"});
    refused(replaced(dump, "1 1 0 1.25 0 0.25", "1 1 nan 1.25 0 0.25"), {"x of disk 1", "nan", "finite"});
    refused(replaced(dump, "1 1 0 1.25 0 0.25", "1 1 0 1.25 0"), {"FILE:21", "6 values"});
    refused(replaced(dump, "1 1 0 1.25 0 0.25\n", ""), {"the file ends here", "atom 2 of 2"});
    refused(replaced(dump, "NUMBER OF ATOMS\n2", "NUMBER OF ATOMS\n1"), {"FILE:21", "ITEM: TIMESTEP"});
    refused(replaced(dump, "NUMBER OF ATOMS\n2", "NUMBER OF ATOMS\n99999999999"), {"number of atoms"});
    refused(replaced(dump, "ff ff pp\n-1 3", "xy xz yz ff ff pp\n-1 3"), {"bounds of the box"});
    refused(replaced(dump, "ff ff pp\n-1 3", "ff fx pp\n-1 3"), {"'fx'", "p f s m"});
    refused(replaced(replaced(dump, "type x y z radius", "type x y z radius radius"), "2 1 2 1.5 0 0.75",
                     "2 1 2 1.5 0 0.75 0.7"),
            {"FILE:20", "'radius' is given twice", "'0.7'", "'0.75'"});
    refused(replaced(dump, "-1 3\n", "3 -1\n"), {"upper bound"});
    refused(replaced(data_file, "2 atoms", "3 atoms"), {"FILE:15", "7 values"});
    refused(replaced(data_file, "2 atoms", "2 atoms\n2 atoms"), {"FILE:4", "once"});
    refused(replaced(data_file, "Velocities", "Velocitie"), {"'Velocitie'", "section"});
    refused(replaced(data_file, "ylo yhi", "ylo yhj"), {"FILE:7", "header line"});
    refused(replaced(data_file, "0.5 2.5 ylo", "2.5 0.5 ylo"), {"upper bound"});
    refused(replaced(xyz, "0 2 0 0", "1 2 0 0"), {"Lattice", "along the axes"});
    refused(replaced(xyz, "pbc=\"F F F\"", "pbc=\"F F F"), {"Properties"});
    refused(replaced(xyz, "radius:R:1", "radius:R"), {"FILE:2", "name:type:count"});
    refused(replaced(xyz, "B 2 1.5 0 0.75\n", ""), {"FILE:3", "row 2 of 2"});
    refused("# x y r\n", {"the file ends here"});
    refused("x,y,r\n1,,2\n", {"FILE:2", "y of disk 0"});
    refused("x,y,r\n1,2\n", {"FILE:2", "3 values"});
    refused("x,y,r\n1,2,1e999\n", {"finite"});
}

BOOST_AUTO_TEST_CASE(columns_that_are_needed_and_header_lines_come_once_or_agree) {
    const auto refused = [&](const std::string& text, const std::string& where, const std::string& what) {
        expect_bad_input([&] { read(text); }, {where, what});
    };
    for (const char* text : {"x,y,r,name,name\n1,1,1,a,b\n", "# x y r q q\n1 1 1 0 1\n", "x,y,r,x\n1,1,1,1\n"}) {
        BOOST_TEST(read(text).packing.disk_count() == 1, text);
    }
    refused("x,y,r,x\n1,1,1,2\n", "FILE:2", "'x' is given twice");
    refused("id,x,y,r,id\n1,1,1,1,2\n", "FILE:2", "'id' is given twice");
    refused(replaced(replaced(xyz, "radius:R:1", "radius:R:1:pos.0:R:1"), "A 0 1.25 0 0.25", "A 0 1.25 0 0.25 1"),
            "FILE:3", "'pos.0' is given twice");
    refused(replaced(dump, "ITEM: NUMBER OF ATOMS\n1", "ITEM: NUMBER OF ATOMS\n2\nITEM: NUMBER OF ATOMS\n1"), "FILE:5",
            "once");
    refused(replaced(data_file, "-0.5 0.5 zlo zhi", "-0.5 0.5 zlo zhi\n-0.5 0.5 zlo zhi"), "FILE:9", "once");
    refused(replaced(data_file, "1 atom types", "1 atom types\n1 atom types"), "FILE:5", "once");
    ForeignOptions options{.columns = {"x", "y", "r", "-", "-"}};
    BOOST_TEST(read("1 1 1 0 0\n", options).packing.disk_count() == 1);
    options.columns = {"x", "y", "r", "z", "z"};
    expect_bad_input([&] { read("1 1 1 0 1\n", options); }, {"FILE:1", "'z' is given twice"});
}

BOOST_AUTO_TEST_CASE(rows_that_are_counted_have_their_number_in_the_file) {
    ForeignOptions options{.first_id = 1};
    const std::string rows = "id,type,x,y,r\n7,1,1,1,1\n8,2,3,1,1\n9,3,5,1,1\n";
    BOOST_TEST(read(rows, options).ids == (std::vector<long>{1, 2, 3}));
    options.select = RowsWith{"type", {"1", "3"}};
    BOOST_TEST(read(rows, options).ids == (std::vector<long>{1, 3}));
    options.first_id.reset();
    BOOST_TEST(read(rows, options).ids == (std::vector<long>{7, 9}));
    options.fixed = RowsWith{"type", {"3"}};
    BOOST_TEST(read(rows, options).packing.fixed == (std::vector<unsigned char>{0, 1}));
    options.select = RowsWith{"type", {"4"}};
    expect_bad_input([&] { read(rows, options); }, {"no row has '4'"});
}

BOOST_AUTO_TEST_CASE(scaled_coordinates_of_a_turned_cell) {
    const std::string head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS abc origin pp pp pp\n"
                             "0 2 0 1\n-3 0 0 1\n0 0 1 0\nITEM: ATOMS id ";
    ForeignOptions cells{.cells = true};
    const Packing scaled = read(head + "xs ys zs radius\n1 0.25 0.5 0 0.5\n", cells).packing;
    const Packing placed = read(head + "x y z radius\n1 -0.5 1.5 0 0.5\n", cells).packing; // (1, 1) + a/4 + b/2
    for (std::size_t k = 0; k < placed.q.size(); ++k) {
        BOOST_TEST(std::abs(scaled.q[k] - placed.q[k]) < 1e-15);
    }
    BOOST_TEST(placed.length(0) == 2);
    BOOST_TEST(placed.length(1) == 3);
    BOOST_TEST(std::abs(placed.q[0] - 0.5) < 1e-15);
    BOOST_TEST(std::abs(placed.q[1] - 1.5) < 1e-15);
}

BOOST_AUTO_TEST_CASE(integers_of_files_are_written_as_integers) {
    for (const char* id : {"+7", "07", "-0", "7.0", "7e0", "1e99", "0x7", "nan", ""}) {
        expect_bad_input([&] { read(std::string("id,x,y,r\n") + id + ",1,1,1\n"); },
                         {"FILE:2", "id of disk 0", "an integer"});
    }
    BOOST_TEST(read("id,x,y,r\n7,+1,1,1\n").ids.front() == 7); // a number may have its sign
}

BOOST_AUTO_TEST_CASE(more_rows_in_a_data_file_than_atoms_are_refused) {
    expect_bad_input([&] { read(scratch::replaced(data_file, "2 atoms", "1 atoms")); }, {"FILE:13"});
}

BOOST_AUTO_TEST_CASE(our_own_formats_are_recognised) {
    BOOST_TEST(recognise_format(scratch::read(scratch::data("vertex100.txt"))) == "vertex");
    BOOST_TEST(recognise_format("# new order\n2 x y r gx gy\n1 1 1 0 0\n") == "vertex");
    BOOST_TEST(recognise_format("{\"format\": \"isostat-state\"}") == "state");
    BOOST_TEST(recognise_format(scratch::read(std::string(ISOSTAT_EXAMPLES) + "/packings/wedge.toml")) == "packing");
}

BOOST_AUTO_TEST_CASE(a_byte_order_mark_is_no_part_of_a_file) {
    const std::string mark = "\xEF\xBB\xBF";
    for (const auto& [format, text] : {std::pair{"lammps-dump", dump}, {"lammps-data", data_file}, {"xyz", xyz}}) {
        expect_disks(read(mark + text), format);
    }
    ForeignOptions columns{.columns = {"x", "y", "r"}};
    const ForeignPacking three = read(mark + "0.5 0.5 0.5\n1.5 0.5 0.5\n2.5 0.5 0.5\n", columns);
    BOOST_TEST(three.packing.radius.size() == 3U);
    BOOST_TEST(read(mark + "x y r\n0.5 0.5 0.5\n").packing.radius.size() == 1U);
    BOOST_TEST(read(mark + "# x y r\n0.5 0.5 0.5\n").packing.radius.size() == 1U);
    BOOST_TEST(recognise_format(mark + "{\"format\": 1}") == "state");
}

BOOST_AUTO_TEST_CASE(a_first_row_that_is_no_row_of_names_is_a_disk) {
    ForeignOptions columns{.columns = {"x", "y", "r"}};
    const std::string rest = "\n0.5 0.5 0.5\n1.5 0.5 0.5\n";
    for (const std::string bad : {"nan", "NaN", "-inf", "0.5D", "1e400", "NA", "--1", "0x1p-1", "1D2D3", "d5"}) {
        expect_bad_input([&] { (void)read(bad + " 0.5 0.5" + rest, columns); }, {"FILE:1:", "x of disk 0", "finite"});
        expect_bad_input([&] { (void)read("# x y r\n0.5 " + bad + " 0.5" + rest); },
                         {"FILE:2:", "y of disk 0", bad, "finite"});
    }
    BOOST_TEST(read("5D-1 0.5 0.5" + rest, columns).packing.q[0] == 0.5); // Fortran
    BOOST_TEST(read("5.0d+01 0.5 0.5" + rest, columns).packing.q[0] == 50.0);
    // Names are named, and the stated ones count.
    const ForeignPacking two = read("px py rad" + rest, columns);
    BOOST_TEST(two.packing.radius.size() == 2U);
    BOOST_TEST(says(two, "line 1 (px py rad) is taken for names"));
}

BOOST_AUTO_TEST_CASE(what_is_written_for_other_programs_is_read_bit_for_bit) {
    const State state = read_state(scratch::data("vertex100.txt")).state;
    ForeignOptions options{.walls = ForeignWalls::box};
    const auto same = [&](const std::string& text, const char* format) {
        const ForeignPacking back = parse_foreign(text, "written", options);
        BOOST_TEST(back.format == format);
        BOOST_TEST((back.packing.radius == state.packing.radius));
        BOOST_TEST((back.packing.q == state.packing.q));
        BOOST_TEST(back.ids.size() == 100U);
    };
    same(lammps_data_text(state.packing, "a title\nof two lines"), "lammps-data");
    same(xyz_text(state.packing, {}), "xyz");
    same(xyz_text(state.packing, state.packing.q), "xyz");
    options.box = {0, state.packing.length(0), 0, state.packing.length(1)};
    same(csv_text(state.packing), "table");
    // With the contacts of each disk: sums over pairs count twice, those of walls once.
    const std::vector<int> contacts = contacts_of_grains(state);
    const auto walls =
        std::ranges::count_if(state.contacts, [](const Contact& c) { return c.kind != ContactKind::disk_disk; });
    BOOST_TEST(std::accumulate(contacts.begin(), contacts.end(), 0) ==
               2 * static_cast<int>(state.contacts.size()) - walls);
    same(csv_text(state.packing, contacts), "table");
    options.box.clear();
    same(xyz_text(state.packing, state.packing.q, contacts), "xyz");
    BOOST_TEST(csv_text(state.packing, contacts).ends_with(fmt::format(",{}\n", contacts.back())));
    BOOST_TEST(csv_text(state.packing, contacts).find("\nid,x,y,r,contacts\n") != std::string::npos);
}

BOOST_FIXTURE_TEST_CASE(dumps_of_pairs_have_frames_and_named_columns, scratch::InFolder) {
    const std::string head = "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ENTRIES\n";
    const std::string box = "ITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n0 1\nITEM: ENTRIES i j f\n";
    const std::string first = head + "1\n" + box + "7 9 1\n";
    const auto pairs = [&](const std::string& text, std::optional<long> frame) {
        scratch::write(folder / "p.dump", text);
        std::vector<std::tuple<int, int, double>> rows;
        for (const compare::PairForce& row :
             compare::read_local_dump(folder / "p.dump", {"i", "j", {"f"}}, {9, 8, 7}, frame)) {
            rows.emplace_back(row.i, row.j, row.force[0]);
        }
        return rows;
    };
    const std::vector<std::tuple<int, int, double>> outer{{0, 2, 1}}, both{{1, 2, 2}, {1, 2, 2}, {0, 1, 1e-9}};
    const std::string two = first + head + "4\n" + box + "8 7 2\n7 8 2\n8 9 1e-9\n9 7 0\n";
    BOOST_TEST((pairs(two, 0) == outer));
    BOOST_TEST((pairs(two, std::nullopt) == both));
    const auto refused = [&](const std::string& text, std::optional<long> frame,
                             const std::vector<std::string>& words) {
        expect_bad_input([&] { (void)pairs(text, frame); }, words);
    };
    refused(two, 2, {"after 2 frames", "frame 2"});
    refused(replaced(first, "7 9 1", "7 6 1"), 0, {"p.dump:10:", "j", "'6'", "id of a disk"});
    refused(replaced(first, "7 9 1", "7 7 1"), 0, {"p.dump:10:", "another disk"});
    refused(replaced(first, "7 9 1", "7 9 nan"), 0, {"p.dump:10:", "f", "nan"});
    refused(replaced(first, "i j f", "i j g"), 0, {"p.dump:9:", "no column 'f'", "i, j, g"});
    refused(replaced(first, "ENTRIES\n1", "ENTRIES\n2"), 0, {"p.dump", "row 2 of 2"});
    refused(replaced(first, "ENTRIES i", "ATOMS i"), 0, {"p.dump:9:", "style local"});
}
