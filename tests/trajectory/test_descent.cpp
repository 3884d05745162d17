// The potential falls along every arc, and a run ends when somebody objects to an equilibrium.
#include "support/crafted.hpp"
#include "support/segments.hpp"
#include "trajectory/descent.hpp"

#include <isostat/io/state_file.hpp>

#include <boost/multiprecision/mpfr.hpp>

using namespace isostat;
using namespace ::crafted;

namespace {

using Wide = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<80>>;

std::unique_ptr<Vertex> vertex_of(const State& state) {
    static InverseBoundCache cache;
    return required(Vertex::make(state.packing, state.contacts, state.load, cache));
}

/// A disk in its corner under two walls, at rest: its true place is stored. The second one has other lengths.
State corner(double radius) {
    State state = one_disk(1, 1);
    state.packing.radius[0] = radius;
    state.packing.q = {radius, radius, 2 * radius, 2 * radius};
    return state;
}

struct Objector : Recorder {
    int at;
    explicit Objector(int number) : at(number) {}
    [[nodiscard]] std::optional<Failure> objection() const override {
        return static_cast<int>(equilibria.size()) > at
                   ? std::optional(Failure{FailureKind::contradiction, "somebody objects"})
                   : std::nullopt;
    }
};

} // namespace

BOOST_AUTO_TEST_CASE(the_decrease_of_the_potential_is_enclosed_for_dead_loads_and_true_stresses) {
    for (const double shrink : {0.5, 0x1p-20, 0x1p-46, -0x1p-30}) {
        const auto from = vertex_of(corner(1));
        const auto to = vertex_of(corner(1 - shrink));
        Load load = corner(1).load;
        load.stress = {0.75, 1.5};
        load.reference_length = {3, 0.1};
        const Enclosure dead = potential_decrease(*from, *to, load, false);
        const Wide force = Wide(0.75) * Wide(0.1) + Wide(1.5) * 3;
        BOOST_TEST(abs(Wide(dead.value) - force * 2 * Wide(shrink)) <= Wide(dead.radius));
        BOOST_TEST((shrink > 0 ? dead.positive() : dead.negative()));
        load.kind = LoadKind::true_stress;
        const Enclosure phi = potential_decrease(*from, *to, load, false);
        const Wide exact = -(Wide(0.75) + Wide(1.5)) * log(1 - Wide(shrink));
        BOOST_TEST(abs(Wide(phi.value) - exact) <= Wide(phi.radius), phi.value << " +- " << phi.radius);
        BOOST_TEST((shrink > 0 ? phi.positive() : phi.negative()));
    }
}

BOOST_AUTO_TEST_CASE(the_decrease_is_that_of_the_true_vertices_not_of_the_stored_ones) {
    // Stored 1e-9 off their places, which are known: decided at once, to what the vertices are known to.
    const auto off = [](double radius, double push) {
        State state = corner(radius);
        state.packing.q[2] += push; // the length of the box, which is what the load feels
        state.packing.q[3] += push;
        return state;
    };
    Load load = corner(1).load;
    load.stress = {0.75, 1.5};
    load.reference_length = {3, 0.1};
    for (const double push : {1e-9, -1e-9}) {
        const auto from = vertex_of(off(1, push));
        const auto to = vertex_of(off(0.5, -push));
        load.kind = LoadKind::nominal;
        const Enclosure dead = potential_decrease(*from, *to, load, false);
        BOOST_TEST(abs(Wide(dead.value) - (Wide(0.75) * Wide(0.1) + Wide(1.5) * 3)) <= Wide(dead.radius));
        BOOST_TEST(dead.radius < 1e-7);
        load.kind = LoadKind::true_stress;
        const Enclosure phi = potential_decrease(*from, *to, load, false);
        BOOST_TEST(abs(Wide(phi.value) - Wide(2.25) * log(Wide(2))) <= Wide(phi.radius));
        BOOST_TEST(phi.radius < 1e-7);
    }
}

BOOST_AUTO_TEST_CASE(a_length_that_may_be_zero_says_nothing_of_its_logarithm) {
    const auto from = vertex_of(corner(1));
    const auto to = vertex_of(corner(0.5));
    from->enclosure.radius = 1.8;  // of lengths of 2: 1.8 / 0.2 = 9
    to->enclosure.radius = 1.1266; // of lengths of 1: nothing, not 1.1266 / -0.1266 = -8.9
    Load load = corner(1).load;
    load.kind = LoadKind::true_stress;
    const Enclosure phi = potential_decrease(*from, *to, load, false);
    BOOST_TEST(phi.radius < 1e-9); // enclosed anew, in double-double
    BOOST_TEST(abs(Wide(phi.value) - 2 * log(Wide(2))) <= Wide(phi.radius));
}

BOOST_AUTO_TEST_CASE(nothing_is_claimed_where_nothing_moves_or_no_potential_exists) {
    const auto from = vertex_of(corner(1));
    Load load = corner(1).load;
    BOOST_TEST(!potential_decrease(*from, *from, load, false).decided());
    load.kind = LoadKind::true_stress;
    load.disk_force = {0, 1};
    BOOST_TEST(!has_potential(load, false));
    BOOST_TEST(has_potential(load, true)); // of rattlers
    load.kind = LoadKind::nominal;
    BOOST_TEST(has_potential(load, false));
}

BOOST_AUTO_TEST_CASE(walls_that_move_against_each_other_are_judged_by_the_sum_of_the_logarithms) {
    // sigma_1 ln L1 + sigma_2 ln L2 with L1 -> L1 (1 + t), L2 -> L2 (1 - t): the first order cancels.
    for (const double t : {0x1p-4, 0x1p-12, 0x1p-22, 0x1p-50}) { // t^2 = 2^-100: below double-double
        const auto box = [&](double lx, double ly) {
            State state = one_disk(1, 1);
            state.packing.radius = {0.25, 0.25};
            state.packing.q = {0.25, 0.25, lx - 0.25, ly - 0.25, lx, ly};
            state.load.infinitesimal.assign(4, 0.0);
            const double d = std::hypot(lx - 0.5, ly - 0.5);
            state.packing.radius[1] = 0.25;
            state.contacts = {
                left(0), bottom(0), right(1), top(1), {ContactKind::held, 2, 0}, {ContactKind::held, 3, 0}};
            BOOST_REQUIRE(d > 0.5);
            return state;
        };
        const auto from = vertex_of(box(1, 1));
        const auto to = vertex_of(box(1 + t, 1 - t));
        Load load = box(1, 1).load;
        load.kind = LoadKind::true_stress;
        load.stress = {1, 1};
        const Enclosure phi = potential_decrease(*from, *to, load, false);
        BOOST_TEST(phi.positive(), t << ": " << phi.value << " +- " << phi.radius);
        BOOST_TEST(abs(Wide(phi.value) + log(1 - Wide(t) * Wide(t))) <= Wide(phi.radius));
        // Dead loads that differ in the last bit: W changes by that times t, in either direction.
        load.kind = LoadKind::nominal;
        for (const bool falls : {true, false}) {
            load.reference_length = {falls ? 1 + 0x1p-52 : 1, falls ? 1 : 1 + 0x1p-52};
            const Enclosure dead = potential_decrease(*from, *to, load, false);
            BOOST_TEST((falls ? dead.positive() : dead.negative()), t << ": " << dead.value << " +- " << dead.radius);
            BOOST_TEST(abs(abs(Wide(dead.value)) - Wide(t) * Wide(0x1p-52)) <= Wide(dead.radius));
        }
    }
}

BOOST_AUTO_TEST_CASE(held_coordinates_compete_by_magnitude_on_every_rung) {
    // Two states whose forces differ by a factor 2^33: the multiplier of one is settled by double, of the other higher
    // up.
    std::vector<Contact> opened;
    for (const char* name : {"held_big.json", "held_small.json"}) {
        const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/contradictions/" + name).state;
        const Played played = play(state, +1, 1);
        BOOST_REQUIRE(!played.records.arcs.empty());
        opened.push_back(played.records.arcs[0].opened);
    }
    BOOST_TEST((opened[0] == opened[1]));
}

BOOST_AUTO_TEST_CASE(a_run_ends_with_the_objection_of_its_observer) {
    State state = two_disks(1, 2, 1, 1);
    Objector objector(0);
    RunCounters counters;
    const SegmentOutcome outcome = run_segment(state, towards(-5), 0, {}, counters, objector);
    fails(outcome.failure, FailureKind::contradiction);
    BOOST_TEST(objector.equilibria.size() == 1U);
}

BOOST_AUTO_TEST_CASE(an_equilibrium_at_another_load_keeps_the_smallest_gap_of_its_configuration) {
    const Played up = completed(play(two_disks(1, 2, 1, 1), +1, {}, 2));
    const Played down = completed(play(up.state, -1, {}, 1.5));
    const EquilibriumRecord& first = up.records.equilibria.front();
    for (const EquilibriumRecord& record : {up.records.equilibria.back(), down.records.equilibria.back()}) {
        BOOST_TEST(record.min_gap == first.min_gap);
        BOOST_TEST((record.min_gap_contact == first.min_gap_contact));
    }
    // Further apart than any list of candidates reaches.
    BOOST_TEST((first.min_gap_contact == left(1)));
    BOOST_TEST(std::abs(first.min_gap - (2 * std::sqrt(2.0) - 1)) <= 1e-14);
    const EquilibriumRecord alone = play(one_disk(1, 1), +1, 1).records.equilibria.front();
    BOOST_TEST(std::isinf(alone.min_gap));
    BOOST_TEST(alone.min_gap_contact.i == -1);
}
