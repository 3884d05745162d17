// Convex bodies bounded by arcs: what a packing may hold of these, which members are nearest, areas.
// Rigid bodies of several disks: what bars connect, and the area of a union.
#include "packing/arc_bodies.hpp"
#include "packing/bodies.hpp"
#include "support/clumps.hpp"
#include "support/test.hpp"

using namespace isostat;
using isostat::Bodies;
using isostat::Error;
using isostat::Packing;

namespace {

struct Spot {
    double x, y;
};

/// Ovals as in `oval_in_a_box`, at these places and angles, in a box of side 100.
Packing ovals_at(const std::vector<std::array<double, 3>>& places) {
    Packing packing;
    const std::array<std::array<double, 3>, 4> members{{{3, 0, 1}, {0, -4, 6}, {-3, 0, 1}, {0, 4, 6}}};
    for (const auto& [x, y, angle] : places) {
        const int first = packing.disk_count();
        for (const auto& [bx, by, r] : members) {
            packing.radius.push_back(r);
            packing.q.push_back(x + bx * std::cos(angle) - by * std::sin(angle));
            packing.q.push_back(y + bx * std::sin(angle) + by * std::cos(angle));
        }
        for (const auto& [i, j, length] : {std::tuple{0, 1, 5.0}, {0, 2, 6.0}, {0, 3, 5.0}, {1, 2, 5.0}, {2, 3, 5.0}}) {
            packing.bars.push_back({first + i, first + j, length});
        }
        packing.arcs.push_back({first, first + 1, first + 2, first + 3});
    }
    packing.q.insert(packing.q.end(), {100.0, 100.0});
    return packing;
}

/// Points of the boundary of an oval, by the arcs of its definition: 37 of each.
std::vector<Spot> boundary(const Packing& packing, int body) {
    const double joint = std::atan2(4, 3);
    std::vector<Spot> points;
    const std::array<double, 5> ends{-joint, joint, std::numbers::pi - joint, std::numbers::pi + joint,
                                     2 * std::numbers::pi - joint};
    const std::size_t first = 4 * static_cast<std::size_t>(body);
    const double turned = std::atan2(packing.q[2 * first + 1] - packing.q[2 * first + 5],
                                     packing.q[2 * first] - packing.q[2 * first + 4]);
    for (std::size_t k = 0; k < 4; ++k) {
        for (int p = 0; p < 37; ++p) {
            const double angle = turned + ends[k] + (ends[k + 1] - ends[k]) * p / 36;
            const std::size_t i = first + k;
            points.push_back({packing.q[2 * i] + packing.radius[i] * std::cos(angle),
                              packing.q[2 * i + 1] + packing.radius[i] * std::sin(angle)});
        }
    }
    return points;
}

/// The pairs of members that are said to be nearest.
std::vector<Contact> nearest_of(const Packing& packing, int one, int other) {
    const ArcBodies arcs(packing);
    std::vector<Contact> found;
    for (int i = 4 * one; i < 4 * one + 4; ++i) {
        for (int j = 4 * other; j < 4 * other + 4; ++j) {
            if (arcs.is_nearest(pair_of(i, j))) {
                found.push_back(pair_of(i, j));
            }
        }
    }
    return found;
}

constexpr double pi = std::numbers::pi;

/// Rows x, y, radius in a box of side 100.
Packing bodies_of(const std::vector<std::array<double, 3>>& rows, std::vector<isostat::Bar> bars) {
    Packing p;
    for (const auto& [x, y, r] : rows) {
        p.radius.push_back(r);
        p.q.insert(p.q.end(), {x, y});
    }
    p.q.insert(p.q.end(), {100.0, 100.0});
    p.bars = std::move(bars);
    return p;
}

double area_of(const Packing& p) {
    return p.solid_fraction() * 1e4;
}

/// What two circles of one radius have in common, of centres d apart.
double lens(double r, double d) {
    return 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d);
}

} // namespace

/// Of flat ovals on each other the lower flank of the lower one and the upper flank of the upper one face each other
/// too, with a gap of minus both heights.
BOOST_AUTO_TEST_CASE(of_two_bodies_the_arcs_with_the_larger_gap_are_nearest) {
    const Packing stacked = ovals_at({{20, 20, 0}, {20, 24.5, 0}});
    BOOST_TEST((nearest_of(stacked, 0, 1) == std::vector<Contact>{pair_of(1, 7)}));
    const ArcBodies arcs(stacked);
    BOOST_TEST(arcs.faces(pair_of(3, 5), 0)); // it faces, and is not nearest
    BOOST_TEST(arcs.is_nearest({ContactKind::lower_wall, 3, 1}));
    BOOST_TEST(!arcs.is_nearest({ContactKind::lower_wall, 1, 1}));
    BOOST_TEST(arcs.is_nearest({ContactKind::upper_wall, 0, 0}));
}

/// Against all pairs of points on the boundaries: bodies apart, at random places and angles.
BOOST_AUTO_TEST_CASE(the_gap_of_the_nearest_arcs_is_the_distance_of_the_bodies) {
    std::mt19937_64 random(45);
    std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
    std::uniform_real_distribution<double> far(4, 9);
    int apart = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const double direction = angle(random);
        const double distance = far(random);
        const Packing packing =
            ovals_at({{50, 50, angle(random)},
                      {50 + distance * std::cos(direction), 50 + distance * std::sin(direction), angle(random)}});
        const std::vector<Contact> nearest = nearest_of(packing, 0, 1);
        BOOST_TEST_REQUIRE(nearest.size() == 1U);
        double least = 1e9;
        for (const Spot& p : boundary(packing, 0)) {
            for (const Spot& q : boundary(packing, 1)) {
                least = std::min(least, std::hypot(q.x - p.x, q.y - p.y));
            }
        }
        const double gap = isostat::gap(packing, nearest.front());
        if (gap > 0) {
            ++apart;
            BOOST_TEST(gap <= least + 1e-12);
            BOOST_TEST(least < std::hypot(gap, 0.2)); // points lie 0.31 apart along a flank
        } else {
            BOOST_TEST(least < 0.16); // boundaries that cross: half of that distance
        }
    }
    BOOST_TEST(apart > 100);
    BOOST_TEST(apart < 390);
}

BOOST_AUTO_TEST_CASE(a_normal_is_inside_an_arc_up_to_its_joint) {
    const Packing upright = ovals_at({{20, 20, 0}});
    const double joint = std::atan2(4, 3);
    for (const double off : {1e-3, -1e-3, 1e-9, -1e-9}) { // the right wall sees the cap up to the joint
        Packing packing = ovals_at({{20, 20, joint + off}});
        const ArcBodies arcs(packing);
        BOOST_TEST(arcs.faces({ContactKind::upper_wall, 0, 0}, 1e-15) == (off < 0));
        BOOST_TEST(arcs.faces({ContactKind::upper_wall, 3, 0}, 1e-15) == (off > 0));
        BOOST_TEST(arcs.is_nearest({ContactKind::upper_wall, 0, 0}) == (off < 0));
        BOOST_TEST(!arcs.faces({ContactKind::upper_wall, 0, 0}, 5 * std::abs(off))); // the joint may be there
    }
    const ArcBodies arcs(upright);
    BOOST_TEST(!arcs.faces({ContactKind::upper_wall, 1, 0}, 0));
    BOOST_TEST(arcs.faces({ContactKind::bar, 0, 1}, 100));
    BOOST_TEST(!arcs.faces({ContactKind::upper_wall, 0, 0}, arcs.farthest()));
}

/// Its arcs: 12 cap^2 + ... = the sum of the sectors of the circles and of the rhombus of the centres.
BOOST_AUTO_TEST_CASE(the_area_of_an_oval_is_that_of_its_sectors_and_of_the_rhombus_between_their_centres) {
    const double joint = std::atan2(4, 3);
    const double sectors = 2 * joint * 1 + (std::numbers::pi - 2 * joint) * 36;
    const double area = sectors - 2 * 3 * 4; // the sectors of the flanks have the rhombus in common
    const Packing packing = ovals_at({{20, 20, 0.3}, {60, 60, 2}});
    BOOST_TEST(std::abs(packing.solid_fraction() * 1e4 - 2 * area) < 1e-9);
}

BOOST_AUTO_TEST_CASE(arcs_that_are_no_convex_curve_are_refused) {
    const Packing sound = ovals_at({{20, 20, 0.3}, {60, 60, 2}});
    BOOST_CHECK_NO_THROW(isostat::validate(sound, "ovals"));
    const std::vector<std::pair<const char*, std::function<void(Packing&)>>> faults{
        {"clockwise",
         [](Packing& p) {
             p.arcs[0] = {3, 2, 1, 0};
         }},
        {"another order",
         [](Packing& p) {
             p.arcs[0] = {0, 2, 1, 3};
         }},
        {"three of four",
         [](Packing& p) {
             p.arcs[0] = {0, 1, 2};
         }},
        {"twice",
         [](Packing& p) {
             p.arcs[0] = {0, 1, 2, 1};
         }},
        {"in two bodies", [](Packing& p) { p.arcs[1] = p.arcs[0]; }},
        {"of two bodies", [](Packing& p) { p.arcs[0][0] = 4; }},
        {"no disk", [](Packing& p) { p.arcs[0][0] = 8; }},
        {"below the first", [](Packing& p) { p.arcs[0][0] = -1; }},
        {"a bar that is longer by a rounding", [](Packing& p) { p.bars[0].length = std::nextafter(5.0, 6.0); }},
        {"radii whose difference is rounded",
         [](Packing& p) {
             p.radius[1] = p.radius[3] = 6 + 0x1p-50;
             p.radius[0] = p.radius[2] = 1 + 0x1p-52;
         }},
        {"equal radii", [](Packing& p) { p.radius[0] = 6; }},
        {"fixed",
         [](Packing& p) {
             p.fixed.assign(8, 0);
             p.fixed[0] = 1;
         }},
        {"a cap on the wrong side", [](Packing& p) {
             std::swap(p.q[0], p.q[4]);
             std::swap(p.q[1], p.q[5]);
         }}};
    for (const auto& [what, spoil] : faults) {
        Packing packing = sound;
        spoil(packing);
        BOOST_CHECK_THROW(isostat::validate(packing, "ovals"), Error);
        BOOST_TEST_INFO(what);
    }
    Packing again = sound;
    again.radius[1] = again.radius[3] = 6 + 0x1p-48; // a difference that is a double
    for (const std::size_t b : {0U, 2U, 3U, 4U}) {
        again.bars[b].length = 5 + 0x1p-48;
    }
    BOOST_CHECK_NO_THROW(isostat::validate(again, "ovals"));
}

BOOST_AUTO_TEST_CASE(what_bars_connect_is_one_body) {
    const Packing p = bodies_of({{10, 10, 1}, {20, 10, 1}, {30, 10, 1}, {40, 10, 1}, {50, 10, 1}},
                                {{0, 3, 30}, {1, 2, 10}, {2, 4, 20}, {1, 4, 30}});
    const Bodies bodies(p);
    BOOST_TEST(bodies.count() == 2);
    BOOST_TEST(bodies.of(3) == 0);
    BOOST_TEST(bodies.of(4) == 1);
    BOOST_TEST(bodies.members()[1] == (std::vector<int>{1, 2, 4}), boost::test_tools::per_element());
    BOOST_TEST(Bodies(bodies_of({{1, 1, 1}, {3, 1, 1}}, {})).count() == 2);
}

BOOST_AUTO_TEST_CASE(a_union_counts_once_what_members_share) {
    BOOST_TEST(std::abs(area_of(bodies_of({{10, 10, 1}, {11, 10, 1}}, {{0, 1, 1}})) - (2 * pi - lens(1, 1))) < 1e-9);
    BOOST_TEST(std::abs(area_of(bodies_of({{10, 10, 2}, {10.5, 10, 1}}, {{0, 1, 0.5}})) - 4 * pi) < 1e-9); // inside
    BOOST_TEST(std::abs(area_of(bodies_of({{10, 10, 2}, {14, 10, 1}}, {{0, 1, 4}})) - 5 * pi) < 1e-9);     // apart
    const Packing same = bodies_of({{10, 10, 2}, {10, 10, 2}}, {{0, 1, 1}}); // on each other
    BOOST_TEST(std::abs(area_of(same) - 4 * pi) < 1e-9);
}

BOOST_AUTO_TEST_CASE(two_spheres_count_once_what_they_share) {
    Packing p;
    p.dimension = p.cell.dimension = 3;
    p.walls = isostat::Walls::box(3);
    p.radius = {1, 1};
    p.q = {10, 10, 10, 11, 10, 10, 100, 100, 100};
    p.bars = {{0, 1, 1}};
    // A lens of two caps of height 1/2: 2 pi (1/4) (3 - 1/2) / 3.
    BOOST_TEST(std::abs(p.solid_fraction() * 1e6 - (8 * pi / 3 - 5 * pi / 12)) < 1e-9);
    p.q[3] = 10; // on each other
    BOOST_TEST(std::abs(p.solid_fraction() * 1e6 - 4 * pi / 3) < 1e-9);
    p.q[3] = 13;
    BOOST_TEST(std::abs(p.solid_fraction() * 1e6 - 8 * pi / 3) < 1e-9);
}

BOOST_AUTO_TEST_CASE(the_area_of_a_union_is_that_of_points_on_a_grid) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int sample = 0; sample < 20; ++sample) {
        std::vector<std::array<double, 3>> rows;
        for (int k = 0; k < 4; ++k) {
            rows.push_back({10 + 2 * uniform(random), 10 + 2 * uniform(random), 0.3 + uniform(random)});
        }
        constexpr double step = 0.005;
        int inside = 0;
        for (double x = 8; x < 14; x += step) {
            for (double y = 8; y < 14; y += step) {
                inside +=
                    std::ranges::any_of(rows, [&](const auto& d) { return std::hypot(d[0] - x, d[1] - y) < d[2]; }) ? 1
                                                                                                                    : 0;
            }
        }
        const Packing p = bodies_of(rows, {{0, 1, 1}, {0, 2, 1}, {1, 2, 1}, {1, 3, 1}, {2, 3, 1}});
        BOOST_TEST(std::abs(area_of(p) - inside * step * step) < 0.03);
    }
}

BOOST_AUTO_TEST_CASE(bars_that_make_no_rigid_body_are_refused) {
    const std::vector<std::array<double, 3>> three{{10, 10, 1}, {12, 10, 1}, {11, 12, 1}};
    const auto refused = [&](const std::vector<isostat::Bar>& bars) {
        BOOST_CHECK_THROW(isostat::validate(bodies_of(three, bars), "bars"), Error);
    };
    refused({{0, 1, 2}, {1, 2, 2}});                       // a bar is missing
    refused({{0, 1, 2}, {0, 1, 2}, {0, 2, 2}, {1, 2, 2}}); // twice
    refused({{1, 0, 2}});
    refused({{0, 0, 2}});
    refused({{0, 3, 2}});
    refused({{0, 1, 0}});
    refused({{0, 1, std::nan("")}});
    refused({{1, 2, 2}, {0, 1, 2}, {0, 2, 2}}); // not in order
    BOOST_CHECK_NO_THROW(isostat::validate(bodies_of(three, {{0, 1, 2}, {0, 2, 2}, {1, 2, 2}}), "bars"));
    BOOST_CHECK_NO_THROW(isostat::validate(bodies_of(three, {{0, 1, 2}}), "bars"));
    BOOST_CHECK_THROW(isostat::require_single_grains(bodies_of(three, {{0, 1, 2}}), "file", "this"), Error);
}
