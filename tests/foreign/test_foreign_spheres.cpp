// Packings of spheres by other programs: every format, cells, walls, and what is refused.
// Rigid bodies in packings of other programs: which rows are members, which bars are made, and what is refused.
#include "io/numbers.hpp"
#include "oracle/pairs.hpp"
#include "support/bad_input.hpp"
#include "support/scratch.hpp"

#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/counting.hpp>

using namespace isostat;
using scratch::replaced;

namespace foreign_spheres { // names of its own, beside test_foreign.cpp

namespace {

ForeignPacking read(const std::string& text, ForeignOptions options = {}) {
    options.cells = true;
    return parse_foreign(text, "FILE", options);
}

ForeignOptions of_dimension(int dimension) {
    ForeignOptions out{.dimension = dimension};
    return out;
}

ForeignOptions in_box(std::vector<double> box, ForeignWalls walls = ForeignWalls::box) {
    ForeignOptions out{.walls = walls, .box = std::move(box)};
    return out;
}

std::string dump_of(const std::string& bounds, const std::string& columns, const std::string& atoms) {
    return fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {}\nITEM: ATOMS {}\n{}",
                       std::ranges::count(atoms, '\n'), bounds, columns, atoms);
}

const std::string box_bounds = "ff ff ff\n0 4\n0 4\n0 8";
const std::string rows = "1 1 2 0.5\n2 1 2 1.5\n"; // x y z r
const std::string table = "# x y z r\n" + rows;
const std::string dump = dump_of(box_bounds, "x y z radius", rows);
const std::string data_file = "comment\n\n2 atoms\n\n0 4 xlo xhi\n0 4 ylo yhi\n0 8 zlo zhi\n\nAtoms # sphere\n\n"
                              "1 1 1 1 1 1 2\n2 1 3 1 2 1 2\n";
const std::string xyz = "2\nLattice=\"4 0 0 0 4 0 0 0 8\" pbc=\"F F F\" Properties=pos:R:3:radius:R:1\n" + rows;

/// With z of the second sphere as it is stated.
std::string at_height(const std::string& text, const std::string& z) {
    const bool data = text == data_file;
    return replaced(text, data ? "2 1 2\n" : "2 1 2 1.5", data ? "2 1 " + z + "\n" : "2 1 " + z + " 1.5");
}

struct Touching {
    int contacts = 0;
    double other = HUGE_VAL; ///< smallest gap of the others
};

/// Every pair with every image up to one period away, and every wall.
Touching touching(const Packing& p, double threshold) {
    Touching out;
    for (const Contact& c : oracle::all_pairs(p, 1)) {
        const double g = gap(p, c);
        out.contacts += g <= threshold ? 1 : 0;
        out.other = g <= threshold ? out.other : std::min(out.other, g);
    }
    return out;
}

ForeignPacking reference(const std::string& name, ForeignOptions options = {}) {
    options.cells = true;
    return isostat::read_foreign(scratch::data("spheres/" + name), options);
}

void near(double found, double expected) {
    BOOST_TEST(std::abs(found - expected) <= 1e-3 * std::abs(expected), found << " is not " << expected);
}

} // namespace

/// Of an independent program (tests/data/spheres): its contacts are those of 32 digits, N = N_f.
BOOST_AUTO_TEST_CASE(packings_of_an_independent_program_have_their_contacts) {
    const ForeignPacking box = reference("box_uniform_100_1.txt",
                                         in_box({0, 13.995847242391138, 0, 15.063850881057951, 0, 13.924292277825588}));
    const ForeignPacking ortho = reference("ortho_uniform_30_1.xyz"), tri = reference("tri_bidisperse_60_1.dump");
    for (const auto& [file, spheres, contacts, places] :
         {std::tuple{&box, 100, 303, 9}, {&ortho, 30, 90, 12}, {&tri, 60, 183, 10}}) {
        BOOST_TEST_INFO_SCOPE(spheres);
        BOOST_TEST(file->packing.dimension == 3);
        BOOST_TEST(file->packing.disk_count() == spheres);
        const double unit = std::pow(10.0, -places); // half of it is cut off, of three coordinates of two spheres
        BOOST_TEST(file->rounding > std::sqrt(3.0) * unit);
        BOOST_TEST(file->rounding < std::sqrt(3.0) * unit * 1.01 + 1e-13);
        const Touching found = touching(file->packing, file->rounding);
        BOOST_TEST(found.contacts == contacts);
        BOOST_TEST(found.other > 1e-6);
    }
    BOOST_TEST(box.packing.radius[0] == 1.5213861465454102);
    BOOST_TEST(box.packing.length(2) == 13.924292277825588);
    BOOST_TEST(ortho.packing.cell.all());
    BOOST_TEST(ortho.packing.length(1) == 9.4770431447310894);
    const Packing& p = tri.packing;
    for (const auto& [found, expected] : {std::pair{p.length(0), 9.0013210028968666},
                                          {p.length(1), 9.1982881158482836},
                                          {p.length(2), 8.8928025679008},
                                          {p.lattice(0, 1), -0.16056235237937127},
                                          {p.lattice(0, 2), -0.19823474368644507},
                                          {p.lattice(1, 2), 1.676989261975815801}}) {
        BOOST_TEST(std::abs(found - expected) < 1e-14);
    }
}

BOOST_AUTO_TEST_CASE(the_same_two_spheres_in_every_format) {
    for (const std::string& text : {table, dump, data_file, xyz, std::string("#format x_y_z_r\n") + rows,
                                    std::string("x,y,z,d\n1,1,2,1\n2,1,2,3\n")}) {
        const Packing layer = read(text).packing; // the same z: disks
        BOOST_TEST(layer.q == (std::vector<double>{1, 1, 2, 1, 0, 0}));
        BOOST_TEST(read(text, of_dimension(3)).packing.q == (std::vector<double>{1, 1, 2, 2, 1, 2, 0, 0, 0}));
    }
    for (const std::string& text : {table, dump, data_file, xyz}) {
        const ForeignPacking file = read(at_height(text, "3.25"));
        BOOST_TEST(file.packing.dimension == 3);
        BOOST_TEST(file.packing.cell.dimension == 3);
        BOOST_TEST(file.packing.q == (std::vector<double>{1, 1, 2, 2, 1, 3.25, 0, 0, 0}));
        BOOST_TEST(file.packing.radius == (std::vector<double>{0.5, 1.5}));
    }
}

BOOST_AUTO_TEST_CASE(disks_are_of_one_height_to_what_changes_no_gap) {
    for (const std::string& text : {table, dump, data_file, xyz}) {
        BOOST_TEST(read(at_height(text, "2.0000000001")).packing.dimension == 2);
        BOOST_TEST(read(at_height(text, "2.0000001")).packing.dimension == 3);
        expect_bad_input([&] { (void)read(at_height(text, "2.5"), of_dimension(2)); },
                         {"FILE:", "z of disk 1 is '2.5'", "expected 2", "--dimension 3"});
    }
    BOOST_TEST(read(at_height(table, "2.0000000001")).rounding > read(table).rounding);
    expect_bad_input([&] { (void)read(at_height(table, "2.5"), of_dimension(2)); }, {"FILE:3:"});
    expect_bad_input([&] { (void)read("x,y,r\n1,1,1\n", of_dimension(3)); }, {"no column z"});
    expect_bad_input([&] { (void)read(at_height(table, "nan")); }, {"FILE:3:", "z of disk 1", "finite"});
    expect_bad_input([&] { (void)read("x y z r\n1 1 1 1\n1 1 1\n"); }, {"FILE:3:", "4 values"});
}

BOOST_AUTO_TEST_CASE(walls_stand_at_both_sides_of_every_axis_that_does_not_repeat) {
    for (const std::string& text : {dump, data_file, xyz}) {
        const Packing p = read(at_height(text, "3.25"), in_box({})).packing;
        BOOST_TEST((p.walls == Walls::box(3)));
        BOOST_TEST(p.length(2) == 8);
    }
    const std::string text = at_height(table, "3.25");
    const Packing moved = read(text, in_box({-1, 4, 0, 4, 0.5, 8}, ForeignWalls::fixed)).packing;
    BOOST_TEST(moved.q == (std::vector<double>{2, 1, 1.5, 3, 1, 2.75, 5, 4, 7.5}));
    BOOST_TEST((moved.walls.upper[2] == WallKind::fixed));
    expect_bad_input([&] { (void)read(text, in_box({0, 4, 0, 4})); }, {"4 bounds", "expected 6"});
    expect_bad_input(
        [&] {
            (void)read(table, in_box({0, 4, 0, 4, 0, 8}));
        },
        {"6 bounds", "expected 4", "--dimension 3"});
    expect_bad_input([&] { (void)read(text, in_box({})); }, {"xlo:xhi,ylo:yhi,zlo:zhi"});
    expect_bad_input([&] { (void)read(text, in_box({0, 4, 0, 4, 0, 3})); }, {"z of disk 1", "between the walls"});
    // A slab: walls along z alone.
    const std::string slab = replaced(at_height(dump, "3.25"), "ff ff ff", "pp pp ff");
    const Packing p = read(slab, in_box({})).packing;
    BOOST_TEST((p.cell.periodic == PerAxis<bool>{true, true, false}));
    BOOST_TEST((p.walls.upper == PerAxis<WallKind>{WallKind::absent, WallKind::absent, WallKind::movable}));
    BOOST_TEST(p.q == (std::vector<double>{1, 1, 2, 2, 1, 3.25, 4, 4, 8, 0, 0, 0}));
    expect_bad_input([&] { (void)read(replaced(slab, "pp pp ff\n0 4\n", "xy xz yz pp pp ff\n0 4 0\n")); },
                     {"bounds of the box"});
    const std::string leaning =
        dump_of("xy xz yz pp pp ff\n0 5 0\n0 4 0\n0 8 0.5", "x y z radius", "1 1 2 1\n2 1 3 1\n");
    expect_bad_input([&] { (void)read(leaning); }, {"yz", "tilted by 0.5", "both axes periodic"});
}

BOOST_AUTO_TEST_CASE(a_triclinic_dump_bounds_all_corners) {
    // Periods (4, 0, 0), (-1, 4, 0), (0.5, -2, 8) at (0.5, 0.25, -1).
    const std::string bounds = "xy xz yz pp pp pp\n-0.5 5 -1\n-1.75 4.25 0.5\n-1 7 -2";
    const Packing p = read(dump_of(bounds, "x y z radius", "0.5 0.25 -1 1\n3 2.25 6.5 1\n")).packing;
    BOOST_TEST(p.q == (std::vector<double>{0, 0, 0, 2.5, 2, 7.5, 4, 4, 8, -1, 0.5, -2}));
    const Packing scaled = read(dump_of(bounds, "xs ys zs radius", "0 0 0 1\n0.5 0.5 0.5 1\n")).packing;
    BOOST_TEST(scaled.q == (std::vector<double>{0, 0, 0, 1.75, 1, 4, 4, 4, 8, -1, 0.5, -2}));
    const std::string data =
        "comment\n\n2 atoms\n\n0.5 4.5 xlo xhi\n0.25 4.25 ylo yhi\n-1 7 zlo zhi\n-1 0.5 -2 xy xz yz\n\n"
        "Atoms # sphere\n\n1 1 2 1 0.5 0.25 -1 0 0 0\n2 1 2 1 3 2.25 6.5 1 1 1\n";
    BOOST_TEST(read(data).packing.q == p.q);
    expect_bad_input([&] { (void)read(replaced(data, " 1 1 1\n", "\n")); }, {"tilted by", "--periodic"});
    expect_bad_input([&] { (void)read(replaced(data, "6.5 1 1 1", "-1 1 1 1")); }, {"FILE:8", "tilt", "0.5", "plane"});
}

BOOST_AUTO_TEST_CASE(a_lattice_that_leans_is_turned) {
    const auto text = [](const std::string& lattice, const std::string& more = "") {
        return "2\nLattice=\"" + lattice + "\" " + more + "Properties=pos:R:3:radius:R:1\n1 2 3 0.5\n1.5 2 1 0.5\n";
    };
    const Packing upper = read(text("9 0 0 1 8 0 -2 3 7")).packing;
    BOOST_TEST(upper.lattice(0, 1) == 1);
    BOOST_TEST(upper.lattice(0, 2) == -2);
    BOOST_TEST(upper.lattice(1, 2) == 3);
    // The same packing with its axes in another order, and leaning.
    const double c = 0.6, s = 0.8;
    const auto turned = [&](double x, double y, double z) {
        return fmt::format("{} {} {}", c * x - s * z, y, s * x + c * z);
    };
    const std::string other =
        fmt::format("2\nLattice=\"{} {} {}\" Properties=pos:R:3:radius:R:1\n{} 0.5\n{} 0.5\n", turned(9, 0, 0),
                    turned(1, 8, 0), turned(-2, 3, 7), turned(1, 2, 3), turned(1.5, 2, 1));
    const ForeignPacking file = read(other);
    for (std::size_t k = 0; k < upper.q.size(); ++k) {
        BOOST_TEST(std::abs(file.packing.q[k] - upper.q[k]) < 1e-14, k);
    }
    BOOST_TEST(file.packing.lattice(2, 2) > 0);
    BOOST_TEST(file.rounding > 1e-15);
    const Packing mirrored = read(text("0 9 0 8 1 0 3 -2 7")).packing;
    BOOST_TEST(mirrored.length(1) == 8);
    expect_bad_input([&] { (void)read(text("0 9 0 8 1 0 3 -2 7", "pbc=\"T T F\" ")); }, {"FILE", "all axes periodic"});
    expect_bad_input([&] { (void)read(text("9 0 0 1 8 0 -2 3")); }, {"FILE:2", "Lattice", "9 numbers"});
    expect_bad_input([&] { (void)read(text("9 0 0 9 0 0 -2 3 7")); }, {"FILE", "period 0 along y"});
    expect_bad_input([&] { (void)read(replaced(text("9 0 1 1 8 0 0 0 7"), "2 1 0.5", "2 3 0.5")); },
                     {"FILE:2", "in the plane of the disks"});
}

BOOST_AUTO_TEST_CASE(files_of_equal_spheres_have_their_period_vectors_or_not) {
    const std::string head = "3\n2\n0.5\n", centres = "0.25 0.5 0.75 \n0.75\t0.5\t0.25\n";
    const ForeignPacking bare = read(head + centres);
    BOOST_TEST(bare.format == "centres");
    BOOST_TEST(bare.packing.q == (std::vector<double>{0.25, 0.5, 0.75, 0.75, 0.5, 0.25, 0, 0, 0}));
    BOOST_TEST(bare.packing.radius == (std::vector<double>{0.25, 0.25}));
    ForeignOptions cube = in_box({0, 1, 0, 1, 0, 1}, ForeignWalls::none);
    cube.periodic = true; // the file has no cell
    const Packing repeated = read(head + centres, cube).packing;
    BOOST_TEST(repeated.cell.all());
    BOOST_TEST(repeated.length(2) == 1);
    const Packing tj = read(head + "1\t0\t0\t\n0.25 2 0\n0.5 0.5 4\n" + centres).packing;
    BOOST_TEST(tj.q == (std::vector<double>{0.25, 0.5, 0.75, 0.75, 0.5, 0.25, 1, 2, 4, 0.25, 0.5, 0.5}));
    BOOST_TEST(read("2\n2\n0.5\n1 0\n0 1\n0.25 0.5\n0.75 0.5\n").packing.q ==
               (std::vector<double>{0.25, 0.5, 0.75, 0.5, 1, 1, 0}));
    const auto refused = [&](const std::string& text, const std::vector<std::string>& words) {
        expect_bad_input([&] { (void)read(text); }, words);
    };
    refused(head + centres + "0 0 0\n", {"3 rows", "2 centres", "3 period vectors"});
    refused("4\n1\n0.5\n0 0 0 0\n", {"FILE:1", "dimension", "'4'"});
    refused("3\n2\n-0.5\n" + centres, {"FILE:3", "diameter", "positive"});
    refused(head + replaced(centres, "0.25\n", "\n"), {"FILE:5"});
    refused(head + replaced(centres, "0.75 \n", "inf\n"), {"FILE:4", "z of disk 0"});
    expect_bad_input([&] { (void)read(head + centres, of_dimension(2)); }, {"dimension 2", "the file has 3"});
    BOOST_TEST(recognise_format("3\ncomment\nA 0 0 0\nB 1 1 1\nC 2 2 3\n") == "xyz");
}

BOOST_AUTO_TEST_CASE(what_is_written_of_spheres_is_read_bit_for_bit) {
    for (const char* name : {"ortho_uniform_30_1.xyz", "tri_bidisperse_60_1.dump"}) {
        const Packing cell = reference(name).packing;
        const ForeignPacking xyz_back = read(xyz_text(cell, {}));
        BOOST_TEST(xyz_back.packing.q == cell.q, boost::test_tools::per_element());
        BOOST_TEST((xyz_back.packing.cell.periodic == cell.cell.periodic));
        ForeignOptions periodic{.periodic = true};
        const ForeignPacking data_back = read(lammps_data_text(cell, name), periodic);
        BOOST_TEST(data_back.packing.q == cell.q, boost::test_tools::per_element());
        BOOST_TEST(data_back.packing.radius == cell.radius, boost::test_tools::per_element());
    }
    const std::vector<double> sides{0, 13.995847242391138, 0, 15.063850881057951, 0, 13.924292277825588};
    const Packing box = reference("box_uniform_100_1.txt", in_box(sides)).packing;
    BOOST_TEST((read(csv_text(box), in_box(sides)).packing.q == box.q));
    BOOST_TEST((read(xyz_text(box, box.q), in_box({})).packing.q == box.q));
}

/// The worst direction and the worst signs: an image in the neighbouring cell along all three periods, whose bounds are
/// those of all corners of the box, each number off by half a unit of its last digit.
BOOST_AUTO_TEST_CASE(the_bound_of_a_gap_is_reached_in_a_triclinic_cell) {
    const double off = 1e-6;
    const auto gap_with = [&](double sign) {
        const double e = sign * off;
        // 12 = hi - lo + 2 xy + 2 xz, 8 = hi - lo + 2 yz, 4 = hi - lo: in the ratio 6 : 4 : 2 of their errors.
        const std::string bounds = fmt::format("xy xz yz pp pp pp\n{} {} {}\n{} {} {}\n{} {} {}", -8 - e, 8 + e, -1 + e,
                                               -5 - e, 5 + e, -1 + e, -2 - e, 2 + e, -1 + e);
        const Packing p = read(dump_of(bounds, "x y z radius", "0 0 0 1\n0 0 0 1\n"), of_dimension(3)).packing;
        return gap(p, {ContactKind::disk_disk, 0, 1, Image{{1, 1, 1}}});
    };
    const double worst = (gap_with(1) - gap_with(-1)) / 2, bound = rounding_of_gaps(0, off, 0, {3, true});
    BOOST_TEST(worst <= bound * (1 + 1e-6));
    BOOST_TEST(worst > 0.9 * bound);
    // Coordinates and radii: along a diagonal of space.
    near(rounding_of_gaps(off, 0, 0, {3}), 2 * std::sqrt(3.0) * off);
    const std::string digits = "x y z r\n1.234567 1.5 1 0.5\n0.5 0.5 0.25 0.5\n";
    near(read(digits).rounding, 2 * std::sqrt(3.0) * 5e-7);
    near(read(replaced(digits, "1.5 1 ", "1.5 1.2345678 ")).rounding, 2 * std::sqrt(3.0) * 5e-8); // z counts
    // Fewer digits than the radii have: those of the coordinates were cut off.
    near(read(replaced(digits, "1 0.5\n", "1 0.5000000000000001\n")).rounding, 2 * std::sqrt(3.0) * 5e-7);
}

} // namespace foreign_spheres

namespace foreign_clumps { // names of its own, beside test_foreign.cpp

namespace {

ForeignPacking read(const std::string& text, const std::string& bodies = "") {
    ForeignOptions options{.bodies = bodies, .cells = true};
    return parse_foreign(text, "FILE", options);
}

bool says(const ForeignPacking& packing, const std::string& words) {
    return std::ranges::any_of(packing.notes,
                               [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// Four disks, the molecules of which are as stated.
std::string dump(const std::string& column, const std::array<int, 4>& molecules) {
    return fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS pp ff pp\n0 16\n0 9\n-0.5 0.5\n"
                       "ITEM: ATOMS id {} x y radius\n1 {} 15 1 1\n2 {} 5 5 1\n3 {} 2 5 0.5\n4 {} 8.5 5 0.5\n",
                       column, molecules[0], molecules[1], molecules[2], molecules[3]);
}

const std::vector<Bar> none;

/// Rows of a table, in the plane or in space.
std::string table(const std::string& names, const std::vector<std::string>& rows) {
    std::string text = names + "\n";
    for (const std::string& row : rows) {
        text += row + "\n";
    }
    return text;
}

/// As many bars as make the body rigid, and no self-stress of them.
void expect_rigid(const ForeignPacking& file, std::size_t bars) {
    BOOST_TEST(file.packing.bars.size() == bars);
    validate(file.packing, "FILE");
    std::vector<Contact> list;
    for (const Bar& bar : file.packing.bars) {
        list.emplace_back(ContactKind::bar, bar.i, bar.j);
    }
    BOOST_TEST(count_contacts(file.packing, list).hyperstaticity == 0);
}

} // namespace

BOOST_AUTO_TEST_CASE(rows_with_the_same_body_are_kept_at_their_distance) {
    const std::string text = "x,y,r,body\n0,0,1,4\n3,4,1,4\n9,9,1,5\n20,0,1,0\n30,0,1,0\n40,0,1,-1\n50,0,1,-1\n";
    const ForeignPacking file = read(text);
    BOOST_TEST((file.packing.bars == std::vector<Bar>{{0, 1, 5}}));
    BOOST_TEST(says(file, "bodies from column 'body'"));
    BOOST_TEST(says(file, "1 rigid bodies of several disks"));
    BOOST_TEST((read(text, "none").packing.bars == none));
    BOOST_TEST((read("#format x_y_z_r_clumpId\n0 0 0 1 7\n2 3 6 1 7\n5 5 9 1 -1\n").packing.bars ==
                std::vector<Bar>{{0, 1, 7}})); // YADE
}

BOOST_AUTO_TEST_CASE(molecules_are_bodies_where_that_is_stated) {
    const std::string text = dump("mol", {3, 8, 8, 3});
    BOOST_TEST((read(text).packing.bars == none));
    BOOST_TEST(
        says(read(text), "column 'mol' is not used, though several rows have the same number there: --bodies mol"));
    BOOST_TEST(!says(read(dump("mol", {1, 1, 1, 1})), "is not used"));
    BOOST_TEST(!says(read(dump("mol", {0, 0, 1, 2})), "is not used"));
    BOOST_TEST((read(dump("mol", {0, 8, 8, 0}), "mol").packing.bars == std::vector<Bar>{{1, 2, 3}}));
}

BOOST_AUTO_TEST_CASE(bars_make_bodies_of_any_number_of_members_rigid) {
    const std::vector<std::string> plane{"0,0,1,1", "4,0,1,1", "2,0,1,1", "0,3,1,1", "0,0,0.5,1", "1,1,1,1"};
    expect_rigid(read(table("x,y,r,body", plane)), 9);
    const std::vector<std::string> space{"0,0,0,1,1", "4,0,0,1,1", "2,0,0,1,1", "0,3,0,1,1",
                                         "0,0,5,1,1", "0,0,5,2,1", "1,1,0,1,1"};
    expect_rigid(read(table("x,y,z,r,body", space)), 15);
    expect_rigid(read(table("x,y,z,r,body", {space.begin() + 2, space.begin() + 5})), 3);
}

BOOST_AUTO_TEST_CASE(members_that_no_bars_keep_together_are_refused) {
    const auto refused = [](const std::string& names, const std::vector<std::string>& rows,
                            const std::vector<std::string>& words) {
        expect_bad_input([&] { read(table(names, rows)); }, words);
    };
    refused("x,y,r,body", {"9,9,1,2", "1,2,1,1", "1,2,2,1"}, {"FILE", "2 members of the body of disk 1", "one place"});
    refused("x,y,r,body", {"0,0,1,1", "1,0.3,1,1", "3,0.9,1,1"}, {"3 members of the body of disk 0", "on one line"});
    refused("x,y,r,body", {"0,0,1,1", "1.00001,1.00001,1,1", "3.00001,3.00002,1,1"}, {"on one line", "e-05"});
    refused("x,y,z,r,body", {"0,0,0,1,1", "1,0,0,1,1", "0,1,0,1,1", "1,1,0,1,1", "5,5,5,1,0"}, {"in one plane"});
    refused("x,y,r,body", {"0,0,1,1.5", "3,0,1,1.5"}, {"FILE:2", "body of disk 0", "1.5"});
    refused("x,y,r,body", {"0,0,1,-2", "3,0,1,-2"}, {"FILE:2", "-2"});
    expect_bad_input([] { read("x,y,r\n0,0,1\n", "mol"); }, {"no column 'mol' for the bodies", "x y r"});
}

BOOST_AUTO_TEST_CASE(members_are_put_together_across_the_boundary_of_a_cell) {
    const ForeignPacking file = read(dump("mol", {3, 8, 8, 0}), "mol");
    BOOST_TEST((file.packing.bars == std::vector<Bar>{{1, 2, 3}}));
    const std::string apart = dump("mol", {3, 8, 3, 0}); // x = 15 and 2 of a period of 16
    const ForeignPacking joined = read(apart, "mol");
    BOOST_TEST(joined.packing.coordinate(DiskId(2), 0) == 18);
    BOOST_TEST((joined.packing.bars == std::vector<Bar>{{0, 2, 5}}));
    expect_bad_input([&] { read(dump("mol", {3, 8, 0, 3}), "mol"); }, {"disk 3", "0.406 periods"});
}

} // namespace foreign_clumps
