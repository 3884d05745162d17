// Newton steps for soft disks, judged by the forces of the dynamics, which are other code.
// Sums of blocks: solved to rounding, refused when not positive.
#include "../../src/preparation/clique_matrix.hpp"
#include "../../src/preparation/soft_newton.hpp"
#include "check.hpp"
#include "support/threads.hpp"

using namespace isostat;

namespace {

using isostat::preparation::CliqueMatrix;

/// Springs along a ring of points: l joins points l and l + 1.
struct Ring {
    static constexpr std::size_t points = 50;
    std::vector<int> start{0};
    std::vector<int> column;
    Ring() {
        for (std::size_t l = 0; l < points; ++l) {
            column.push_back(static_cast<int>(l));
            column.push_back(static_cast<int>((l + 1) % points));
            start.push_back(static_cast<int>(column.size()));
        }
    }
    static double stiffness(std::size_t l) { return 1 + 0.5 * std::sin(static_cast<double>(l)); }
    static double block(std::size_t l, std::size_t p, std::size_t r) { return p == r ? stiffness(l) : -stiffness(l); }
};

/// Springs of a square grid with two displacements per point, and a grid of its own beside it: fronts of many sizes,
/// two trees.
struct Grids {
    static constexpr int side = 45;
    static constexpr int points = side * side;
    std::vector<int> start{0};
    std::vector<int> column;
    std::vector<double> value;
    Grids() {
        for (int grid = 0; grid < 2; ++grid) {
            for (int i = 0; i < side; ++i) {
                for (int j = 0; j < side; ++j) {
                    join(grid, i, j, i + 1, j);
                    join(grid, i, j, i, j + 1);
                    join(grid, i, j, i + 1, j + 1);
                }
            }
        }
    }
    void join(int grid, int i, int j, int k, int l) {
        if (k >= side || l >= side) {
            return;
        }
        const int a = 2 * (grid * points + i * side + j);
        const int b = 2 * (grid * points + k * side + l);
        const double angle = 0.1 * static_cast<double>(start.size());
        const double stiffness = std::exp(5 * std::sin(static_cast<double>(start.size())));
        for (const auto& [c, v] : {std::pair{a, std::cos(angle)},
                                   {a + 1, std::sin(angle)},
                                   {b, -std::cos(angle)},
                                   {b + 1, -std::sin(angle)}}) {
            column.push_back(c);
            value.push_back(std::sqrt(stiffness) * v);
        }
        start.push_back(static_cast<int>(column.size()));
    }
    [[nodiscard]] static std::size_t columns() { return 4 * static_cast<std::size_t>(points); }
    bool factorise(CliqueMatrix& matrix, const std::vector<double>& ground) const {
        return matrix.factorise([&](std::size_t, std::size_t p, std::size_t r) { return value[p] * value[r]; }, ground);
    }
    /// The matrix times x.
    [[nodiscard]] std::vector<double> times(const std::vector<double>& x, const std::vector<double>& ground) const {
        std::vector<double> b(x.size());
        for (std::size_t k = 0; k < x.size(); ++k) {
            b[k] = ground[k] * x[k];
        }
        for (std::size_t l = 0; l + 1 < start.size(); ++l) {
            double sum = 0;
            for (auto e = static_cast<std::size_t>(start[l]); e < static_cast<std::size_t>(start[l + 1]); ++e) {
                sum += value[e] * x[static_cast<std::size_t>(column[e])];
            }
            for (auto e = static_cast<std::size_t>(start[l]); e < static_cast<std::size_t>(start[l + 1]); ++e) {
                b[static_cast<std::size_t>(column[e])] += value[e] * sum;
            }
        }
        return b;
    }
};

std::vector<double> some_numbers(std::size_t count, double step) {
    std::vector<double> x(count);
    for (std::size_t k = 0; k < count; ++k) {
        x[k] = std::cos(step * static_cast<double>(k * k % 1009));
    }
    return x;
}

} // namespace

namespace room = isostat::preparation;

namespace {

/// Overlapping disks on a shaken lattice in a box a little too small for it.
Packing pressed(int side, double squeeze) {
    Packing packing;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            const int k = i * side + j;
            packing.radius.push_back(0.6 + 0.1 * std::sin(12.9898 * k));
            packing.q.push_back((1.4 * i + 0.75 + 0.1 * std::sin(78.233 * k)) * squeeze);
            packing.q.push_back((1.4 * j + 0.75 + 0.1 * std::cos(37.719 * k)) * squeeze);
        }
    }
    packing.q.push_back(1.4 * side * squeeze);
    packing.q.push_back(1.4 * side * squeeze);
    return packing;
}

/// What the dynamics say of a packing, which they leave as it is.
room::SoftMeasures judged(Packing packing, double pressure) {
    room::SoftDynamics dynamics(packing, false, nullptr, [](double) {});
    return dynamics.relax(pressure, 1e-12, 0);
}

} // namespace

BOOST_AUTO_TEST_CASE(newton_steps_end_where_the_dynamics_find_every_force_balanced) {
    for (const double squeeze : {0.9, 0.95}) {
        Packing packing = pressed(14, squeeze);
        room::SoftNewton newton(packing, nullptr);
        double volume = 0;
        for (const double pressure : {1e-3, 1e-4, 1e-5}) {
            const room::SoftMeasures before = judged(packing, pressure);
            BOOST_TEST(std::max(before.residual, before.pressure_error) > 0.5);
            const room::SoftMeasures made = newton.relax(pressure, 1e-6, 3000, [](double) {});
            BOOST_TEST(made.converged);
            BOOST_TEST(made.steps > 2);
            const room::SoftMeasures after = judged(packing, pressure);
            BOOST_TEST(after.residual < 2e-6);
            BOOST_TEST(after.pressure_error < 2e-6);
            BOOST_TEST(after.contacts == made.contacts);
            BOOST_TEST(after.overlap == made.overlap, boost::test_tools::tolerance(1e-6));
            BOOST_TEST(packing.length(0) * packing.length(1) > volume); // as the pressure falls
            volume = packing.length(0) * packing.length(1);
        }
    }
}

BOOST_AUTO_TEST_CASE(newton_steps_have_the_same_bits_for_any_number_of_threads_and_stop_when_asked,
                     *boost::unit_test::label("threads")) {
    const auto relaxed = [](int threads) {
        const Threads scope(threads);
        Packing packing = pressed(30, 0.9);
        room::SoftNewton newton(packing, nullptr);
        (void)newton.relax(1e-3, 1e-6, 20, [](double) {});
        return packing.q;
    };
    const auto one = relaxed(1);
    BOOST_TEST((one == relaxed(2)));
    BOOST_TEST((one != pressed(30, 0.9).q));
    std::atomic<bool> stop{true};
    Packing packing = pressed(10, 0.9);
    room::SoftNewton newton(packing, &stop);
    const room::SoftMeasures made = newton.relax(1e-3, 1e-6, 20, [](double) {});
    BOOST_TEST(made.interrupted);
    BOOST_TEST(made.steps == 0);
    BOOST_TEST((packing.q == pressed(10, 0.9).q));
}

BOOST_AUTO_TEST_CASE(sums_of_blocks_of_two_grids_are_solved_with_the_same_bits_every_time) {
    const Grids grids;
    const std::vector<double> ground(Grids::columns(), 1e-3);
    const std::vector<double> x = some_numbers(Grids::columns(), 0.7);
    const std::vector<double> b = grids.times(x, ground);
    std::vector<double> first;
    CliqueMatrix matrix(Grids::columns(), grids.start, grids.column);
    for (const bool again : {false, true}) {
        BOOST_TEST_INFO_SCOPE("again: " << again);
        BOOST_REQUIRE(grids.factorise(matrix, ground));
        std::vector<double> y = b;
        matrix.solve(y);
        double worst = 0;
        for (std::size_t k = 0; k < y.size(); ++k) {
            worst = std::max(worst, std::abs(y[k] - x[k]));
        }
        BOOST_TEST(worst < 1e-8); // condition number of order 1e6
        first = first.empty() ? y : first;
        BOOST_TEST(y == first);
    }
}

BOOST_AUTO_TEST_CASE(one_negative_pivot_anywhere_is_found_and_the_next_matrix_is_none_the_worse) {
    const Grids grids;
    CliqueMatrix matrix(Grids::columns(), grids.start, grids.column);
    const std::vector<double> good(Grids::columns(), 1e-3);
    for (std::size_t k = 0; k < Grids::columns(); k += 611) {
        std::vector<double> ground = good;
        ground[k] = -1e4;
        BOOST_TEST(!grids.factorise(matrix, ground));
    }
    BOOST_TEST(grids.factorise(matrix, good));
    const std::vector<double> x = some_numbers(Grids::columns(), 0.3);
    std::vector<double> y = grids.times(x, good);
    matrix.solve(y);
    for (std::size_t k = 0; k < y.size(); k += 101) {
        BOOST_TEST(std::abs(y[k] - x[k]) < 1e-8);
    }
}

BOOST_AUTO_TEST_CASE(a_sum_of_blocks_is_solved_again_and_again) {
    const Ring ring;
    CliqueMatrix matrix(Ring::points, ring.start, ring.column);
    for (const double ground : {1.0, 1e-3, 10.0}) {
        BOOST_REQUIRE(matrix.factorise(Ring::block, std::vector<double>(Ring::points, ground)));
        std::vector<double> x(Ring::points);
        for (std::size_t k = 0; k < x.size(); ++k) {
            x[k] = std::cos(static_cast<double>(k * k));
        }
        std::vector<double> b(Ring::points, 0.0);
        for (std::size_t k = 0; k < x.size(); ++k) {
            const std::size_t next = (k + 1) % x.size();
            b[k] += ground * x[k] + Ring::stiffness(k) * (x[k] - x[next]);
            b[next] += Ring::stiffness(k) * (x[next] - x[k]);
        }
        matrix.solve(b);
        for (std::size_t k = 0; k < x.size(); ++k) {
            BOOST_TEST(std::abs(b[k] - x[k]) < 1e-11);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_sum_of_blocks_that_is_not_positive_has_no_factor) {
    const Ring ring;
    CliqueMatrix matrix(Ring::points, ring.start, ring.column);
    BOOST_TEST(!matrix.factorise(Ring::block, std::vector<double>(Ring::points, -0.1)));
    BOOST_TEST(matrix.factorise(Ring::block, std::vector<double>(Ring::points, 0.1)));
}
