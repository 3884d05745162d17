// What becomes of an arc that was steered badly, or not at all.
#include "support/prepared.hpp"
#include "trajectory/bounded_steering.hpp"
#include "trajectory/prover.hpp"
#include "trajectory/ties/first_order_side.hpp"

using namespace isostat;

/// Exit status 2, not 1: nothing is refuted.
BOOST_AUTO_TEST_CASE(what_an_iteration_or_a_rank_did_not_show_of_an_arc_is_undecided) {
    for (const FailureKind kind : {FailureKind::not_converged, FailureKind::not_isostatic}) {
        BOOST_TEST((not_proved(Failure{kind, "why"}).kind == FailureKind::undecided));
    }
    for (const FailureKind kind : {FailureKind::unbounded, FailureKind::flows, FailureKind::overlap}) {
        BOOST_TEST((not_proved(Failure{kind, "why"}).kind == kind));
    }
}

/// Where ties are settled other lists follow at the coordinates of an end, and some are nearly singular.
BOOST_AUTO_TEST_CASE(an_end_that_was_steered_badly_is_put_at_its_true_vertex_where_ties_are_settled) {
    constexpr double badly = 1e-11;
    State state = prepared(12, 1);
    const FirstOrderSide side(state, 1, true);
    RunOptions options{.ties = TiePolicy::choose};
    Prover prover(options, side);
    prover.start_at(state.packing);
    const LimitLoad at{state.load};
    const auto vertex = required(prover.vertex(state.packing, state.contacts, at));
    int arcs = 0;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        Opening opening;
        opening.contact = ContactId(l);
        BoundedSteering steering(vertex, {opening, ArcKind::limit, 1, &at.load, {}}, Departure{}, 0.1,
                                 prover.candidates());
        auto arc = steering.propose();
        if (!arc.ok() || arc.value().record.power_turn) {
            continue;
        }
        ArcProposal& proposal = arc.value();
        const Packing end = proposal.end;
        proposal.end.q[0] += badly;
        snap_to_grid(proposal.end);
        proposal.contacts =
            IsostaticStructure::exchange(vertex->structure, proposal.end, opening.contact, proposal.record.closed);
        const ArcProof proof = prover.prove(*vertex, std::move(proposal), opening, at);
        BOOST_TEST_REQUIRE((proof.vertex != nullptr));
        for (std::size_t k = 0; k < end.q.size(); ++k) {
            BOOST_TEST(std::abs(proof.vertex->packing.q[k] - end.q[k]) < 0.01 * badly);
        }
        ++arcs;
    }
    BOOST_TEST(arcs > 5);
}
