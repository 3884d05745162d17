#include "report/picture.hpp"
#include "support/cells.hpp"
#include "support/crafted.hpp"
#include "support/scratch.hpp"

using namespace isostat;
using scratch::count;

namespace {

/// Widths of the lines of a class, in order.
std::vector<double> widths(const std::string& svg, const std::string& style) {
    std::vector<double> list;
    for (const std::string& line : scratch::split(svg, '\n')) {
        if (line.starts_with("<line") && line.find("class=\"" + style + "\"") != std::string::npos) {
            list.push_back(std::stod(line.substr(line.find("stroke-width=\"") + 14)));
        }
    }
    return list;
}

/// Contacts: left(0), bottom(0), 0-1, right(1), top(1), bottom(1).
const State state = crafted::two_disks(1, 2, 1, 1);

} // namespace

BOOST_AUTO_TEST_CASE(a_picture_has_every_disk_wall_and_contact_once) {
    const std::string svg = force_picture(state, std::vector<double>{1, 2, 3, 4, 5, 6}, "a < b & c");
    BOOST_TEST(count(svg, "<circle") == 2);
    BOOST_TEST(count(svg, "class=\"fixed\"") == 2);
    BOOST_TEST(count(svg, "class=\"movable\"") == 2);
    BOOST_TEST(widths(svg, "force").size() == 1U);
    BOOST_TEST(widths(svg, "force wall").size() == 5U);
    BOOST_TEST(count(svg, "a &lt; b &amp; c") == 2);
    BOOST_TEST(count(svg, "<svg") == 1);
    BOOST_TEST(count(svg, "</svg>") == 1);
}

BOOST_AUTO_TEST_CASE(line_widths_are_proportional_to_forces) {
    const std::string svg = force_picture(state, std::vector<double>{1, 2, 3, 4, 5, 6}, "");
    const std::vector<double> wall = widths(svg, "force wall");
    const double unit = widths(svg, "force")[0] / 3;
    for (const auto& [k, f] : {std::pair{0, 1}, {1, 2}, {2, 4}, {3, 5}, {4, 6}}) {
        BOOST_TEST(std::abs(wall[static_cast<std::size_t>(k)] - f * unit) < 2e-3);
    }
    // 0.2 of the mean radius 1.5 at the mean force 3.5, 1000 units across the box.
    BOOST_TEST(std::abs(unit * 3.5 - 0.2 * 1.5 * 1000 / state.packing.length(0)) < 1e-2);
}

BOOST_AUTO_TEST_CASE(disks_without_force_are_rattlers_and_traction_is_marked) {
    const std::vector<double> forces{0, 0, 0, 4, -5, 6};
    const std::string svg = force_picture(state, forces, "");
    BOOST_TEST(count(svg, "class=\"rattler\"") == 1);
    BOOST_TEST(count(svg, "class=\"disk\"") == 1);
    BOOST_TEST(count(svg, "class=\"contact\"") == 3);
    BOOST_TEST(count(svg, "class=\"traction\"") == 1);
    BOOST_TEST((rattler_flags(state, forces) == std::vector<unsigned char>{1, 0}));
    BOOST_TEST(count(force_picture(state, {}, ""), "class=\"rattler\"") == 0);
}

BOOST_AUTO_TEST_CASE(a_picture_has_a_scale_of_its_forces_and_the_stresses_on_movable_walls) {
    const std::string svg = force_picture(state, std::vector<double>{1, 2, 3, 4, 5, 6}, "");
    const double unit = widths(svg, "force")[0] / 3;
    const std::vector<double> scale = widths(svg, "force scale");
    BOOST_TEST_REQUIRE(scale.size() == 2U);
    BOOST_TEST(std::abs(scale[0] - 3.5 * unit) < 2e-3);
    BOOST_TEST(std::abs(scale[1] - 10.5 * unit) < 2e-3);
    BOOST_TEST(count(svg, "mean force: 3.5<") == 1);
    BOOST_TEST(count(svg, "class=\"stress\"") == 2 * 3 * 3); // two walls, three arrows of three lines each
    BOOST_TEST(count(svg, "\u03c3\u2081 = 1<") == 1);
    BOOST_TEST(count(svg, "\u03c3\u2082 = 1<") == 1);
    State fixed = state;
    fixed.packing.walls.upper = {WallKind::fixed, WallKind::fixed};
    BOOST_TEST(count(force_picture(fixed, {}, ""), "class=\"stress\"") == 0);
    BOOST_TEST(count(force_picture(fixed, {}, ""), "class=\"force scale\"") == 0);
}

BOOST_AUTO_TEST_CASE(a_cell_is_drawn_with_its_images_and_contacts_from_both_sides) {
    const State one = cells::one_tilted_disk(2, 1, 0.25);
    const std::string svg = force_picture(one, std::vector<double>{1, 2, 3}, "");
    BOOST_TEST(count(svg, "class=\"cell\"") == 4);
    BOOST_TEST(count(svg, "class=\"disk\"") == 1);
    BOOST_TEST(count(svg, "class=\"disk image\"") == 7); // that at (-2.75, -1.23) is out of the picture
    BOOST_TEST(widths(svg, "force") ==
               (std::vector<double>{widths(svg, "force")[0], widths(svg, "force")[0], widths(svg, "force")[2],
                                    widths(svg, "force")[2], widths(svg, "force")[4], widths(svg, "force")[4]}));
    BOOST_TEST(widths(svg, "force")[4] > 2.9 * widths(svg, "force")[0]);
    // Other representatives, the same picture.
    const State moved =
        cells::with_other_representatives(cells::two_disks(false, 1, 1), {cells::image(1, 0), cells::image(-1, 2)});
    const std::vector<double> forces{1, 2, 3, 4};
    BOOST_TEST(count(force_picture(moved, forces, ""), "<circle") ==
               count(force_picture(cells::two_disks(false, 1, 1), forces, ""), "<circle"));
    BOOST_TEST(widths(force_picture(moved, forces, ""), "force") ==
                   widths(force_picture(cells::two_disks(false, 1, 1), forces, ""), "force"),
               boost::test_tools::per_element());
    const std::string strip = force_picture(cells::channel_disk(), std::vector<double>{1, 2, 3}, "");
    BOOST_TEST(count(strip, "class=\"cell\"") == 2);
    BOOST_TEST(count(strip, "class=\"fixed\"") == 1);
    BOOST_TEST(count(strip, "class=\"disk image\"") == 2);
    const std::string box = force_picture(state, std::vector<double>{1, 2, 3, 4, 5, 6}, "");
    BOOST_TEST(count(box, "cell") + count(box, "image") == 0);
}

BOOST_AUTO_TEST_CASE(vtk_of_a_cell_has_its_outline_and_ends_of_contacts_at_images) {
    const std::string vtk = vtk_text(cells::one_tilted_disk(2, 1, 0.25), std::vector<double>{1, 2, 3}, "title");
    BOOST_TEST(vtk.find("POINTS 8 double\n0.25 0.5 0\n1.25 2.232") != std::string::npos); // one period up
    BOOST_TEST(vtk.find("LINES 4 15\n2 0 1\n2 0 2\n2 0 3\n5 4 5 6 7 4\n") != std::string::npos);
    BOOST_TEST(vtk.find("CELL_DATA 5\nSCALARS force double 1\nLOOKUP_TABLE default\n0\n1\n2\n3\n0\n") !=
               std::string::npos);
}

BOOST_AUTO_TEST_CASE(forces_of_spheres_are_tubes_of_a_radius_in_proportion) {
    State one;
    one.packing.dimension = one.packing.cell.dimension = 3;
    one.packing.radius = {1};
    one.packing.q = {1, 1, 1, 2, 2, 2};
    one.packing.walls = Walls::box(3);
    one.contacts = {{ContactKind::lower_wall, 0, 2}, {ContactKind::upper_wall, 0, 2}};
    const std::string vtk = vtk_text(one, std::vector<double>{1, 3}, "title");
    BOOST_TEST(vtk.find("POINTS 5 double\n1 1 1\n1 1 1\n1 1 0\n1 1 1\n1 1 2\n") != std::string::npos);
    BOOST_TEST(vtk.find("LINES 2 6\n2 1 2\n2 3 4\n") != std::string::npos);
    // A quarter of the radius at the mean force, which is 2.
    BOOST_TEST(vtk.find("SCALARS tube double 1\nLOOKUP_TABLE default\n0\n0.125\n0.125\n0.375\n0.375\n") !=
               std::string::npos);
    BOOST_TEST(vtk_text(state, std::vector<double>{0, 0, 0, 4, 5, 6}, "title").find("tube") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(displacements_are_vectors_of_the_disks) {
    const std::vector<double> moved{0.5, -0.25, 1, 2, 0, 0};
    const std::string vtk = vtk_text(state, {}, "title", moved);
    BOOST_TEST(vtk.find("VECTORS displacement double\n0.5 -0.25 0\n1 2 0\n0 0 0\n") != std::string::npos);
    BOOST_TEST(vtk_text(state, {}, "title").find("VECTORS") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(vtk_counts_agree_with_its_lists) {
    const std::string vtk = vtk_text(state, std::vector<double>{0, 0, 0, 4, 5, 6}, "title");
    std::istringstream in(vtk);
    std::string word, line;
    std::getline(in, line);
    BOOST_TEST(line == "# vtk DataFile Version 3.0");
    std::getline(in, line);
    BOOST_TEST(line == "title");
    int points = 0;
    in >> word >> word >> word >> word >> points >> word; // ASCII DATASET POLYDATA POINTS 7 double
    BOOST_TEST(points == 2 + 5);                          // five wall contacts end in a point of their own
    for (int k = 0; k < 3 * points; ++k) {
        double c = 0;
        BOOST_REQUIRE(in >> c);
        if (k == 3) {
            BOOST_TEST(c == state.packing.q[2]); // 17 digits: the same bits
        }
    }
    int cells = 0, size = 0;
    in >> word >> cells >> size;
    BOOST_TEST(word == "VERTICES");
    BOOST_TEST(cells == 2);
    for (int k = 0; k < size; ++k) {
        in >> word;
    }
    in >> word >> cells >> size;
    BOOST_TEST(word == "LINES");
    BOOST_TEST(cells == 6);
    for (int l = 0; l < cells; ++l) {
        int two = 0, a = 0, b = 0;
        in >> two >> a >> b;
        BOOST_TEST(two == 2);
        BOOST_TEST((a >= 0 && a < 2 && b > a && b < points));
    }
    const std::string rest = vtk.substr(vtk.find("POINT_DATA"));
    BOOST_TEST(rest.starts_with("POINT_DATA 7\nSCALARS radius double 1\nLOOKUP_TABLE default\n1\n2\n0\n"));
    BOOST_TEST(rest.find("SCALARS rattler int 1\nLOOKUP_TABLE default\n1\n0\n0\n") != std::string::npos);
    BOOST_TEST(rest.ends_with("CELL_DATA 8\nSCALARS force double 1\nLOOKUP_TABLE default\n0\n0\n0\n0\n0\n4\n5\n6\n"));
}
