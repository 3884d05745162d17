// Families that approach a tie: the right answer on either side, the rung that gives it, and a proved tie at 0.
#include "statics/decisions.hpp"
#include "support/crafted.hpp"
#include "support/loaded.hpp"

using namespace isostat;
using namespace crafted;

namespace {

/// Unit disks 0 and 1 on the bottom side by side between the side walls, 2 on top of 0 under the top wall: all
/// coordinates are integers, so the stored configuration is the true vertex. Forces in y on the disks as given.
State stack(double up0, double up1, double up2) {
    State state = in_box({{1, 1, 1}, {1, 3, 1}, {1, 1, 3}}, 4, 4, 1, 1,
                         {left(0), bottom(0), left(2), pair(0, 2), pair(0, 1), bottom(1), right(1), top(2)});
    state.load.disk_force = {0, up0, 0, up1, 0, up2};
    return state;
}

/// The reason reason there is no answer, for messages.
template <class T> std::string reason(const Result<T>& result) {
    return result.ok() ? "answered" : result.failure().message();
}

Rung expected_rung(double delta) {
    return delta > 1e-12 ? Rung::double_bound : delta > 1e-25 ? Rung::double_double : Rung::multiprecision;
}

} // namespace

BOOST_AUTO_TEST_SUITE(statics)

BOOST_AUTO_TEST_CASE(two_tractions_within_delta_are_ordered_down_to_1e_300_and_tie_at_0) {
    // f(bottom 0) = sigma - up2 - up0 = -1 - delta, f(bottom 1) = -up1 = -1.
    for (const double sign : {1.0, -1.0}) {
        for (int decade = 1; decade <= 300; decade += decade < 30 ? 1 : 30) {
            const double delta = std::pow(10.0, -decade);
            AtVertex loaded(stack(2, 1, sign * delta));
            const auto decision = decide_opening(loaded.statics, 1, OpeningRule::most_negative, {}, 0);
            BOOST_TEST_REQUIRE(decision.ok(), "delta = 1e-" << decade << ": " << reason(decision));
            BOOST_TEST_REQUIRE(decision.value().opening.has_value());
            const Opening& opening = *decision.value().opening;
            BOOST_TEST((loaded.contact(opening.contact) == (sign > 0 ? bottom(0) : bottom(1))),
                       "delta = 1e-" << decade);
            BOOST_TEST(opening.margin > 1);
            if (decade < 11 || decade > 33) { // not at the seams
                BOOST_TEST((opening.rung == expected_rung(delta)),
                           "delta = 1e-" << decade << ": " << to_string(opening.rung));
            }
        }
    }
    AtVertex tie(stack(2, 1, 0));
    const auto decision = decide_opening(tie.statics, 1, OpeningRule::most_negative, {}, 0);
    BOOST_TEST_REQUIRE(!decision.ok());
    BOOST_TEST((decision.failure().kind == FailureKind::tie));
    BOOST_TEST(decision.failure().message().find("exactly equal") != std::string::npos, reason(decision));
    BOOST_TEST((tie.statics.rung() == Rung::exact));
}

BOOST_AUTO_TEST_CASE(two_forces_that_vanish_within_delta_are_ordered_and_an_exact_tie_is_named) {
    // Downwards: f(0-2) = sigma - 1/2 vanishes at 1/2, f(bottom 0) = sigma - 1/2 - up0 at 1/2 + up0.
    for (const double sign : {1.0, -1.0}) {
        for (const int decade : {1, 3, 6, 9, 13, 17, 25, 40, 80, 150, 300}) {
            const double delta = std::pow(10.0, -decade);
            AtVertex loaded(stack(sign * delta, -1, 0.5));
            const auto limit = find_limit(loaded.statics, 1, -1);
            BOOST_TEST_REQUIRE(limit.ok(), "delta = 1e-" << decade << ": " << reason(limit));
            BOOST_TEST((loaded.contact(limit.value().opens) == (sign > 0 ? bottom(0) : pair(0, 2))),
                       "delta = 1e-" << decade << " opens " << to_string(loaded.contact(limit.value().opens)));
            BOOST_TEST(limit.value().tie_class.size() == 1U);
        }
    }
    // Two loads in y on disk 0 and none from below: the same load of 1/2 on another stack is no structural reason.
    AtVertex tie(stack(-0.25, -1, 0.75));
    AtVertex same(stack(0, -1, 0.5));
    const auto structural = required(find_limit(same.statics, 1, -1));
    BOOST_TEST(structural.tie_class.size() == 2U); // nothing pulls at disk 0: both carry the same
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
            const auto decision = decide_opening(loaded.statics, 1, OpeningRule::most_negative, {}, 0);
            BOOST_TEST_REQUIRE(decision.ok(), reason(decision));
            BOOST_TEST(decision.value().opening.has_value() == (sign < 0));
        }
    }
    AtVertex zero(stack(0.5, -1, 0.5));
    const auto decision = decide_opening(zero.statics, 1, OpeningRule::most_negative, {}, 0);
    BOOST_TEST_REQUIRE(!decision.ok());
    BOOST_TEST((decision.failure().kind == FailureKind::tie));
    BOOST_TEST(decision.failure().message().find("exactly 0") != std::string::npos, reason(decision));
    BOOST_TEST(decision.failure().message().find("0-bottom") != std::string::npos, reason(decision));
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
        const auto decision = decide_opening(truth.statics, -1, OpeningRule::most_negative, {}, 0);
        BOOST_TEST_REQUIRE(!decision.ok(), "radius " << r);
        BOOST_TEST((decision.failure().kind == FailureKind::tie), reason(decision));
        BOOST_TEST(decision.failure().message().find("0-2") != std::string::npos, reason(decision));
        BOOST_TEST(decision.failure().message().find("1-2") != std::string::npos, reason(decision));
    }
    BOOST_TEST(misled > 0); // otherwise this says nothing
}

BOOST_AUTO_TEST_CASE(unequal_radii_are_ordered_as_long_as_they_differ_at_all) {
    for (int bits = 1; bits <= 51; bits += 2) {
        const double larger = 1 + std::ldexp(1.0, -bits);
        AtVertex right(three_disks(1, larger, 0.1, 1, -1));
        AtVertex left(three_disks(larger, 1, 0.1, 1, -1));
        const auto a = decide_opening(right.statics, -1, OpeningRule::most_negative, {}, 0);
        const auto b = decide_opening(left.statics, -1, OpeningRule::most_negative, {}, 0);
        BOOST_TEST_REQUIRE(a.ok(), "2^-" << bits << ": " << reason(a));
        BOOST_TEST_REQUIRE(b.ok(), "2^-" << bits << ": " << reason(b));
        const Contact opened = right.contact(a.value().opening->contact);
        const Contact mirrored = left.contact(b.value().opening->contact);
        BOOST_TEST(
            ((opened == pair(0, 2) && mirrored == pair(1, 2)) || (opened == pair(1, 2) && mirrored == pair(0, 2))),
            "2^-" << bits);
        // One side for all: the sign of delta decides, not its rounding.
        AtVertex first(three_disks(1, 1.5, 0.1, 1, -1));
        const auto c = decide_opening(first.statics, -1, OpeningRule::most_negative, {}, 0);
        BOOST_TEST((first.contact(c.value().opening->contact) == opened), "2^-" << bits);
    }
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

BOOST_AUTO_TEST_SUITE_END()
