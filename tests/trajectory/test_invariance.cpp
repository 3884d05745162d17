// The sequence of events is a property of the packing: not of the predictor, the labels, the side from which one looks,
// or the unit.
#include "support/crafted.hpp"
#include "support/same_sequence.hpp"
#include "support/segments.hpp"
#include "support/units.hpp"

#include <isostat/certificate/certify.hpp>

using namespace isostat;
using namespace ::crafted;

namespace {

constexpr int equilibria = 12;

struct Base {
    State start = prepared(60, 5);
    Played played = completed(play(start, +1, equilibria));
};

} // namespace

BOOST_FIXTURE_TEST_CASE(the_sequence_does_not_depend_on_the_predictor_step, Base) {
    BOOST_TEST(played.records.arcs.size() > 20);
    for (const double fraction : {0.4, 0.01}) {
        const Played other = play(start, +1, equilibria, {}, {.step_fraction = fraction});
        check_same_sequence(played, other, events(other.records, same));
    }
}

BOOST_FIXTURE_TEST_CASE(the_sequence_does_not_depend_on_the_labels, Base) {
    check_same_sequence(played, relabelled(start, 3), equilibria);
}

BOOST_FIXTURE_TEST_CASE(the_sequence_does_not_depend_on_mirroring_the_box, Base) {
    check_same_sequence(played, mirrored(start), equilibria);
}

BOOST_FIXTURE_TEST_CASE(the_sequence_does_not_depend_on_exchanging_the_axes, Base) {
    check_same_sequence(played, exchanged(start), equilibria);
}

BOOST_FIXTURE_TEST_CASE(the_sequence_does_not_depend_on_a_quarter_turn_of_the_box, Base) {
    check_same_sequence(played, quarter_turned(start), equilibria);
}

BOOST_FIXTURE_TEST_CASE(the_sequence_does_not_depend_on_noise_far_below_the_margins, Base) {
    // Noise of the radii moves the vertices by about (noise) / sigma_min; it must stay small against every gap of the
    // run that is not a contact, and against the differences of forces that were decided.
    double smallest_gap = 1;
    double sigma = 1;
    for (const auto& e : played.records.equilibria) {
        smallest_gap = std::min(smallest_gap, e.min_gap);
        sigma = std::min(sigma, e.sigma_min_bound);
    }
    for (const double noise : {1e-14, 1e-12, 1e-4 * sigma * smallest_gap}) {
        State noisy = start;
        std::mt19937 random(11);
        for (double& r : noisy.packing.radius) {
            r *= 1 + noise * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1);
        }
        const Played other = play(noisy, +1, equilibria, {}, {.certify = CertifyLevel::arcs});
        check_same_sequence(played, other, events(other.records, same), 1e-8 + 100 * noise / sigma);
        BOOST_TEST(other.counters.arcs.undecided == 0, "noise " << noise);
    }
}

BOOST_FIXTURE_TEST_CASE(scaling_by_powers_of_two_changes_no_bit, Base) {
    for (const auto& [length, stress] : {std::pair{-20, 3}, std::pair{40, -30}}) {
        State scaled = start;
        const double l = std::ldexp(1.0, length);
        const double s = std::ldexp(1.0, stress);
        units::stretch(scaled.packing, l);
        for (std::size_t a = 0; a < 2; ++a) {
            scaled.load.stress[a] *= s;
            scaled.load.reference_length[a] *= l;
        }
        const Played other = completed(play(scaled, +1, equilibria));
        BOOST_TEST_REQUIRE(other.records.equilibria.size() == played.records.equilibria.size());
        for (std::size_t k = 0; k < played.records.equilibria.size(); ++k) {
            BOOST_TEST(other.records.equilibria[k].stress == s * played.records.equilibria[k].stress);
            BOOST_TEST(other.records.equilibria[k].strain[1] == played.records.equilibria[k].strain[1]);
        }
        for (std::size_t k = 0; k < other.state.packing.q.size(); ++k) {
            BOOST_TEST(other.state.packing.q[k] == l * played.state.packing.q[k]);
        }
    }
}

BOOST_FIXTURE_TEST_CASE(the_same_start_gives_the_same_bits, Base) {
    const Played again = play(start, +1, equilibria);
    BOOST_TEST((again.state.packing.q == played.state.packing.q));
    BOOST_TEST((again.state.contacts == played.state.contacts));
}

BOOST_FIXTURE_TEST_CASE(a_run_in_two_parts_gives_the_same_bits_as_in_one, Base) {
    Played first = completed(play(start, +1, equilibria / 2));
    RunOptions options{.max_strain = 1e9};
    const auto outcome =
        run_segment(first.state, towards(equilibria - equilibria / 2), 0, options, first.counters, first.records);
    BOOST_REQUIRE(outcome.completed);
    BOOST_TEST((first.state.packing.q == played.state.packing.q));
    BOOST_TEST(first.counters.steps == played.counters.steps);
    BOOST_TEST(first.records.equilibria.back().stress == played.records.equilibria.back().stress);
}

BOOST_FIXTURE_TEST_CASE(rearrangements_of_one_arc_are_the_same_under_every_opening_rule, Base) {
    int compared = 0;
    for (std::size_t k = 1; k < played.records.equilibria.size(); ++k) {
        if (played.records.equilibria[k].arcs != 1) {
            continue;
        }
        for (const OpeningRule rule : {OpeningRule::random, OpeningRule::least_negative, OpeningRule::least_index}) {
            const Played other = completed(play(played.records.states[k - 1], +1, 1, {}, {.rule = rule}));
            BOOST_TEST((other.state.contacts == played.records.states[k].contacts));
            ++compared;
        }
    }
    BOOST_TEST(compared > 0);
}

BOOST_AUTO_TEST_CASE(every_opening_rule_reaches_equilibria_whose_checks_hold) {
    const State start = prepared(40, 2);
    for (const OpeningRule rule :
         {OpeningRule::most_negative, OpeningRule::random, OpeningRule::least_negative, OpeningRule::least_index}) {
        const Played run = play(start, +1, 6, {}, {.rule = rule});
        // The weakest traction may be that of a disk that carries nothing but what its turn was rounded by: a tie,
        // named.
        BOOST_TEST((run.outcome.completed ||
                    (rule == OpeningRule::least_negative && run.outcome.failure->kind == FailureKind::tie)),
                   run.why());
        BOOST_TEST(run.records.equilibria.size() > 1U);
        for (const auto& e : run.records.equilibria) {
            BOOST_TEST((e.verdict == Verdict::proved));
            BOOST_TEST(e.rank == e.dof_count);
            BOOST_TEST(e.contact_count == e.dof_count);
            BOOST_TEST(e.dof_count + e.hyperstaticity == e.contact_count + e.mechanisms);
            BOOST_TEST(e.backbone == 2 * (40 - e.rattlers) + 2);
            BOOST_TEST(e.min_force > e.force_bound);
            BOOST_TEST(e.min_gap > 0);
            BOOST_TEST(e.balance < 1e-12);
            BOOST_TEST(e.virtual_power < 1e-12);
            BOOST_TEST(e.gap_residual < 1e-12);
        }
    }
}

BOOST_AUTO_TEST_CASE(dead_loads_make_the_potential_decrease_along_every_arc) {
    const Played run = completed(play(prepared(80, 4), +1, 10));
    for (const auto& arc : run.records.arcs) {
        BOOST_TEST((arc.work > 0 || arc.kind == ArcKind::rattler),
                   "arc " << arc.step << " " << to_string(arc.kind) << " work " << arc.work);
    }
}

BOOST_AUTO_TEST_CASE(an_opening_gap_that_turns_back_is_followed_past_its_start, *boost::unit_test::label("slow")) {
    // Both runs meet an arc whose opened contact is predicted to close again: the start is a root of the event
    // equations too.
    for (const std::uint64_t seed : {4U, 9U}) {
        const Played run = play(prepared(400, seed), +1, 60);
        BOOST_TEST(run.outcome.completed, run.why());
    }
}

BOOST_AUTO_TEST_CASE(true_stress_loads_follow_the_current_lengths) {
    State start = prepared(40, 9);
    start.load.kind = LoadKind::true_stress;
    const Played run = play(start, +1, 5);
    BOOST_TEST((run.outcome.completed || run.outcome.failure->kind == FailureKind::cap_reached), run.why());
    BOOST_REQUIRE(!run.records.states.empty());
    const State& last = run.records.states.back();
    BOOST_TEST(last.load.external_force(last.packing)[2 * 40] == -last.load.stress[0] * last.packing.length(1));
    // The first limit is a property of the start: the two kinds of load agree there.
    const Played dead = play(prepared(40, 9), +1, 1);
    BOOST_TEST(run.records.equilibria[1].stress == dead.records.equilibria[1].stress,
               boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(true_stresses_have_a_strict_minimum_of_a_potential_of_their_own) {
    State state = prepared(40, 9);
    BOOST_TEST((inspect_vertex(state).value().stable == Verdict::proved));
    state.load.kind = LoadKind::true_stress;
    const auto inspection = inspect_vertex(state);
    BOOST_TEST(inspection.value().equilibrium);
    BOOST_TEST((inspection.value().stable == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(a_cap_on_arcs_ends_the_run_with_the_last_equilibrium) {
    const Played run = play(prepared(60, 5), +1, 12, {}, {.max_arcs = 1});
    fails(run.outcome.failure, FailureKind::cap_reached);
    const auto inspection = required(inspect_vertex(run.state));
    BOOST_TEST(inspection.equilibrium, inspection.remark);
}

BOOST_AUTO_TEST_CASE(a_stop_request_ends_the_run_with_the_last_equilibrium) {
    const std::atomic<bool> stop{true};
    const Played run = play(prepared(20, 1), +1, 12, {}, {.stop = &stop});
    fails(run.outcome.failure, FailureKind::interrupted);
    BOOST_TEST(run.records.equilibria.size() == 1U);
}
