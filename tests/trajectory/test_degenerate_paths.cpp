// Symmetric packings whose whole path is known: followed under `choose`, and with radii that are really changed by a
// little in several directions, whose limit it must be.
#include "support/course.hpp"
#include "support/mirror.hpp"
#include "support/mirror_cells.hpp"
#include "support/really_perturbed.hpp"
#include "support/segments.hpp"

using namespace isostat;
using namespace crafted;

namespace {

/// Lengths of the box at the ends of segments, each of which goes on from where the one before ended.
struct Loop {
    std::vector<Course> courses;
    [[nodiscard]] double length(std::size_t segment, int axis) const {
        return courses[segment].states.back().packing.length(axis);
    }
};
Loop follow_loads(State state, const std::vector<double>& loads, Ties ties) {
    Loop loop;
    double stress = state.load.stress[1];
    for (const double load : loads) {
        Course& course = loop.courses.emplace_back();
        RunOptions options;
        settle(options, ties);
        options.max_strain = 1e9; // reference lengths of 1
        course.outcome = run_segment(state, until(load > stress ? +1 : -1, load), 0, options, course.counters, course);
        stress = load;
        BOOST_TEST(course.outcome.completed, course.why());
        BOOST_TEST_REQUIRE(!course.states.empty());
    }
    return loop;
}

/// Apart so far, unit disks let disks of radius 3/2 between them down to the bottom.
const double spread = 2 * std::sqrt(6.0);

/// Pushed apart, and back again.
struct PileLoads {
    explicit PileLoads(int columns)
        : up(8.0 / 3 * (columns - 1)), down(0.4 * (columns - 1) * 2.5 / std::sqrt(6.0)),
          programme{up - 0.5, up + 1, (8.0 / 3 + down) / 2} {}
    double up;   ///< as `pile` says
    double down; ///< spread out, the row stands for F2 >= 0.4 (columns - 1) F1 / cos, cos = sqrt(6) / 2.5
    std::vector<double> programme;
};

void pile_is(const Loop& loop, int columns, double accuracy) {
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) { // as it began, and after the loop
        BOOST_TEST(std::abs(loop.length(k, 0) - (3 * columns - 1)) < accuracy);
        BOOST_TEST(std::abs(loop.length(k, 1) - 4.5) < accuracy);
    }
    BOOST_TEST(std::abs(loop.length(1, 0) - (2 + (columns - 1) * spread)) < accuracy);
    BOOST_TEST(std::abs(loop.length(1, 1) - 3) < accuracy);
}

/// The loads at which arcs of finite length begin.
std::vector<double> loads_of_motions(const Course& course) {
    std::vector<double> loads;
    for (const ArcRecord& arc : course.arcs) {
        if (arc.displacement > 1e-3 && (loads.empty() || loads.back() != arc.stress)) {
            loads.push_back(arc.stress);
        }
    }
    return loads;
}

/// Rows of a triangular lattice in the box, as `triangular` makes them. While rows stretch with the spacing a, the box
/// measures 2 + (columns - 1) a by 2 + (rows - 1) sqrt(4 - a^2 / 4): at a = 2 the work vanishes at this ratio of the
/// wall forces. Below, forces of one sign balance the load: the lattice stands.
double yield_of(const State& patch, int columns, int rows) {
    const double forces = 2 * std::sqrt(3.0) * (columns - 1) / (rows - 1);
    return forces * patch.load.reference_length[1] / patch.load.reference_length[0]; // of stresses, sigma1 = 1
}

/// Rows next to each other lie in line at a = 4, which brings the top wall of an even number of rows down to `rows`. Of
/// an odd number the rows next but one meet before, at a = 2 sqrt 3, and carry the top wall. From there on the former
/// stretch again at the second of these loads, if they have not met it yet: L1 by a, L2 by sqrt(4 - a^2 / 4).
struct LatticeEnd {
    LatticeEnd(int columns, int rows)
        : length(2 + (columns - 1) * (rows % 2 == 0 ? 4 : 2 * std::sqrt(3.0))),
          height(rows % 2 == 0 ? rows : rows + 1) {}
    double length, height;
};
double last_yield_of(const State& patch, int columns, int rows) {
    const double first = yield_of(patch, columns, rows);
    return rows % 2 == 0 ? std::max(first, first * (rows - 1) / 3) : first;
}

} // namespace

BOOST_AUTO_TEST_CASE(rows_on_a_wall_spread_at_the_known_load_and_come_back) {
    for (const int columns : {8, 9}) {
        const PileLoads loads(columns);
        const Loop loop = follow_loads(pile(columns, loads.up - 1), loads.programme, Ties::choose);
        pile_is(loop, columns, 1e-11);
        BOOST_TEST(loads_of_motions(loop.courses[0]).empty());
        for (const auto& [segment, load] : {std::pair{1, loads.up}, std::pair{2, loads.down}}) {
            const std::vector<double> found = loads_of_motions(loop.courses[static_cast<std::size_t>(segment)]);
            BOOST_TEST_REQUIRE(found.size() == 1U);
            BOOST_TEST(std::abs(found[0] - load) < 1e-11 * load);
        }
    }
}

/// Every basis of the contacts on the way up: one force of the row after the other reaches its limit, at one place.
BOOST_AUTO_TEST_CASE(rows_on_a_wall_change_their_lists_where_they_are_until_the_known_load) {
    for (const int columns : {4, 5, 6, 7}) {
        const PileLoads loads(columns);
        const Loop loop = follow_loads(pile(columns, 4), {loads.up + 1}, Ties::choose);
        const std::vector<double> found = loads_of_motions(loop.courses[0]);
        BOOST_TEST_REQUIRE(found.size() == 1U);
        BOOST_TEST(std::abs(found[0] - loads.up) < 1e-11 * loads.up);
        BOOST_TEST(std::abs(loop.length(0, 0) - (2 + (columns - 1) * spread)) < 1e-11);
        BOOST_TEST(std::abs(loop.length(0, 1) - 3) < 1e-11);
        BOOST_TEST(loop.courses[0].states.back().perturbation->open.size() == static_cast<std::size_t>(columns - 2));
    }
}

/// Radii that grow from disk to disk, in either direction: each of the gaps that close together may come first.
BOOST_AUTO_TEST_CASE(many_gaps_that_close_together_are_put_in_order_at_once) {
    constexpr int columns = 12;
    const PileLoads loads(columns);
    for (const double growth : {0x1p-8, -0x1p-8}) {
        State state = pile(columns, loads.up - 1);
        state.perturbation.emplace();
        state.perturbation->rho = tie_direction(state.packing.radius, 1);
        for (int i = columns; i < 2 * columns - 1; ++i) {
            state.perturbation->rho[static_cast<std::size_t>(i)] = growth * i;
        }
        pile_is(follow_loads(state, loads.programme, Ties::choose), columns, 1e-11);
    }
}

BOOST_AUTO_TEST_CASE(rows_with_radii_that_are_really_changed_go_the_same_way) {
    constexpr double eps = 1e-7;
    for (const int columns : {8, 9}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const PileLoads loads(columns);
            const State state = pile(columns, loads.up - 1);
            const State changed = really_perturbed(state, tie_direction(state.packing.radius, seed), eps);
            pile_is(follow_loads(changed, loads.programme, Ties::stop), columns, 200 * eps);
        }
    }
}

void moves_at_known_loads(const std::vector<double>& loads, const State& patch, int columns, int rows,
                          double accuracy) {
    const double first = yield_of(patch, columns, rows);
    const double last = last_yield_of(patch, columns, rows);
    BOOST_TEST_REQUIRE(!loads.empty());
    BOOST_TEST(std::abs(loads.front() / first - 1) < accuracy);
    BOOST_TEST(std::abs(loads.back() / last - 1) < accuracy);
    for (const double load : loads) {
        BOOST_TEST((std::abs(load / first - 1) < accuracy || std::abs(load / last - 1) < accuracy), load);
    }
}

/// 2 x 4, ..., 7 x 8: on a list that is kept to the end of the last motion contacts may be dependent there.
BOOST_AUTO_TEST_CASE(lattices_move_at_the_loads_at_which_their_rows_stretch_and_end_where_these_meet,
                     *boost::unit_test::label("slow")) {
    int lists = 0;
    for (const auto& [columns, rows] :
         {std::pair{2, 2}, std::pair{3, 2}, std::pair{4, 2}, std::pair{2, 3}, std::pair{3, 3}, std::pair{2, 4},
          std::pair{3, 4}, std::pair{4, 4}, std::pair{5, 5}, std::pair{3, 6}, std::pair{3, 8}, std::pair{7, 8}}) {
        BOOST_TEST_INFO_SCOPE(columns << " x " << rows);
        const State patch = triangular(columns, rows);
        const Course course = follow_load(patch, +1, 200, Ties::choose);
        BOOST_TEST(course.end() == "no limit", course.why());
        moves_at_known_loads(loads_of_motions(course), patch, columns, rows, 1e-11);
        const Packing& end = course.states.back().packing;
        BOOST_TEST(std::abs(end.length(0) - LatticeEnd(columns, rows).length) < 1e-11);
        BOOST_TEST(std::abs(end.length(1) - LatticeEnd(columns, rows).height) < 1e-11);
        lists += settled_as(course, "end") ? 1 : 0;
    }
    BOOST_TEST(lists > 2);
}

BOOST_AUTO_TEST_CASE(lattices_end_where_their_rows_meet_as_with_radii_that_are_really_changed,
                     *boost::unit_test::label("slow")) {
    constexpr double eps = 1e-8;
    for (const auto& [columns, rows] :
         {std::pair{3, 2}, std::pair{4, 2}, std::pair{2, 3}, std::pair{3, 4}, std::pair{4, 4}, std::pair{4, 5},
          std::pair{5, 5}, std::pair{5, 6}, std::pair{7, 8}}) {
        const State patch = triangular(columns, rows);
        const double above = last_yield_of(patch, columns, rows) + 1;
        for (std::uint64_t seed = 1; seed <= (columns < 7 ? 4U : 2U); ++seed) {
            BOOST_TEST_INFO_SCOPE(columns << " x " << rows << ", direction " << seed);
            const State changed = really_perturbed(patch, tie_direction(patch.packing.radius, seed), eps);
            const Loop real = follow_loads(changed, {above}, Ties::stop);
            moves_at_known_loads(loads_of_motions(real.courses[0]), patch, columns, rows, 100 * eps);
            // In line, lengths change by the square root of what the heights do.
            BOOST_TEST(std::abs(real.length(0, 0) - LatticeEnd(columns, rows).length) < 1e-3);
            BOOST_TEST(std::abs(real.length(0, 1) - LatticeEnd(columns, rows).height) < 1e-3);
        }
    }
}

/// Disks of diameter 1, two rows per period sqrt(4 - a^2): the work of stresses vanishes at a = 1 when their ratio
/// is 3. Rows next but one meet at a = sqrt 3.
BOOST_AUTO_TEST_CASE(lattices_in_cells_stretch_from_a_ratio_of_3_on_until_the_rows_next_but_one_meet,
                     *boost::unit_test::label("slow")) {
    for (const bool tilts : {false, true}) {
        for (const auto& [columns, rows] : {std::pair{2, 1}, std::pair{3, 1}, std::pair{3, 2}, std::pair{4, 2}}) {
            BOOST_TEST_INFO_SCOPE(columns << " x " << rows << (tilts ? ", tilts" : ""));
            State lattice = cells::loaded_lattice(columns, rows, tilts);
            lattice.load.reference_length = {lattice.packing.length(0), lattice.packing.length(1)};
            const Course course = follow_load(lattice, +1, 100, Ties::choose);
            BOOST_TEST(course.end() == "no limit", course.why());
            const std::vector<double> loads = loads_of_motions(course);
            BOOST_TEST_REQUIRE(!loads.empty());
            BOOST_TEST(std::abs(loads[0] - 3) < 1e-11);
            const Packing& end = course.states.back().packing;
            BOOST_TEST(std::abs(end.length(0) - columns * std::sqrt(3.0)) < 1e-11);
            BOOST_TEST(std::abs(end.length(1) - rows) < 1e-11);
        }
    }
}
