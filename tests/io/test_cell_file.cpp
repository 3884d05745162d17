// Bars in state files.
#include "io/files.hpp"
#include "packing/cell_wrap.hpp"
#include "support/bad_input.hpp"
#include "support/cells.hpp"
#include "support/clumps.hpp"
#include "support/scratch.hpp"

#include <isostat/crafted/plateau.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

using namespace isostat;
using scratch::replaced;

namespace {

std::string tilted_text() {
    State state = cells::one_tilted_disk(2, 1, 0.25);
    state.load.infinitesimal = {0, 0};
    return state_text(state);
}

void refuses(const std::string& text, const std::vector<std::string>& words) {
    BOOST_TEST_INFO_SCOPE(text);
    expect_bad_input([&] { (void)parse_any_state(text, "cell.json"); }, words);
}

ForeignPacking read_foreign(const std::string& text, ForeignOptions options = {}) {
    options.cells = true;
    return parse_foreign(text, "file", options);
}

std::string dump_of(const std::string& bounds, const std::string& atoms, int count) {
    return "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" + std::to_string(count) + "\nITEM: BOX BOUNDS " + bounds +
           "\nITEM: ATOMS id x y radius\n" + atoms;
}

std::string state_with(const std::string& bars, const std::string& contacts) {
    return R"({"format": "isostat-state", "version": 2, "length": [4, 2], "disks": [[1, 1, 1], [3, 1, 1]], "bars": )" +
           bars + R"(, "contacts": )" + contacts + "}";
}

} // namespace

BOOST_AUTO_TEST_CASE(a_state_with_a_cell_comes_back) {
    State state = cells::one_tilted_disk(2, 1, 0.25);
    state.packing.cell.period_moves = {true, false};
    const State again = parse_any_state(state_text(state), "cell.json").state;
    BOOST_TEST((again.packing.cell == state.packing.cell));
    BOOST_TEST((again.packing.walls == state.packing.walls));
    BOOST_TEST(again.packing.q == state.packing.q);
    BOOST_TEST((again.load.shear == state.load.shear));
    BOOST_TEST((again.contacts == state.contacts));
    BOOST_TEST(state_text(again) == state_text(state));
}

BOOST_AUTO_TEST_CASE(contacts_are_read_from_one_end) {
    BOOST_TEST((parse_any_state(tilted_text(), "cell.json").state.contacts[1] == cells::across(0, 0, 1, -1)));
    refuses(replaced(tilted_text(), "[0,0,[1,-1]]", "[0,0,[-1,1]]"), {"contacts[1]", "[0,0,[1,-1]]", "one spelling"});
}

BOOST_AUTO_TEST_CASE(bad_cells_are_named) {
    const std::string text = tilted_text();
    refuses(replaced(text, "[0,0,[1,-1]]", "[0,0,[4,-1]]"), {"contacts[1][2][0]", "from -3 to 3 periods"});
    refuses(replaced(text, "[0,0,[1,-1]]", "[0,0]"), {"contacts[1]", "the image of one that is not itself"});
    refuses(replaced(text, "[0,0,[1,-1]]", "[0,0,[0,1]]"), {"0-0(0,1)", "already"});
    refuses(replaced(text, "\"length\": [2.0", "\"length\": [-2.0"),
            {"period along x is -2", "inverted or degenerate"});
    refuses(replaced(text, "\"length\": [2.0", "\"length\": [0.0"), {"period along x is 0"});
    refuses(replaced(text, "\"length\": [2.0", "\"length\": [1.5"), {"overlaps its own image (1, 0), 1.5 away"});
    refuses(replaced(text, "\"lower\":[\"absent\"", "\"lower\":[\"fixed\""), {"x is periodic and has walls"});
    refuses(replaced(text, "\"moves\":[\"x\"", "\"moves\":[\"z\""), {"cell.moves[0]", "\"xy\" (tilt)"});
    refuses(replaced(text, "\"pin\":0", "\"pin\":1"), {"cell.pin"});
    refuses(replaced(text, "\"kind\":\"nominal\"", "\"kind\":\"true\""), {"load.kind", "no potential"});
    refuses(replaced(text, "\"axes\":[\"periodic\",\"periodic\"]", "\"axes\":[\"periodic\",\"walls\"]"),
            {"period along y moves"});
    refuses(replaced(text, "\"infinitesimal\": [\n    [0.0", "\"infinitesimal\": [\n    [0.5"),
            {"infinitesimal along x", "exactly 0"});
}

BOOST_AUTO_TEST_CASE(a_cell_that_keeps_its_shape_comes_back) {
    State state = cells::two_disks(false, 1, 1);
    state.packing.length(0) = 3;
    state.contacts.clear();
    state.packing.cell.keep_shape();
    const std::string text = state_text(state);
    BOOST_TEST(text.find("\"moves\":[\"scale\"]") != std::string::npos);
    const State again = parse_any_state(text, "cell.json").state;
    BOOST_TEST((again.packing.cell == state.packing.cell));
    BOOST_TEST(DofMap(again.packing).dof_count() == 3);
    BOOST_TEST(state_text(again) == text);
    refuses(replaced(text, "[\"scale\"]", "[\"scale\",\"x\"]"), {"cell.moves[0]", "alone"});
    refuses(replaced(text, "[\"periodic\",\"periodic\"]", "[\"periodic\",\"walls\"]"), {"every axis is periodic"});
    State wide = state; // it touches its own image along x
    wide.packing.length(0) = 2.4;
    refuses(state_text(wide), {"keeps its shape", "own image along x"});
    State pushed = state;
    pushed.load.disk_force = {1, 0, -1, 0};
    refuses(state_text(pushed), {"disk_force", "keeps its shape"});
}

BOOST_AUTO_TEST_CASE(images_are_no_contacts_of_a_box) {
    const std::string text = replaced(state_text(::crafted::two_disks(1, 2, 1, 1)), "[0,1]", "[0,1,[1,0]]");
    refuses(text, {"images are of a periodic"});
}

BOOST_FIXTURE_TEST_CASE(readers_that_take_boxes_only_say_so, scratch::InFolder) {
    expect_bad_input([] { (void)parse_state(tilted_text(), "cell.json"); },
                     {"cell.json: a periodic cell", "takes boxes only so far"});
    const auto path = folder.path() / "cell.json";
    write_atomically(path, tilted_text());
    expect_bad_input([&] { (void)read_state(path); }, {"a periodic cell"});
    BOOST_TEST(read_any_state(path).state.contacts.size() == 3);
}

BOOST_AUTO_TEST_CASE(lammps_dumps_with_pp_boundaries_make_a_cell) {
    const auto file = read_foreign(dump_of("pp pp pp\n-1 1\n0 4\n0 1", "1 -0.5 0.25 0.5\n2 0.5 3.5 0.25\n", 2));
    const Packing& p = file.packing;
    BOOST_TEST((p.cell.all()));
    BOOST_TEST(p.q == (std::vector<double>{0.5, 0.25, 1.5, 3.5, 2, 4, 0}));
    BOOST_TEST(DofMap(p).dof_count() == 2);
    expect_bad_input(
        [] { (void)parse_foreign(dump_of("pp pp pp\n-1 1\n0 4\n0 1", "1 -0.5 0.25 0.5\n", 1), "file", {}); },
        {"boundaries along x are periodic"});
}

BOOST_AUTO_TEST_CASE(triclinic_dumps_bound_the_whole_parallelogram) {
    // xlo = -1, xhi = 1, xy = -0.5: the bounds are -1.5 and 1.
    const auto file =
        read_foreign(dump_of("xy xz yz pp pp pp\n-1.5 1 -0.5\n0 4 0\n0 1 0", "1 -0.5 0.25 0.5\n2 1.25 4.25 0.25\n", 2));
    const Packing& p = file.packing;
    BOOST_TEST(p.lattice(0, 0) == 2);
    BOOST_TEST(p.lattice(0, 1) == -0.5);
    // The second disk is one period up: (1.25 + 1 + 0.5, 0.25), and then one back.
    BOOST_TEST(p.q[2] == 0.75);
    BOOST_TEST(p.q[3] == 0.25);
}

BOOST_AUTO_TEST_CASE(lammps_data_is_periodic_when_stated) {
    const std::string data = "a comment\n\n1 atoms\n\n0 2 xlo xhi\n0 1.75 ylo yhi\n-0.5 0.5 zlo zhi\n1 0 0 xy xz yz\n\n"
                             "Atoms # sphere\n\n1 1 2 1 0.75 0.5 0\n";
    expect_bad_input([&] { (void)read_foreign(data); }, {"tilted by 1", "--periodic"});
    ForeignOptions stated{.periodic = true};
    const Packing p = read_foreign(data, stated).packing;
    BOOST_TEST(p.q == (std::vector<double>{0.75, 0.5, 2, 1.75, 1}));
}

BOOST_AUTO_TEST_CASE(extended_xyz_with_a_lattice_makes_a_cell) {
    const std::string text =
        "1\nLattice=\"2 0 0 1 1.75 0 0 0 1\" Properties=id:I:1:pos:R:3:radius:R:1\n7 0.75 0.5 0 1\n";
    const Packing p = read_foreign(text).packing;
    BOOST_TEST(p.q == (std::vector<double>{0.75, 0.5, 2, 1.75, 1}));
    const std::string strip =
        replaced(replaced(text, "2 0 0 1 1.75", "2 0 0 0 1.75"), "Properties", "pbc=\"T F F\" Properties");
    const Packing q = read_foreign(strip).packing;
    BOOST_TEST(q.cell.periodic[0]);
    BOOST_TEST(!q.cell.periodic[1]);
}

BOOST_AUTO_TEST_CASE(disks_are_put_into_the_cell_by_whole_periods) {
    State state = cells::in_cell({{0.25, -0.5, 4.25}, {0.25, 0.75, 0.5}}, {2, 1.75, 1}, true, 1, 1, {});
    const Wrapped wrapped = wrap_into_cell(state.packing);
    // (-0.5, 4.25) less two periods (1, 1.75) is (-2.5, 0.75), in fractions (-2.93 / 2, 0.43): two more along x.
    BOOST_TEST(state.packing.q == (std::vector<double>{1.5, 0.75, 0.75, 0.5, 2, 1.75, 1}));
    BOOST_TEST((wrapped.periods[0] == PerAxis<double>{-2, 2}));
    BOOST_TEST((wrapped.periods[1] == PerAxis<double>{}));
    BOOST_TEST(wrap_into_cell(state.packing).rounding == 0);
    state.packing.cell.periodic = {false, true}; // nothing moves along x, nor does the tilt count
    state.packing.q = {-5, 4.25, 9, 0.5, 2, 1.75, 0};
    (void)wrap_into_cell(state.packing);
    BOOST_TEST(state.packing.q == (std::vector<double>{-5, 0.75, 9, 0.5, 2, 1.75, 0}));
}

BOOST_AUTO_TEST_CASE(what_is_written_of_a_cell_is_read_bit_for_bit) {
    for (const char* name : {"rect_16", "tilt_16", "channel_16"}) {
        const Packing stored = cells::of_file(name).packing;
        Packing wrapped = stored;
        BOOST_TEST(wrap_into_cell(wrapped).rounding > 0);
        for (const std::string format : {"lammps-data", "xyz"}) {
            BOOST_TEST_INFO_SCOPE(name << " " << format);
            ForeignOptions options;
            options.periodic = format == "lammps-data"; // says nothing where no disk was moved
            const bool channel = !stored.cell.periodic[1];
            if (options.periodic && channel) {
                continue; // of a data file either both axes repeat or what its image flags say
            }
            const auto file =
                read_foreign(options.periodic ? lammps_data_text(stored, name) : xyz_text(stored, {}), options);
            BOOST_TEST(file.format == format);
            BOOST_TEST((file.packing.cell.periodic == stored.cell.periodic));
            BOOST_TEST(file.packing.radius == stored.radius, boost::test_tools::per_element());
            std::vector<double> wanted = wrapped.q;
            wanted[wanted.size() - 2] = channel ? 0 : wanted[wanted.size() - 2]; // no wall is read
            BOOST_TEST(file.packing.q == wanted, boost::test_tools::per_element());
        }
    }
    const State one = cells::one_tilted_disk(2, 1, 0.25);
    BOOST_TEST(lammps_data_text(one.packing, "t").find("\n0 2 xlo xhi\n") != std::string::npos);
    BOOST_TEST(lammps_data_text(one.packing, "t").find("\n1 0 0 xy xz yz\n") != std::string::npos);
    State out = cells::one_disk(1, 1);
    BOOST_TEST(lammps_data_text(out.packing, "t").find("xy xz yz") == std::string::npos);
    out.packing.q[0] = -3.75; // two periods left of 0.25
    BOOST_TEST(lammps_data_text(out.packing, "t").ends_with("\n1 1 2 1 0.25 0.5 0 -2 0 0\n"));
    BOOST_TEST(
        csv_text(one.packing).starts_with("# box 0:2,0:1.7320508075688772, tilt 1, periodic along xy\nid,x,y,r\n"));
    const Packing box = ::crafted::two_disks(1, 2, 1, 1).packing;
    BOOST_TEST(lammps_data_text(box, "t").find("xy xz yz") == std::string::npos);
    BOOST_TEST(xyz_text(box, {}).find("pbc=\"F F F\"") != std::string::npos);
    BOOST_TEST(csv_text(box).find("periodic") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(foreign_cells_that_are_none_are_named) {
    expect_bad_input([] { (void)read_foreign(dump_of("pp pp pp\n1 1\n0 4\n0 1", "1 0 0 0.5\n", 1)); },
                     {"file: period 0 along x", "positive"});
    expect_bad_input([] { (void)read_foreign(dump_of("pp pp pp\n1 0\n0 4\n0 1", "1 0 0 0.5\n", 1)); },
                     {"file:6", "upper bound", "above the lower bound"});
    expect_bad_input([] { (void)read_foreign(dump_of("xy xz yz pp ff pp\n0 2 1\n0 4 0\n0 1 0", "1 0 0 0.5\n", 1)); },
                     {"tilted by 1", "both axes periodic"});
    const auto lattice = [](const std::string& vectors) {
        return "1\nLattice=\"" + vectors + "\" Properties=pos:R:3:radius:R:1\n0 0 0 0.5\n";
    };
    BOOST_TEST(read_foreign(lattice("-2 0 0 0 2 0 0 0 1")).packing.length(0) == 2);
    const Packing turned = read_foreign(lattice("2 1 0 0 2 0 0 0 1")).packing;
    BOOST_TEST(std::abs(turned.length(0) - std::sqrt(5.0)) < 1e-15);
    BOOST_TEST(std::abs(turned.lattice(0, 1) - 2 / std::sqrt(5.0)) < 1e-15);
    BOOST_TEST(std::abs(turned.length(1) - 4 / std::sqrt(5.0)) < 1e-15);
    for (const char* out : {"2 0 1 0 2 0 0 0 1", "2 0 0 0 2 0 1 0 1"}) {
        expect_bad_input([&] { (void)read_foreign(lattice(out)); }, {"file:2", "in the plane of the disks"});
    }
    expect_bad_input([&] { (void)read_foreign(lattice("2 0 0 4 0 0 0 0 1")); }, {"period 0 along y"});
    ForeignOptions walls{.walls = ForeignWalls::box};
    expect_bad_input([&] { (void)read_foreign(lattice("2 0 0 0 2 0 0 0 1"), walls); }, {"walls or a box were stated"});
    walls.walls_unless_periodic = true;
    BOOST_TEST(read_foreign(lattice("2 0 0 0 2 0 0 0 1"), walls).packing.cell.all());
}

BOOST_AUTO_TEST_CASE(a_packing_that_is_isostatic_under_pressure_is_found_so) {
    // The first equilibrium in a rectangle with one contact less on the backbone: what a fixed shape needs.
    Packing packing = cells::of_file("rect_16").packing;
    packing.cell.period_moves = {false, false};
    const auto counts = [&](Strain strain) {
        return isostat::crafted::plateau(packing, {1e-9}, strain).steps.front().backbone;
    };
    BOOST_TEST(counts(Strain::diagonal).contact_count == 30);
    BOOST_TEST((counts(Strain::diagonal).isostatic == Verdict::proved));
    BOOST_TEST(counts(Strain::isotropic).hyperstaticity == 1);
    BOOST_TEST((counts(Strain::isotropic).isostatic == Verdict::refuted));
    BOOST_TEST(counts(Strain::full).mechanisms == 1);
    BOOST_TEST(counts(Strain::none).hyperstaticity == 2);
}

BOOST_AUTO_TEST_CASE(bars_come_back_bit_for_bit_and_close_the_list_of_contacts) {
    const State state = isostat::test::clumps_of(state_with(R"([[0, 1, "0x1.0000000000001p1"]])", R"([[0, "left"]])"));
    BOOST_TEST(state.packing.bars.size() == 1U);
    BOOST_TEST(state.packing.bars[0].length == 0x1.0000000000001p1);
    BOOST_TEST_REQUIRE(state.contacts.size() == 2U);
    BOOST_TEST((state.contacts[1] == isostat::Contact{ContactKind::bar, 0, 1}));
    const State again = isostat::test::clumps_of(isostat::state_text(state));
    BOOST_TEST((again.packing.bars == state.packing.bars));
    BOOST_TEST((again.contacts == state.contacts));
}

BOOST_AUTO_TEST_CASE(bars_that_a_state_cannot_have_are_refused) {
    const auto refused = [](const std::string& bars, const std::string& contacts) {
        BOOST_TEST_INFO_SCOPE(bars << " " << contacts);
        BOOST_CHECK_THROW((void)isostat::test::clumps_of(state_with(bars, contacts)), Error);
    };
    for (const char* const bars :
         {"[[0, 2, 1]]", "[[1, 0, 1]]", "[[0, 0, 1]]", "[[0, 1]]", "[[0, 1, 0]]", "[[0, 1, -1]]", "[[0, 1, \"nan\"]]",
          "[[0, 1, 1], [0, 1, 2]]", "[[0, 1, 1e999]]", "[[0.5, 1, 1]]", "{\"0\": 1}", "7"}) {
        refused(bars, "[]");
    }
    refused("[[0, 1, 2]]", R"([["bar", 1, 0]])");
    refused("[[0, 1, 2]]", R"([["bar", 0, 1], ["bar", 0, 1]])");
    refused("[[0, 1, 2]]", R"([["bar", 0, 2]])");
    refused("[]", R"([["bar", 0, 1]])");
}

BOOST_AUTO_TEST_CASE(bodies_bounded_by_arcs_come_back_and_are_taken_only_where_they_are_asked_for) {
    const State state = isostat::test::oval_in_a_box(1, 1);
    BOOST_TEST((state.packing.arcs == std::vector<std::vector<int>>{{0, 1, 2, 3}}));
    const std::string text = isostat::state_text(state);
    BOOST_TEST((isostat::test::clumps_of(text).packing.arcs == state.packing.arcs));
    for (const Dimensions taken : {Dimensions::two, Dimensions::any, Dimensions::any_clumps}) {
        BOOST_CHECK_THROW((void)isostat::parse_any_state(text, "ovals", taken), Error);
    }
    for (const char* const other : {"[[0, 1, 2]]", "[[0, 1, 2, 4]]", "[[0, 1, 2, 2.5]]", "[0, 1, 2, 3]",
                                    "[[3, 2, 1, 0]]", "{}", "[[0, 1, 2, -1]]"}) {
        std::string spoilt = text;
        const std::size_t begin = spoilt.find("\"arcs\": [") + 8;
        const std::size_t end = spoilt.find("]\n  ]", begin) + 5;
        spoilt.replace(begin, end - begin, other);
        BOOST_CHECK_THROW((void)isostat::test::clumps_of(spoilt), Error);
        BOOST_TEST_INFO(other);
    }
}

BOOST_AUTO_TEST_CASE(what_takes_single_grains_refuses_clumps) {
    const std::string text = state_with("[[0, 1, 2]]", "[]");
    BOOST_CHECK_THROW((void)isostat::parse_any_state(text, "clumps", Dimensions::any), Error);
    BOOST_CHECK_THROW((void)isostat::parse_state(text, "clumps"), Error);
    BOOST_CHECK_NO_THROW((void)isostat::parse_any_state(text, "clumps", Dimensions::any_clumps));
}
