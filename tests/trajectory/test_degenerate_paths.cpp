// Symmetric packings whose whole path is known: followed under `choose`, and with radii that are really changed by a
// little in several directions, whose limit it must be.
#include "support/course.hpp"
#include "support/mirror.hpp"
#include "support/really_perturbed.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <tuple>

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
Loop follow_loads(State<2> state, const std::vector<double>& loads, TiePolicy ties) {
    Loop loop;
    double stress = state.load.stress[1];
    for (const double load : loads) {
        Course& course = loop.courses.emplace_back();
        CourseRecorder recorder(course);
        Segment segment;
        segment.direction = load > stress ? +1 : -1;
        segment.to_stress = load;
        stress = load;
        RunOptions options;
        options.ties = ties;
        options.max_strain = 1e9; // reference lengths of 1
        course.outcome = run_segment<2>(state, segment, 0, options, course.counters, recorder);
        BOOST_TEST(course.outcome.completed,
                   (course.outcome.failure ? course.outcome.failure->message() : std::string()));
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
    for (const ArcRecord<2>& arc : course.arcs) {
        if (arc.displacement > 1e-3 && (loads.empty() || loads.back() != arc.stress)) {
            loads.push_back(arc.stress);
        }
    }
    return loads;
}

/// Rows of a triangular lattice in the box, as `triangular` makes them. While rows stretch with the spacing a, the box
/// measures 2 + (columns - 1) a by 2 + (rows - 1) sqrt(4 - a^2 / 4): at a = 2 the work vanishes at this ratio of the
/// wall forces. Below, forces of one sign balance the load: the lattice stands.
double yield_of(const State<2>& patch, int columns, int rows) {
    const double forces = 2 * std::sqrt(3.0) * (columns - 1) / (rows - 1);
    return forces * patch.load.reference_length[1] / patch.load.reference_length[0]; // of stresses, sigma1 = 1
}

} // namespace

BOOST_AUTO_TEST_SUITE(trajectory)

BOOST_AUTO_TEST_CASE(rows_on_a_wall_spread_at_the_known_load_and_come_back) {
    for (const int columns : {8, 9}) {
        const PileLoads loads(columns);
        const Loop loop = follow_loads(pile(columns, loads.up - 1), loads.programme, TiePolicy::choose);
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
        const Loop loop = follow_loads(pile(columns, 4), {loads.up + 1}, TiePolicy::choose);
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
        State<2> state = pile(columns, loads.up - 1);
        state.perturbation.emplace();
        state.perturbation->rho = tie_direction(state.packing.radius, 1);
        for (int i = columns; i < 2 * columns - 1; ++i) {
            state.perturbation->rho[static_cast<std::size_t>(i)] = growth * i;
        }
        pile_is(follow_loads(state, loads.programme, TiePolicy::choose), columns, 1e-11);
    }
}

BOOST_AUTO_TEST_CASE(rows_with_radii_that_are_really_changed_go_the_same_way) {
    constexpr double eps = 1e-7;
    for (const int columns : {8, 9}) {
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const PileLoads loads(columns);
            const State<2> state = pile(columns, loads.up - 1);
            const State<2> changed = really_perturbed(state, tie_direction(state.packing.radius, seed), eps);
            pile_is(follow_loads(changed, loads.programme, TiePolicy::stop), columns, 200 * eps);
        }
    }
}

BOOST_AUTO_TEST_CASE(no_lattice_moves_below_the_load_at_which_its_rows_stretch) {
    int moved = 0;
    for (const auto& [columns, rows] : {std::pair{2, 2}, std::pair{3, 2}, std::pair{4, 2}, std::pair{2, 3},
                                        std::pair{3, 3}, std::pair{4, 4}, std::pair{7, 8}}) {
        const State<2> patch = triangular(columns, rows);
        const double yield = yield_of(patch, columns, rows);
        const Course course = follow_load(patch, +1, columns < 7 ? 12 : 60, TiePolicy::choose);
        const std::vector<double> loads = loads_of_motions(course);
        if (!loads.empty()) {
            ++moved;
            BOOST_TEST(std::abs(loads[0] - yield) < 1e-11 * yield, columns << " x " << rows);
        }
        BOOST_TEST((course.end() == "no limit" || columns == 7), columns << " x " << rows << ": " << course.end());
    }
    BOOST_TEST(moved == 7);
}

BOOST_AUTO_TEST_CASE(small_lattices_end_where_their_rows_meet_as_with_radii_that_are_really_changed) {
    constexpr double eps = 1e-8;
    // Two rows stretch until they lie in line; three until the rows next but one meet, at a = 2 sqrt 3.
    for (const auto& [columns, rows, length, height] :
         {std::tuple{3, 2, 10.0, 2.0}, std::tuple{4, 2, 14.0, 2.0}, std::tuple{2, 3, 2 + 2 * std::sqrt(3.0), 4.0}}) {
        const State<2> patch = triangular(columns, rows);
        const double above = yield_of(patch, columns, rows) + 1;
        const Loop loop = follow_loads(patch, {above}, TiePolicy::choose);
        BOOST_TEST(std::abs(loop.length(0, 0) - length) < 1e-11);
        BOOST_TEST(std::abs(loop.length(0, 1) - height) < 1e-11);
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const State<2> changed = really_perturbed(patch, tie_direction(patch.packing.radius, seed), eps);
            const Loop real = follow_loads(changed, {above}, TiePolicy::stop);
            // In line, lengths change by the square root of what the heights do.
            BOOST_TEST(std::abs(real.length(0, 0) - length) < 1e-6);
            BOOST_TEST(std::abs(real.length(0, 1) - height) < 1e-3);
        }
    }
}

BOOST_AUTO_TEST_SUITE_END()
