#include "trajectory/bounded_steering.hpp"

#include "motion/precise_end.hpp"
#include "trajectory/prover.hpp"
#include "trajectory/record.hpp"

namespace isostat {

namespace {

/// Cost of the solves of a vertex and of the arc from it, in passes of fresh factors.
template <int Dim> double cost_of_solves(const Vertex<Dim>& vertex, int arc_passes) {
    constexpr double proofs = 3; // passes of the bound and the enclosure
    return (arc_passes + vertex.factorisation.passes() + proofs) * vertex.factorisation.approximate().relative_cost();
}

/// New factors are due when this vertex cost more than the average since the last ones, their making included: the rule
/// that keeps that average smallest. It counts operations, never seconds.
template <int Dim> bool new_factors_are_due(const Vertex<Dim>& vertex, double cost) {
    constexpr double factorisation_in_passes = 90; // KLU: analysis and factorisation, measured for n = 1936, 4900
    const int exchanges = vertex.factorisation.approximate().exchanges();
    return exchanges > 0 && cost * (exchanges + 1) > factorisation_in_passes + vertex.cost_before + cost;
}

} // namespace

template <int Dim>
BoundedSteering<Dim>::BoundedSteering(std::shared_ptr<const Vertex<Dim>> from, ArcStart<Dim> start,
                                      Result<Departure<Dim>> departure, double step_fraction,
                                      CandidateList<Dim>& candidates)
    : vertex_(std::move(from)), from_(*vertex_), start_(std::move(start)), candidates_(candidates),
      opened_(from_.structure.contacts()[start_.opening.contact.index()]), departure_(std::move(departure)) {
    arc_options_.step_fraction = step_fraction;
    if (departure_.ok()) {
        next_to_ = departure_.value().closes;
        arc_options_.leaving = departure_.value().leaving;
        arc_options_.resting = departure_.value().resting;
        arc_options_.taken_to_rest = departure_.value().taken_to_rest;
    }
}

/// Rattlers turn far from arc to arc: factors taken over predict their curvature badly. They are few, so that their own
/// block costs next to nothing.
template <int Dim> void BoundedSteering<Dim>::refresh() {
    const Opening& opening = start_.opening;
    if (opening.infinitesimal && !from_.factorisation.is_fresh()) {
        fresh_ = Factorisation::of_moving_block(from_.structure, static_cast<int>(opening.contact.index()));
        if (!fresh_) {
            fresh_.emplace(from_.structure);
        }
    }
}

template <int Dim> Result<Arc<Dim>> BoundedSteering<Dim>::attempt() {
    if (next_to_) {
        Arc<Dim> none;
        none.end = from_.packing;
        none.closed = *next_to_;
        return none;
    }
    const Opening& opening = start_.opening;
    const ArcOrigin<Dim> origin{from_.packing, from_.structure, fresh_ ? *fresh_ : from_.factorisation, opening.contact,
                                opening.direction};
    return follow_arc(origin, PowerLoad<Dim>{start_.load, opening.infinitesimal, start_.kind == ArcKind::limit},
                      candidates_, arc_options_);
}

template <int Dim> Result<ArcProposal<Dim>> BoundedSteering<Dim>::propose() {
    constexpr int most_proposals = 8;
    if (proposals_ == most_proposals) {
        return Failure{FailureKind::undecided, "the order of the first contacts that close was not settled"};
    }
    if (!departure_.ok()) {
        return departure_.failure();
    }
    if (proposals_++ == 0) {
        refresh();
    }
    auto arc = attempt();
    // An arc that fails, or ends where it began, may only have been predicted badly by old factors.
    if ((!arc.ok() || arc.value().closed == opened_) && (!fresh_ || start_.opening.infinitesimal) &&
        !from_.factorisation.is_fresh()) {
        fresh_.emplace(from_.structure);
        arc = attempt();
    }
    if (!arc.ok() && arc.failure().kind == FailureKind::not_converged && !arc_options_.precisely) {
        arc_options_.precisely = true;
        arc = attempt();
    }
    if (!arc.ok()) {
        return refused_.value_or(arc.failure()); // nothing is known of what lies beyond a pair that was passed by
    }
    proposed_ = true;
    if (precisely_ && !arc_options_.precisely) {
        improve_end(arc.value());
    }
    return proposal(std::move(arc.value()));
}

template <int Dim> void BoundedSteering<Dim>::improve_end(Arc<Dim>& path) const {
    auto end = precise_end(
        RoughEnd<Dim>{from_.structure, start_.opening.contact, path.closed, path.end, path.tangent, path.displacement});
    if (end) {
        path.end = std::move(*end);
    }
}

template <int Dim> ArcProposal<Dim> BoundedSteering<Dim>::proposal(Arc<Dim> path) const {
    ArcProposal<Dim> arc;
    arc.record.step = start_.step;
    arc.record.kind = start_.kind;
    arc.record.opened = opened_;
    arc.record.perturbed = start_.settled;
    record_path(arc.record, path);
    arc.opening = start_.opening;
    arc.end = std::move(path.end);
    arc.tangent = std::move(path.tangent);
    arc.stays = next_to_.has_value();
    arc.resting = departure_.value().resting;
    arc.taken_to_rest = departure_.value().taken_to_rest;
    arc.settled = departure_.value().settled;
    arc.contacts = IsostaticStructure<Dim>::exchange(from_.structure, arc.end, start_.opening.contact, path.closed);
    if (arc.contacts) {
        const ApproximateInverse& old = from_.factorisation.approximate();
        const double cost = cost_of_solves(from_, fresh_ ? 0 : path.passes);
        arc.approximate = new_factors_are_due(from_, cost)
                              ? old.renewed(arc.contacts->matrix())
                              : old.exchanged(arc.contacts->slot(), arc.contacts->matrix());
        arc.cost_before = arc.approximate->exchanges() > 0 ? from_.cost_before + cost : 0;
    }
    return arc;
}

/// Its power is proved negative at the end: it turned before.
template <int Dim> bool BoundedSteering<Dim>::went_too_far(const ArcProof<Dim>& refused) const {
    const ArcRecord<Dim>& record = refused.record;
    return refused.reached && !refused.next && !record.power_turn && !next_to_ && !arc_options_.sharp_power &&
           record.power + record.power_bound < 0;
}

template <int Dim> bool BoundedSteering<Dim>::may_graze(const ArcProof<Dim>& refused) const {
    const Contact& closed = refused.record.closed;
    return !refused.vertex && !refused.list_for_end && !next_to_ && from_.perturbed &&
           from_.perturbed->statics.chooses() && closed.kind != ContactKind::held && closed != opened_ &&
           !arc_options_.closes;
}

template <int Dim> bool BoundedSteering<Dim>::revise(const ArcProof<Dim>& refused) {
    if (refused.closed_before) {
        (next_to_ ? next_to_ : arc_options_.closes) = refused.closed_before;
    } else if (!refused.vertex && !fresh_ && !next_to_ && !from_.factorisation.is_fresh()) {
        fresh_.emplace(from_.structure); // old factors may also have ended it badly
    } else if (went_too_far(refused)) {
        arc_options_.sharp_power = true;
    } else if (!refused.vertex && !precisely_ && !next_to_ && refused.record.closed.kind != ContactKind::held) {
        precisely_ = true; // before what double takes for the end the contacts are another matrix
    } else if (!refused.vertex && !arc_options_.precisely && !next_to_) {
        arc_options_.precisely = true; // contacts that are nearly singular leave no end in double
        refused_ = refused.failure;
    } else if (may_graze(refused)) {
        arc_options_.taken_to_rest.push_back(refused.record.closed); // the gaps at the end tell whether it did
        refused_ = refused.failure;
    } else {
        return false;
    }
    proposed_ = false;
    return true;
}

template class BoundedSteering<2>;

} // namespace isostat
