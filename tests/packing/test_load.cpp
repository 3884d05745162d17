#include "oracle/packings.hpp"
#include "support/test.hpp"

#include <isostat/packing/load.hpp>

#include <gmpxx.h>

using namespace isostat;
using namespace isostat::oracle;

namespace {

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

BOOST_AUTO_TEST_CASE(dead_wall_forces_use_the_reference_lengths) {
    const Packing packing = boxed();
    const Load load = two_stresses();
    const std::vector<double> force = load.external_force(packing);
    BOOST_REQUIRE(force.size() == 10U);
    BOOST_TEST(force[8] == -2 * 8); // the right wall is as long as the box is high
    BOOST_TEST(force[9] == -3 * 4);
    BOOST_TEST(std::count(force.begin(), force.end(), 0.0) == 8);
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
