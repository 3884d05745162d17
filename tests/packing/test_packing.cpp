#include "core/dot.hpp"
#include "oracle/packings.hpp"
#include "support/bad_input.hpp"
#include "support/free_grains.hpp"
#include "support/scale.hpp"

#include <isostat/packing/load.hpp>

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

Packing boxed() {
    Packing packing = square_lattice(2, 2);
    enclose(packing, 0.5);
    packing.length(1) = 7;
    return packing;
}

Load two_stresses() {
    Load load;
    load.stress = {2, 3};
    load.reference_length = {4, 8};
    return load;
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
        BOOST_TEST(std::ldexp(step, 52) >= largest(before.q));
        BOOST_TEST(std::ldexp(step, 51) < largest(before.q));
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
        std::ranges::transform(mirrored.q, mirrored.q.begin(), std::negate());
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
    Packing packing = without_walls::free_grains({1}, {0, 0, 0, 3, 2.5, 2, 0, 0, 0}, 3);
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

BOOST_AUTO_TEST_CASE(dead_wall_forces_use_the_reference_lengths) {
    const Packing packing = boxed();
    const Load load = two_stresses();
    const std::vector<double> force = load.external_force(packing);
    BOOST_REQUIRE(force.size() == 10U);
    BOOST_TEST(force[8] == -2 * 8); // the right wall is as long as the box is high
    BOOST_TEST(force[9] == -3 * 4);
    BOOST_TEST(std::ranges::count(force, 0.0) == 8);
}

BOOST_AUTO_TEST_CASE(true_stress_forces_use_the_current_lengths) {
    const Packing packing = boxed(); // 5 x 7
    Load load = two_stresses();
    load.kind = LoadKind::true_stress;
    const std::vector<double> force = load.external_force(packing);
    BOOST_TEST(force[8] == -2 * 7);
    BOOST_TEST(force[9] == -3 * 5);
}

BOOST_AUTO_TEST_CASE(force_is_affine_in_the_loaded_stress) {
    const Packing packing = boxed();
    for (const LoadKind kind : {LoadKind::nominal, LoadKind::true_stress}) {
        for (const int axis : {0, 1}) {
            Load load = two_stresses();
            load.kind = kind;
            load.loaded_axis = axis;
            load.disk_force = {1, 2, 3, 4, 5, 6, 7, 8};
            const auto total = load.external_force(packing);
            const auto fixed = load.fixed_force(packing);
            const auto unit = load.unit_force(packing);
            for (std::size_t k = 0; k < total.size(); ++k) {
                BOOST_TEST(total[k] == fixed[k] + load.stress[static_cast<std::size_t>(axis)] * unit[k]);
                BOOST_TEST((unit[k] != 0) == (k == 8U + static_cast<std::size_t>(axis)));
            }
            BOOST_TEST(total[5] == 6);
        }
    }
}

BOOST_AUTO_TEST_CASE(stresses_on_a_path_are_those_of_the_real_numbers) {
    std::mt19937_64 random(5);
    const auto number = [&random](int most) {
        return std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())),
                          static_cast<int>(random() % static_cast<unsigned>(2 * most)) - most - 63);
    };
    Load load;
    load.dimension = 3;
    for (int trial = 0; trial < 2000; ++trial) {
        load.path.reset();
        load.stress = {number(60), number(1), 1};
        load.follow({number(20), number(1), 2});
        BOOST_TEST_REQUIRE(load.path.has_value());
        load.set_loaded_stress(number(40));
        for (std::size_t a = 0; a < 3; ++a) {
            const ExactStress found = load.exact_stress(a);
            const mpq_class exact =
                mpq_class(load.path->at[a]) + mpq_class(load.path->rate[a]) * mpq_class(load.path->t);
            BOOST_TEST((mpq_class(found.nearest) + found.rest[0] + found.rest[1] == exact));
            BOOST_TEST(std::abs(found.rest[0]) <= 0x1p-53 * std::abs(found.nearest));
            BOOST_TEST(load.stress[a] == found.nearest);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_path_loads_several_walls_and_one_of_them_alone_is_a_loaded_axis) {
    Packing packing;
    packing.dimension = 3;
    packing.walls = Walls::box(3);
    packing.radius = {1};
    packing.q = {1, 1, 1, 2, 3, 5};
    Load load;
    load.dimension = 3;
    load.stress = {1, 1.5, 2};
    load.refer_to(packing);
    load.follow({-1, 0, 2});
    load.set_loaded_stress(0.25);
    const std::vector<double> force = load.external_force(packing);
    BOOST_TEST(std::vector<double>(force.begin() + 3, force.end()) == (std::vector<double>{-0.75 * 15, -15, -15}));
    const std::vector<double> unit = load.unit_force(packing);
    BOOST_TEST(std::vector<double>(unit.begin() + 3, unit.end()) == (std::vector<double>{15, 0, -12}));
    const DofMap dofs(packing);
    BOOST_TEST(load.changing_rows(packing, dofs) == (std::vector<int>{3, 5}));
    BOOST_TEST(load.loaded_rows(packing, dofs) == (std::vector<int>{3, 4, 5}));
    BOOST_TEST(load.stress_name() == "t");
    BOOST_TEST(load.ratio() == 0.25 / 1.5);
    BOOST_TEST(load.mean_stress() == 4.75 / 3);
    BOOST_TEST(load.deviator() == 2.5 - 2.25 / 2);
    load.follow({0, 1, 0});
    BOOST_TEST(!load.path);
    BOOST_TEST(load.loaded_axis == 1);
    BOOST_TEST(load.stress[0] == 0.75);
    const auto fault = [&](std::vector<double> rate) { return fault_of_path(packing, rate); };
    BOOST_TEST(fault({-1, -1, 2}) == "");
    BOOST_TEST(fault({0, 0, -1e-6}) == "");
    for (const auto& [rate, word] : {std::pair<std::vector<double>, const char*>{{0, 0, 0}, "all numbers are 0"},
                                     {{1, 0}, "2 numbers"},
                                     {{1, 0, 0, 0}, "4 numbers"},
                                     {{1, 1e-7, 0}, "1e-07"},
                                     {{1, std::numeric_limits<double>::infinity(), 0}, "inf"},
                                     {{1, 0, 0, 1, 0, 0}, "the tilt xy, which does not move"}}) {
        BOOST_TEST((fault(rate).find(word) != std::string::npos), fault(rate));
    }
    packing.walls.upper[1] = WallKind::fixed;
    BOOST_TEST(fault({0, 1, 0}) == "1 for the length along y, which does not move: expected 0");
    BOOST_TEST(fault_of_path(boxed(), std::vector<double>{1, 1}) ==
               "disks: expected spheres, or loaded = \"y\" or \"tilt\"");
}

BOOST_AUTO_TEST_CASE(walls_that_cannot_move_carry_no_load) {
    Packing packing = boxed();
    packing.walls.upper[0] = WallKind::fixed;
    BOOST_TEST(two_stresses().external_force(packing)[8] == 0);
}

BOOST_AUTO_TEST_CASE(potential_is_minus_the_work_of_dead_loads) {
    Packing packing = boxed();
    Load load = two_stresses();
    load.disk_force = {1, 0, 0, -2, 0, 0, 0, 0};
    const double before = potential(packing, load);
    packing.q[0] += 0.5;
    packing.q[3] += 0.25;
    packing.length(0) -= 0.125;
    packing.length(1) -= 1;
    // Work: 0.5 - 0.5 on the disks, 16/8 and 12 on the walls.
    BOOST_TEST(potential(packing, load) - before == -14.0);
}

BOOST_AUTO_TEST_CASE(infinitesimal_loads_are_reproducible_generic_and_off_the_walls_normals) {
    const std::vector<double> radius = {1, 2, 0.5, 1};
    const auto g = generic_infinitesimal(radius, 7);
    BOOST_TEST(g == generic_infinitesimal(radius, 7));
    BOOST_TEST(g != generic_infinitesimal(radius, 8));
    for (std::size_t i = 0; i < radius.size(); ++i) {
        const double weight = radius[i] * radius[i];
        BOOST_TEST(g[2 * i] != 0);
        BOOST_TEST(g[2 * i + 1] <= -0.7 * weight);
        BOOST_TEST(std::abs(g[2 * i]) <= 0.5 * weight);
    }
    BOOST_TEST(g[0] != g[6]); // equal disks, different loads
    // Lengths in another unit: the loads scale by the square of a power of two, bit for bit.
    const auto scaled = generic_infinitesimal({4, 8, 2, 4}, 7);
    for (std::size_t k = 0; k < g.size(); ++k) {
        BOOST_TEST(scaled[k] == 16 * g[k]);
    }
}

// Along periodic axes nothing is left for the pinned grain; along walls nothing is changed.
BOOST_AUTO_TEST_CASE(infinitesimal_loads_of_a_cell_sum_to_zero_exactly) {
    const std::vector<double> all = generic_infinitesimal({1, 2, 0.3, 1.7, 5}, 3);
    for (const std::array<bool, 2> periodic : {std::array{true, true}, {true, false}, {false, true}}) {
        Cell cell{.periodic = {periodic[0], periodic[1]}, .pin = 2};
        std::vector<double> g = all;
        balance(g, cell);
        for (std::size_t a = 0; a < 2; ++a) {
            double sum = 0;
            for (std::size_t k = a; k < g.size(); k += 2) {
                sum += g[k]; // exact on the common grid
                if (k / 2 != 2) {
                    BOOST_TEST(std::abs(g[k] - all[k]) <= (periodic[a] ? 1e-7 : 0));
                }
            }
            BOOST_TEST((sum == 0) == periodic[a]);
        }
    }
}
