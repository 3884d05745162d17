#include "oracle/packings.hpp"
#include "support/bad_input.hpp"
#include "support/scale.hpp"

#include <gmpxx.h>

using namespace isostat;
using namespace isostat::oracle;

namespace {

Packing random_box(int n, double low, double high, Random& random) {
    Packing packing;
    for (int i = 0; i < n; ++i) {
        packing.radius.push_back(random.real(0.01, 0.05) * high);
        packing.q.push_back(random.real(low, high));
        packing.q.push_back(random.real(low, high));
    }
    packing.q.insert(packing.q.end(), {high, random.real(0.5, 1) * high});
    return packing;
}

void is_valid(const Packing& packing) {
    BOOST_CHECK_NO_THROW(validate(packing, "scene.toml"));
}

void refused(const Packing& packing, const std::vector<std::string>& words) {
    expect_bad_input([&] { validate(packing, "scene.toml"); }, words);
}

} // namespace

BOOST_AUTO_TEST_CASE(snapped_coordinates_are_on_the_grid_and_near_where_they_were) {
    Random random(41);
    for (int repeat = 0; repeat < testing::scaled(400); ++repeat) {
        const double unit = std::ldexp(1 + random.real(), random.integer(1800) - 900);
        const double low = repeat % 3 == 0 ? -unit : repeat % 3 == 1 ? 0 : 0.9 * unit;
        const Packing before = random_box(20, low, unit, random);
        Packing after = before;
        snap_to_grid(after);
        const double step = grid_step(before);
        // 2^52 steps cover the largest coordinate, 2^51 do not.
        double largest = 0;
        for (const double x : before.q) {
            largest = std::max(largest, std::abs(x));
        }
        BOOST_TEST(std::ldexp(step, 52) >= largest);
        BOOST_TEST(std::ldexp(step, 51) < largest);
        for (std::size_t k = 0; k < before.q.size(); ++k) {
            const double multiple = after.q[k] / step;
            BOOST_TEST(multiple == std::nearbyint(multiple));
            BOOST_TEST(std::abs(after.q[k] - before.q[k]) <= step / 2);
        }
        BOOST_TEST(grid_step(after) == step);
    }
}

BOOST_AUTO_TEST_CASE(differences_of_snapped_coordinates_are_exact) {
    Random random(42);
    for (int repeat = 0; repeat < testing::scaled(60); ++repeat) {
        Packing packing = random_box(12, repeat % 2 == 0 ? -1 : 0, 1, random);
        if (repeat % 3 == 0) { // tiny coordinates have bits far below the step
            packing.q[0] *= 1e-12;
            packing.q[3] *= -1e-20;
        }
        snap_to_grid(packing);
        for (const double x : packing.q) {
            for (const double y : packing.q) {
                BOOST_TEST((mpq_class(x - y) == mpq_class(x) - mpq_class(y)));
            }
        }
    }
}

BOOST_AUTO_TEST_CASE(snapping_is_idempotent_and_commutes_with_powers_of_two) {
    Random random(43);
    for (int repeat = 0; repeat < testing::scaled(200); ++repeat) {
        const Packing before = random_box(10, repeat % 2 == 0 ? -1 : 0, 1, random);
        Packing once = before;
        snap_to_grid(once);
        Packing twice = once;
        snap_to_grid(twice);
        BOOST_TEST(twice.q == once.q);
        const int exponent = random.integer(1600) - 800;
        Packing scaled = before;
        for (double& x : scaled.q) {
            x = std::ldexp(x, exponent);
        }
        snap_to_grid(scaled);
        for (std::size_t k = 0; k < once.q.size(); ++k) {
            BOOST_TEST(scaled.q[k] == std::ldexp(once.q[k], exponent));
        }
        // Mirrored: the grid is symmetric.
        Packing mirrored = before;
        for (double& x : mirrored.q) {
            x = -x;
        }
        snap_to_grid(mirrored);
        for (std::size_t k = 0; k < once.q.size(); ++k) {
            BOOST_TEST(mirrored.q[k] == -once.q[k]);
        }
    }
}

BOOST_AUTO_TEST_CASE(snapping_moves_only_what_can_move_and_says_how_far) {
    Packing packing;
    packing.radius = {1, 0.5};
    packing.q = {1, 1.1, 2.4, 0.7, 1e15, 2.1};
    packing.fixed = {0, 1};
    packing.walls.upper = {WallKind::absent, WallKind::movable};
    Packing snapped = packing;
    BOOST_TEST(snap_to_grid(snapped) <= 0x1p-51); // an absent wall has no say
    BOOST_TEST(snapped.q[2] == 2.4);
    packing.walls.upper = {WallKind::fixed, WallKind::movable}; // now the grid is coarse
    snapped = packing;
    const double moved = snap_to_grid(snapped);
    BOOST_TEST(moved == std::max(std::abs(snapped.q[1] - packing.q[1]), std::abs(snapped.q[5] - packing.q[5])));
    BOOST_TEST(moved > 0.01);
    BOOST_TEST(snapped.q[2] == 2.4);
    BOOST_TEST(snapped.q[3] == 0.7);
    BOOST_TEST(snapped.q[4] == 1e15);
}

BOOST_AUTO_TEST_CASE(snapping_survives_the_ends_of_the_range_of_doubles) {
    for (const double unit : {std::numeric_limits<double>::max(), 0x1p1023, 0x1p-1000, 0x1p-1060,
                              std::numeric_limits<double>::denorm_min(), 0.0}) {
        Packing packing;
        packing.radius = {1};
        packing.q = {unit, -unit / 3, unit, unit / 7};
        Packing snapped = packing;
        snap_to_grid(snapped);
        for (std::size_t k = 0; k < packing.q.size(); ++k) {
            BOOST_TEST(std::isfinite(snapped.q[k]));
            BOOST_TEST(std::abs(snapped.q[k] - packing.q[k]) <= std::ldexp(unit, -52));
        }
        if (unit < 0x1p1023) { // beyond, rounding up could overflow: nothing is snapped
            BOOST_TEST((mpq_class(snapped.q[0] - snapped.q[3]) == mpq_class(snapped.q[0]) - mpq_class(snapped.q[3])));
        }
    }
}

BOOST_AUTO_TEST_CASE(valid_packings_pass) {
    Packing packing = square_lattice(3, 2);
    is_valid(packing);
    enclose(packing, 0);
    is_valid(packing);
    packing.fixed.assign(9, 0);
    is_valid(packing);
    Packing tight;
    tight.radius = {1};
    tight.q = {1, 1, 2, 2};
    is_valid(tight);
}

BOOST_AUTO_TEST_CASE(a_cell_of_spheres_keeps_its_shape_where_none_touches_itself_along_a_period_at_rest) {
    Packing packing;
    packing.dimension = packing.cell.dimension = 3;
    packing.walls = Walls::none();
    packing.radius = {1};
    packing.q = {0, 0, 0, 3, 2.5, 2, 0, 0, 0};
    packing.cell.repeat();
    packing.cell.keep_shape();
    is_valid(packing);
    packing.q[4] = 2; // L_y
    refused(packing, {"keeps its shape", "sphere"});
}

BOOST_AUTO_TEST_CASE(each_defect_is_named_with_its_place_and_value) {
    Packing good = square_lattice(3, 2);
    enclose(good, 0);
    Packing bad;
    refused(bad, {"scene.toml", "no disks"});
    for (const double r :
         {0.0, -1.5, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        bad = good;
        bad.radius[4] = r;
        refused(bad, {"scene.toml", "radius of disk 4", "positive"});
    }
    bad = good;
    bad.radius[4] = -1.5;
    refused(bad, {"-1.5"});
    bad = good;
    bad.q[7] = std::numeric_limits<double>::quiet_NaN();
    refused(bad, {"y of disk 3", "finite"});
    bad = good;
    bad.q[6] = std::numeric_limits<double>::infinity();
    refused(bad, {"x of disk 3", "inf"});
    bad = good;
    bad.q.pop_back();
    refused(bad, {"19 coordinates", "9 disks", "20"});
    bad = good;
    bad.fixed = {1, 0};
    refused(bad, {"2 flags", "9 disks"});
    for (const double length : {-6.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
        bad = good;
        bad.length(1) = length;
        refused(bad, {"top wall", "positive"});
    }
    bad = good;
    bad.radius[8] = 3.25;
    refused(bad, {"disk 8", "6.5", "larger than the box", "6"});
    bad.walls = Walls::none(); // without walls there is no box to be larger than
    is_valid(bad);
}

BOOST_AUTO_TEST_CASE(degrees_of_freedom_of_the_box_are_all_coordinates) {
    Packing packing = square_lattice(2, 2);
    enclose(packing, 0);
    const DofMap dofs(packing);
    BOOST_TEST(dofs.dof_count() == 10);
    for (int k = 0; k < 10; ++k) {
        BOOST_TEST(dofs.dof_of(static_cast<std::size_t>(k)) == k);
        BOOST_TEST(dofs.coordinate_of(k) == k);
    }
    BOOST_TEST(dofs.name(0) == "x of disk 0");
    BOOST_TEST(dofs.name(7) == "y of disk 3");
    BOOST_TEST(dofs.name(8) == "right wall");
    BOOST_TEST(dofs.name(9) == "top wall");
}

BOOST_AUTO_TEST_CASE(fixed_disks_and_walls_that_cannot_move_have_no_degree_of_freedom) {
    Packing packing = square_lattice(2, 2);
    enclose(packing, 0);
    packing.fixed = {0, 1, 0, 1};
    packing.walls.upper[0] = WallKind::fixed;
    const DofMap dofs(packing);
    BOOST_TEST(dofs.dof_count() == 5);
    const std::vector<int> expected = {0, 1, -1, -1, 2, 3, -1, -1, -1, 4};
    for (std::size_t k = 0; k < expected.size(); ++k) {
        BOOST_TEST(dofs.dof_of(k) == expected[k]);
        if (expected[k] >= 0) {
            BOOST_TEST(dofs.coordinate_of(expected[k]) == static_cast<int>(k));
        }
    }
    BOOST_TEST(dofs.name(2) == "x of disk 2");
    BOOST_TEST(dofs.name(4) == "top wall");
    packing.walls = Walls::none();
    BOOST_TEST(DofMap(packing).dof_count() == 4);
    packing.fixed = {1, 1, 1, 1};
    BOOST_TEST(DofMap(packing).dof_count() == 0);
}

BOOST_AUTO_TEST_CASE(solid_fraction_of_a_square_lattice) {
    Packing packing = square_lattice(5, 2);
    enclose(packing, 0);
    BOOST_TEST(packing.solid_fraction() == std::numbers::pi / 4, boost::test_tools::tolerance(1e-15));
    BOOST_TEST(packing.min_radius() == 1);
    packing.radius[3] = 0.5;
    BOOST_TEST(packing.min_radius() == 0.5);
    BOOST_TEST(packing.max_radius() == 1);
    BOOST_TEST(!packing.is_fixed(DiskId(3)));
    packing.fixed.assign(25, 0);
    packing.fixed[3] = 1;
    BOOST_TEST(packing.is_fixed(DiskId(3)));
    BOOST_TEST(!packing.is_fixed(DiskId(4)));
}

BOOST_AUTO_TEST_CASE(on_the_grid_is_a_multiple_of_the_step_and_nothing_else) {
    for (const double unit : {1.0, 0x1p400, 0x1p-400}) {
        isostat::Packing packing;
        packing.radius = {unit};
        packing.q = {unit, 1.25 * unit, 3 * unit, 3 * unit};
        const double step = isostat::grid_step(packing);
        for (const double x : {0.0, step, -step, 3 * step, unit + step}) {
            packing.q[0] = x;
            BOOST_TEST(isostat::is_on_grid(packing), x);
        }
        for (const double x : {0.5 * step, -0.5 * step, 1.5 * step, 5e-324, 0x1p-600 * unit}) {
            packing.q[0] = x;
            BOOST_TEST(!isostat::is_on_grid(packing), x);
        }
    }
}
