// Ties of forces and gaps, and what is next to them. Families that approach a tie: trajectory/test_families.cpp.
#include "support/families.hpp"

using namespace isostat;
using namespace ::crafted;
using families::stack;

BOOST_AUTO_TEST_CASE(an_exact_tie_of_two_tractions_is_named) {
    AtVertex tie(stack(2, 1, 0));
    fails(decide_opening(tie.statics, 1, OpeningRule::most_negative, {}, 0), FailureKind::tie, {"exactly equal"});
    BOOST_TEST((tie.statics.rung() == Rung::exact));
}

BOOST_AUTO_TEST_CASE(two_forces_that_vanish_together_have_a_structural_reason_where_nothing_pulls) {
    AtVertex same(stack(0, -1, 0.5)); // disk 0 carries the same above and below
    BOOST_TEST(required(find_limit(same.statics, 1, -1)).tie_class.size() == 2U);
    AtVertex parted(stack(1e-300, -1, 0.5));
    BOOST_TEST(required(find_limit(parted.statics, 1, -1)).tie_class.size() == 1U);
}

BOOST_AUTO_TEST_CASE(a_force_within_delta_of_zero_has_its_sign_and_an_exact_zero_is_a_tie) {
    for (const double sign : {1.0, -1.0}) {
        for (int decade = 1; decade <= 300; decade += decade < 30 ? 4 : 45) {
            const double delta = std::pow(10.0, -decade);
            AtVertex loaded(stack(0.5, -1, 0.5 - sign * delta)); // f(bottom 0) = 1 - up2 - up0
            const double rounded = 0.5 - sign * delta;
            if (rounded == 0.5) { // delta is lost in the load itself: it is added to another disk instead
                continue;
            }
            const auto decision = required(decide_opening(loaded.statics, 1, OpeningRule::most_negative, {}, 0));
            BOOST_TEST(decision.opening.has_value() == (sign < 0));
        }
    }
    AtVertex zero(stack(0.5, -1, 0.5));
    fails(decide_opening(zero.statics, 1, OpeningRule::most_negative, {}, 0), FailureKind::tie,
          {"exactly 0", "0-bottom"});
}

BOOST_AUTO_TEST_CASE(equal_by_symmetry_is_a_tie_however_the_coordinates_were_rounded) {
    // The notch of three disks: equal tractions at the true vertex. The stored one is rounded, and its own forces
    // differ in their last digits: what is asked is the true one.
    int misled = 0;
    for (int k = 1; k <= 12; ++k) {
        const double r = 0.1 * k + 0.03;
        const State state = three_disks(r, r, 0.1 * r, 1, -1);
        LadderOptions options{.max_bits = 1024};
        AtVertex stored(state, false, options);
        misled += decide_opening(stored.statics, -1, OpeningRule::most_negative, {}, 0).ok() ? 1 : 0;
        AtVertex truth(state, true, options);
        BOOST_TEST_INFO_SCOPE("radius " << r);
        fails(decide_opening(truth.statics, -1, OpeningRule::most_negative, {}, 0), FailureKind::tie, {"0-2", "1-2"});
    }
    BOOST_TEST(misled > 0); // otherwise this says nothing
}

BOOST_AUTO_TEST_CASE(rungs_at_the_true_vertex_agree_with_each_other) {
    // The enclosure of every rung contains the values of all higher ones.
    for (const double r : {0.3, 0.7, 1.1}) {
        const State state = two_disks(r, 2 * r, 1, 1.3);
        AtVertex at(state);
        ForceLadder ladder(state.packing, at.structure, at.factorisation, at.inverse, {}, &at.vertex);
        const int part = ladder.add(state.load.external_force(state.packing));
        std::vector<ForceSolution> seen;
        do {
            const ForceSolution& s = ladder.solution(part);
            for (const ForceSolution& before : seen) {
                for (std::size_t l = 0; l < s.value.size(); ++l) {
                    const double difference =
                        (s.value[l] - before.value[l]) +
                        ((s.low.empty() ? 0 : s.low[l]) - (before.low.empty() ? 0 : before.low[l]));
                    BOOST_TEST(std::abs(difference) <= (before.bound + s.bound) * (1 + 1e-10));
                }
            }
            seen.push_back(s);
        } while (ladder.climb());
        BOOST_TEST(seen.size() >= 4U);
        // Closed form: the force between the disks balances the wall, f = F1 / cos.
        const double cosine = 2 * std::sqrt(2.0) / 3;
        BOOST_TEST(std::abs(seen.back().value[2] - 1 / cosine) < 1e-14);
        BOOST_TEST(seen.back().bound < 1e-28);
    }
}

BOOST_AUTO_TEST_CASE(a_candidate_that_touches_at_the_vertex_is_told_from_one_that_does_not) {
    // Square of four unit disks with one bond left out: it touches, exactly.
    State square = square_lattice(2);
    std::erase(square.contacts, pair(2, 3));
    std::erase(square.contacts, pair(1, 3));
    const auto count = [&](const State& s) { return static_cast<int>(s.contacts.size()); };
    BOOST_TEST_REQUIRE(count(square) == 10);
    AtVertex at(square);
    const auto sign = [](const AtVertex& v, const Contact& c) {
        return gap_signs_at_vertex(v.state.packing, v.structure, v.factorisation, v.inverse, {c})[0];
    };
    const Order touches = sign(at, pair(2, 3));
    BOOST_TEST((touches.decided && touches.sign == 0 && touches.rung == Rung::exact));
    const Order open = sign(at, pair(0, 3));
    BOOST_TEST((open.decided && open.sign == 1));
    // The same with radii that no double coordinates can make touch: 0 to as many bits as were tried, never a sign.
    State rounded = square;
    for (double& x : rounded.packing.q) {
        x *= 0.3;
    }
    for (double& r : rounded.packing.radius) {
        r *= 0.3;
    }
    AtVertex near(rounded);
    const Order same = sign(near, pair(2, 3));
    BOOST_TEST((!same.decided || same.sign == 0));
    // A radius one ulp smaller: open, although double precision cannot see it.
    State smaller = square;
    smaller.packing.radius[3] = std::nextafter(1.0, 0.0);
    AtVertex off(smaller);
    const Order gap_there = sign(off, pair(2, 3));
    BOOST_TEST((gap_there.decided && gap_there.sign == 1), "rung " << to_string(gap_there.rung));
    smaller.packing.radius[3] = std::nextafter(1.0, 2.0);
    AtVertex over(smaller);
    const Order overlap = sign(over, pair(2, 3));
    BOOST_TEST((overlap.decided && overlap.sign == -1));
}
