// Tubes, gaps and power along a curve that is known: a disk that rolls on a fixed one.
#include "checker/courses.hpp"
#include "checker/index.hpp"
#include "checker/tube.hpp"
#include "checker/way.hpp"
#include "support/channel_roll.hpp"
#include "support/crafted.hpp"
#include "support/spheres.hpp"

using namespace isostat;
using namespace checker;

namespace {

/// Disk 0 (radius 1) at an angle above the fixed disk 1 (radius 1, at 10, 10), and disk 2 fixed somewhere.
Moving rolling(double angle, double x, double y) {
    Moving moving;
    moving.state = crafted::in_box({{1, 10 + 2 * std::cos(angle), 10 + 2 * std::sin(angle)}, {1, 10, 10}, {0.5, x, y}},
                                   30, 30, 1, 1, {});
    moving.state.packing.walls = Walls::none();
    moving.state.packing.fixed = {0, 1, 1};
    moving.kept = {crafted::pair(0, 1)};
    moving.coordinates = {0, 1};
    moving.moves.assign(8, false);
    moving.moves[0] = moving.moves[1] = true;
    moving.loose.assign(8, false);
    return moving;
}

/// Disk 0 on disk 1 as above, from where it leaves the small fixed disk 2 to where it meets disk 3, in the sense of
/// growing angles, under a force on it. Disk 4 rests on two others all the time; where it is stored at the stop may be
/// off by `off`. `aside`: by how much disk 2 is behind the start.
struct Rolled {
    Place from, to;
    std::array<double, 2> force;
    double start, stop, aside;

    Rolled(double begin, double end, std::array<double, 2> f, double off = 0, double behind = 0.02)
        : force(f), start(begin), stop(end), aside(behind) {
        make(from, start, 2, 0);
        make(to, stop, 3, off);
    }
    [[nodiscard]] Objections prove() const {
        const Witness witness{std::vector<int>{0}, {}, {to.state->packing.q[0], to.state->packing.q[1]}};
        return prove_way(from, to, {1, +1, false, false, from.stress(), witness});
    }
    /// The end of the arc with the numbers that are true of it.
    [[nodiscard]] Objections check(bool rattles = false) const {
        EventRecord event;
        event.opened = "0-2";
        event.closed = "0-3";
        event.strain = 1; // no walls, no length
        event.power_bound = event.work_bound = 1e-12;
        const Range power = to.evidence->forces[1];
        event.power = Rational((power.lower + power.upper) / 2).get_d();
        for (std::size_t k = 0; k < 2; ++k) {
            event.work += force[k] * (to.state->packing.q[k] - from.state->packing.q[k]);
        }
        return check_end(from, to, event, rattles);
    }

  private:
    void make(Place& place, double angle, int other, double off) const {
        State state = rolling(angle, 0, 0).state;
        Packing& packing = state.packing;
        packing.radius = {1, 1, 0.05, 0.05, 1, 2, 2};
        packing.fixed = {0, 1, 1, 1, 0, 1, 1};
        packing.q.resize(4);
        // The small disks stand a little outside of the way, behind the start and ahead of the stop.
        for (const double at : {-aside, 0.02}) {
            const double side = std::sin(at);
            const double distance = 2 * std::cos(at) + std::sqrt(1.05 * 1.05 - 4 * side * side);
            const double where = at + (at < 0 ? start : stop);
            packing.q.insert(packing.q.end(), {10 + distance * std::cos(where), 10 + distance * std::sin(where)});
        }
        packing.q.insert(packing.q.end(), {10, 22 + off, 7.6, 20.2, 12.4, 20.2, 0, 0});
        state.load.disk_force = {force[0], force[1], 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0};
        state.load.infinitesimal = state.load.disk_force;
        state.contacts = {crafted::pair(0, 1), crafted::pair(0, other), crafted::pair(4, 5), crafted::pair(4, 6)};
        const Objections objection = make_place(state, place);
        BOOST_REQUIRE_MESSAGE(!objection, (objection ? objection->text : ""));
    }
};

} // namespace

BOOST_AUTO_TEST_CASE(bounds_hold_the_exact_results_of_random_operations) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-3, 3);
    for (int k = 0; k < 2000; ++k) {
        const double a = number(random);
        const double b = number(random);
        const double c = number(random);
        const Bounds found = Bounds(a) * b - Bounds(c) * c + Bounds(a) * 3.0;
        const Rational exact = Rational(a) * Rational(b) - Rational(c) * Rational(c) + 3 * Rational(a);
        BOOST_TEST((Rational(found.lower) <= exact && exact <= Rational(found.upper)));
    }
    BOOST_TEST(!(Bounds(1e308) * 1e308).negative());
    BOOST_TEST(std::isinf((Bounds(0, std::numeric_limits<double>::infinity()) * Bounds(-1, 0)).size()));
}

BOOST_AUTO_TEST_CASE(a_tube_holds_the_circle_on_which_a_disk_rolls) {
    for (const double angle : {0.3, 1.2, 2.0, 4.0}) {
        const Moving moving = rolling(angle, 25, 25);
        const bool x_is_fast = std::abs(std::sin(angle)) > std::abs(std::cos(angle));
        for (const int direction : {1, -1}) {
            auto tube = Tube::make(moving, moving.state.packing.q, x_is_fast ? 0 : 1, direction);
            BOOST_REQUIRE(tube);
            BOOST_REQUIRE(tube->prove());
            BOOST_TEST(tube->reach() > 0.05);
            BOOST_TEST(tube->radius() < 1e-12);
            for (double s = -tube->reach(); s < tube->reach(); s += tube->reach() / 16) {
                double error = 0;
                const std::vector<double> p = tube->point(s, error);
                // The point of the circle with the same coordinate in the row.
                const std::size_t row = x_is_fast ? 0 : 1;
                const std::size_t other = 1 - row;
                const double off = p[row] - 10;
                const double side = tube->centre()[other] > 10 ? 1 : -1;
                const double exact = 10 + side * std::sqrt(4 - off * off);
                BOOST_TEST(std::abs(exact - p[other]) <= tube->radius() + error + 1e-14);
                const double slope = -side * off / std::sqrt(4 - off * off) * direction;
                const Bounds found = tube->slope(static_cast<int>(other), s);
                BOOST_TEST((found.lower - 1e-14 <= slope && slope <= found.upper + 1e-14));
            }
        }
    }
}

// On the way from 1.2 to 1.2 + reach, disk 2 stands on the circle of radius 2 + 1/2 +- d around the way: touched or
// not.
BOOST_AUTO_TEST_CASE(a_gap_that_closes_on_the_way_is_seen_and_one_that_does_not_is_proved) {
    const double start = 1.2;
    const double there = 1.19; // disk 0 passes below disk 2 at this angle
    for (const double off : {-1e-3, -1e-6, -1e-9, 1e-9, 1e-6, 1e-3}) {
        const double distance = 2 + 1.5 + off;
        const Moving moving = rolling(start, 10 + distance * std::cos(there), 10 + distance * std::sin(there));
        auto tube = Tube::make(moving, moving.state.packing.q, 0, 1);
        BOOST_REQUIRE(tube);
        BOOST_REQUIRE(tube->prove());
        const double end = 2 * std::cos(there - 0.01) - 2 * std::cos(start);
        BOOST_REQUIRE(end < tube->reach());
        GapCourses gaps(moving, {crafted::pair(0, 1)}, {ContactKind::held, 0, 0});
        BOOST_TEST(gaps.look(*tube, 0, end) == (off > 0), off);
    }
}

BOOST_AUTO_TEST_CASE(the_power_is_positive_until_the_load_stands_on_the_curve) {
    const double start = 0.6;
    const Moving moving = rolling(start, 25, 25);
    Pushing load;
    load.fixed.assign(8, Bounds(0));
    const double turn = 0.58; // the load points away from disk 1 at this angle
    load.fixed[0] = std::cos(turn);
    load.fixed[1] = std::sin(turn);
    auto tube = Tube::make(moving, moving.state.packing.q, 1, -1);
    BOOST_REQUIRE(tube);
    BOOST_REQUIRE(tube->prove());
    const double s = 2 * (std::sin(start) - std::sin(turn));
    BOOST_REQUIRE(s * 1.01 < tube->reach());
    BOOST_TEST(power_is_positive(load, moving, *tube, 0, s * 0.999));
    BOOST_TEST(!power_is_positive(load, moving, *tube, 0, s * 1.001));
}

/// A small sphere in a corner and a large one between the walls of y: it rises from the floor as the angle above it
/// grows, about the corner of radius sqrt 8 in x and z. V Phi' = sum of sigma_a L_b L_c L_a' vanishes at one angle.
BOOST_AUTO_TEST_CASE(the_power_of_true_stresses_on_spheres_is_positive_from_where_it_turns) {
    Moving moving;
    moving.state = isostat::test::state_of_spheres(isostat::test::read_spheres("closed_two"));
    const Contact floor{ContactKind::lower_wall, 1, 2};
    std::ranges::copy_if(moving.state.contacts, std::back_inserter(moving.kept),
                         [&](const Contact& c) { return c != floor; });
    moving.coordinates = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    moving.moves.assign(9, true);
    moving.loose.assign(9, false);
    const double start = 0.58, turn = 0.6;
    const double radius = std::sqrt(8.0);
    std::vector<double>& q = moving.state.packing.q;
    q[3] = 1 + radius * std::cos(start);
    q[5] = 1 + radius * std::sin(start);
    q[6] = q[3] + 2;
    q[8] = q[5] + 2;
    const auto push = [&](double x) { return (3 + radius * x) * x; };
    Pushing load;
    load.fixed.assign(9, Bounds(0));
    load.pressure = {1, 1, push(std::sin(turn)) / push(std::cos(turn))};
    auto tube = Tube::make(moving, q, 5, 1);
    BOOST_REQUIRE(tube);
    BOOST_REQUIRE(tube->prove());
    const double s = radius * (std::sin(turn) - std::sin(start));
    BOOST_REQUIRE(s * 1.5 < tube->reach());
    BOOST_TEST(power_is_positive(load, moving, *tube, s * 1.001, s * 1.5));
    BOOST_TEST(!power_is_positive(load, moving, *tube, s * 0.999, s * 1.5));
}

BOOST_AUTO_TEST_CASE(a_way_against_the_load_is_not_proved) {
    for (const double turn : {0.0, 0.5, -0.5}) {
        const double middle = 0.6 + turn;
        const std::array<double, 2> along{-std::sin(middle), std::cos(middle)};
        const Objections with = Rolled(0.3, 0.9, along).prove();
        BOOST_TEST(!with.has_value(), (with ? with->text : ""));
        const auto against = required(Rolled(0.3, 0.9, {-along[0], -along[1]}).prove());
        BOOST_TEST(!against.wrong);
        BOOST_TEST(against.text.find("the power of the load is not proved positive") != std::string::npos);
    }
    // The load pushes along at both ends of most of the way, not all of it: at 0.9 it stands against it.
    const std::array<double, 2> turns{-std::sin(-0.7), std::cos(-0.7)};
    BOOST_TEST(!Rolled(0.3, 0.86, turns).prove().has_value());
    BOOST_TEST(Rolled(0.3, 0.88, turns).prove().has_value());
}

BOOST_AUTO_TEST_CASE(grains_at_rest_must_be_at_one_place_at_both_ends) {
    // Near the start the matrix is regular within some 1e-5 only, and disk 4 is stored as far off, or not.
    const std::array<double, 2> along{-std::sin(0.6), std::cos(0.6)};
    const Objections same = Rolled(0.3, 0.9, along, 0, 1e-4).prove();
    BOOST_TEST(!same.has_value(), (same ? same->text : ""));
    const auto off = required(Rolled(0.3, 0.9, along, 1e-4, 1e-4).prove());
    BOOST_TEST(off.text.find("grains at rest are not proved to be at the same place") != std::string::npos, off.text);
}

BOOST_AUTO_TEST_CASE(an_arc_that_ends_higher_than_it_began_is_refuted) {
    // All the way round: down the left, up on the right, over the top. At both ends the force pushes forward.
    constexpr double degree = std::numbers::pi / 180;
    const std::array<double, 2> gravity{0, -1};
    for (const bool rattles : {false, true}) { // the infinitesimal loads, which are the same, decide then
        const Objections down = Rolled(100 * degree, 200 * degree, gravity).check(rattles);
        BOOST_TEST(!down.has_value(), (down ? down->text : ""));
        const auto up = required(Rolled(100 * degree, 455 * degree, gravity).check(rattles));
        BOOST_TEST(up.wrong);
        BOOST_TEST(up.text.find("the potential does not decrease") != std::string::npos, up.text);
    }
}

BOOST_AUTO_TEST_CASE(a_way_in_a_channel_is_proved_unless_a_pair_of_images_meets_on_it) {
    for (const int shift : {0, 1, -2}) {
        for (const double clearance : {1e-2, 1e-5, 1e-8, -1e-2, -1e-5, -1e-8}) {
            BOOST_TEST_INFO_SCOPE("disk 1 stored " << shift << " periods away, clearance " << clearance);
            const cells::ChannelRoll roll{clearance, shift};
            Place from, to;
            (void)make_place(roll.start(), from); // of its forces nothing is asked
            (void)make_place(roll.end(), to);
            BOOST_TEST_REQUIRE((from.evidence->vertex.found && to.evidence->vertex.found));
            Witness witness;
            for (int k = 0; k < from.evidence->problem.dofs(); ++k) {
                const auto coordinate = static_cast<std::size_t>(from.evidence->problem.coordinate_of[at(k)]);
                witness.end.push_back(to.state->packing.q[coordinate]);
            }
            const Objections objection =
                prove_way(from, to, {cells::ChannelRoll::slot, +1, false, false, from.stress(), witness});
            const std::string said = objection ? objection->text : "";
            if (clearance > 0) {
                BOOST_TEST(said == "");
            } else {
                BOOST_TEST(said.find("the gap of " + to_string(roll.passing())) != std::string::npos, said);
            }
        }
    }
}
