// The closed-form cases: one, two and three disks, against their formulas.
#include "support/crafted.hpp"

#include <isostat/certificate/certify.hpp>

using namespace isostat;
using namespace ::crafted;

namespace {

double force_of(const Inspection& inspection, const State& state, const Contact& contact) {
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        if (state.contacts[l] == contact) {
            return inspection.forces[l];
        }
    }
    BOOST_FAIL("no contact " + to_string(contact));
    return 0;
}

} // namespace

BOOST_AUTO_TEST_CASE(one_disk_carries_the_wall_forces_and_supports_every_load) {
    const State state = one_disk(1.5, 0.25);
    const auto inspection = required(inspect_vertex(state));
    BOOST_TEST(inspection.equilibrium, inspection.remark);
    BOOST_TEST(force_of(inspection, state, left(0)) == 1.5);
    BOOST_TEST(force_of(inspection, state, right(0)) == 1.5);
    BOOST_TEST(force_of(inspection, state, bottom(0)) == 0.25);
    BOOST_TEST(force_of(inspection, state, top(0)) == 0.25);
    const Played up = play(state, +1, 1);
    fails(up.outcome.failure, FailureKind::no_limit);
    const Played to = play(state, +1, {}, 100.0);
    BOOST_TEST(to.outcome.completed);
    BOOST_TEST(to.records.equilibria.back().stress == 100.0);
}

BOOST_AUTO_TEST_CASE(two_disks_have_the_forces_and_the_limits_of_the_closed_form) {
    for (const double r1 : {1.1, 2.0, 5.0}) {
        const State state = two_disks(1, r1, 1, 1.5);
        const auto inspection = required(inspect_vertex(state));
        const double t = (r1 - 1) / (2 * std::sqrt(r1));
        const double cosine = 1 / std::sqrt(1 + t * t);
        BOOST_TEST(force_of(inspection, state, left(0)) == 1.0, boost::test_tools::tolerance(1e-14));
        BOOST_TEST(force_of(inspection, state, bottom(0)) == t, boost::test_tools::tolerance(1e-13));
        BOOST_TEST(force_of(inspection, state, pair(0, 1)) == 1 / cosine, boost::test_tools::tolerance(1e-14));
        BOOST_TEST(force_of(inspection, state, bottom(1)) == 1.5 - t, boost::test_tools::tolerance(1e-13));
        BOOST_TEST(inspection.record.stress_low == t, boost::test_tools::tolerance(1e-13));
        BOOST_TEST((inspection.record.opens_low == bottom(1)));
        BOOST_TEST(std::isinf(inspection.record.stress_high));
    }
}

BOOST_AUTO_TEST_CASE(two_disks_run_through_the_complete_hysteresis_loop) {
    const double root2 = std::sqrt(2.0);
    Played down = completed(play(two_disks(1, 2, 1, 1), -1, 1));
    BOOST_REQUIRE(down.records.equilibria.size() == 2);
    const auto& start = down.records.equilibria[0];
    const auto& turned = down.records.equilibria[1];
    BOOST_TEST(start.length[0] == 3 + 2 * root2, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(turned.stress == 1 / (2 * root2), boost::test_tools::tolerance(1e-13));
    BOOST_TEST(turned.length[0] == 4.0, boost::test_tools::tolerance(1e-13));
    BOOST_TEST(turned.length[1] == 3 + 2 * root2, boost::test_tools::tolerance(1e-13));
    BOOST_TEST(turned.arcs == 1);
    BOOST_TEST((down.records.arcs.front().opened == bottom(1)));
    BOOST_TEST((down.records.arcs.front().closed == left(1)));
    BOOST_TEST(down.records.arcs.front().power > 0);
    BOOST_TEST(down.records.arcs.front().work > 0);
    // The mirrored forces.
    const auto inspection = required(inspect_vertex(down.state));
    BOOST_TEST(force_of(inspection, down.state, bottom(0)) == turned.stress, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(force_of(inspection, down.state, left(0)) == turned.stress / (2 * root2),
               boost::test_tools::tolerance(1e-12));

    Played up = completed(play(down.state, +1, 1));
    const auto& back = up.records.equilibria.back();
    BOOST_TEST(back.stress == 2 * root2, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(back.length[0] == 3 + 2 * root2, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(back.length[1] == 4.0, boost::test_tools::tolerance(1e-12));
    BOOST_TEST((up.records.arcs.back().closed == bottom(1)));
}

BOOST_AUTO_TEST_CASE(the_five_contact_state_of_two_disks_is_an_equilibrium_that_is_not_stable) {
    // Disk 1 on its way over disk 0: neither on the bottom nor on the left wall, tan(angle of 01) = F2 / F1.
    for (const double angle : {0.6, 0.9}) {
        const double x = 1 + 3 * std::cos(angle);
        const double y = 1 + 3 * std::sin(angle);
        const State state = in_box({{1, 1, 1}, {2, x, y}}, x + 2, y + 2, 1, std::tan(angle),
                                   {left(0), bottom(0), pair(0, 1), right(1), top(1)});
        const auto inspection = required(inspect_vertex(state));
        BOOST_TEST(inspection.counting.mechanisms == 1);
        BOOST_TEST(inspection.record.held == 1);
        BOOST_TEST(!inspection.equilibrium);
        BOOST_TEST((inspection.stable == Verdict::refuted), inspection.remark);
        BOOST_TEST(inspection.second_order.negative());
        BOOST_TEST(inspection.remark.find("not stable") != std::string::npos, inspection.remark);
        // Off the balance of the two forces the mechanism moves, and that is what is said.
        State off = state;
        off.load.stress[1] *= 1.01;
        const auto moved = required(inspect_vertex(off));
        BOOST_TEST(moved.remark.find("mechanism moves") != std::string::npos, moved.remark);
        BOOST_TEST((moved.stable == Verdict::undecided));
    }
}

BOOST_AUTO_TEST_CASE(unloading_inside_the_hysteresis_loop_changes_nothing) {
    const Played played = completed(play(two_disks(1, 2, 1, 1), -1, {}, 0.5));
    BOOST_TEST(played.records.arcs.empty());
    BOOST_TEST((played.state.packing.q == two_disks(1, 2, 1, 1).packing.q));
}

BOOST_AUTO_TEST_CASE(three_disks_have_the_forces_of_the_closed_form) {
    const State state = three_disks(1, 1, 1.5, 3, 1);
    const auto inspection = required(inspect_vertex(state));
    const double sine = 1 / 2.5;
    const double cosine = std::sqrt(1 - sine * sine);
    BOOST_TEST(force_of(inspection, state, bottom(0)) == 0.5, boost::test_tools::tolerance(1e-13));
    BOOST_TEST(force_of(inspection, state, bottom(1)) == 0.5, boost::test_tools::tolerance(1e-13));
    BOOST_TEST(force_of(inspection, state, pair(0, 2)) == 1 / (2 * cosine), boost::test_tools::tolerance(1e-13));
    BOOST_TEST(force_of(inspection, state, pair(0, 1)) == 3 - 0.5 * sine / cosine, boost::test_tools::tolerance(1e-13));
    BOOST_TEST(inspection.record.stress_high == 3 * 2 * std::sqrt(1.5 * 3.5), boost::test_tools::tolerance(1e-13));
    BOOST_TEST((inspection.record.opens_high == pair(0, 1)));
}

BOOST_AUTO_TEST_CASE(three_disks_with_a_large_top_disk_end_on_the_bottom) {
    const Played played = completed(play(three_disks(1, 1, 1.5, 1, 1), +1, 1));
    const auto& end = played.records.equilibria.back();
    BOOST_TEST((played.records.arcs.back().closed == bottom(2)));
    BOOST_TEST(end.length[0] == 2 + 4 * std::sqrt(1.5), boost::test_tools::tolerance(1e-13));
    BOOST_TEST(end.length[1] == 3.0, boost::test_tools::tolerance(1e-13));
}

BOOST_AUTO_TEST_CASE(three_disks_with_a_small_top_disk_close_two_contacts_at_once_and_are_reported_as_tie) {
    const Played played = play(three_disks(1, 1, 0.5, 1, 1), +1, 1);
    // One of the two base disks met the top wall, the other one is named.
    fails(played.outcome.failure, FailureKind::tie, {"0-top", "1-top"});
    BOOST_TEST(played.state.equilibrium == 0); // the last equilibrium is what remains
}

BOOST_AUTO_TEST_CASE(three_equal_disks_close_three_contacts_at_once_and_are_reported_as_tie) {
    const Played played = play(three_disks(1, 1, 1, 1, 1), +1, 1);
    fails(played.outcome.failure, FailureKind::tie);
}

BOOST_AUTO_TEST_CASE(three_disks_with_unequal_base_radii_have_no_tie) {
    for (const double rt : {0.5, 1.0, 1.5}) {
        const Played played = play(three_disks(1, 1.0625, rt, 1, 1), +1, 1);
        BOOST_TEST(played.outcome.completed, played.why());
    }
}

BOOST_AUTO_TEST_CASE(the_square_lattice_is_refused_because_h_is_positive) {
    const Played played = play(square_lattice(3), +1, 1);
    fails(played.outcome.failure, FailureKind::not_isostatic);
    BOOST_TEST(played.records.equilibria.empty());
}
