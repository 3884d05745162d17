#include "trajectory/bounded_steering.hpp"

#include "motion/arc.hpp"
#include "trajectory/prover.hpp"
#include "trajectory/record.hpp"

#include <algorithm>

namespace isostat {

namespace {

/// Cost of the solves of a vertex and of the arc from it, in passes of fresh factors.
double cost_of_solves(const Vertex& vertex, int arc_passes) {
    constexpr double proofs = 3; // passes of the bound and the enclosure
    return (arc_passes + vertex.factorisation.passes() + proofs) * vertex.factorisation.approximate().relative_cost();
}

/// New factors are due when this vertex cost more than the average since the last ones, including the cost of making
/// factors, because this keeps the average smallest. Cost is counted in operations, never in seconds.
bool new_factors_are_due(const Vertex& vertex, double cost) {
    constexpr double factorisation_in_passes = 90; // KLU: analysis and factorisation, measured for n = 1936, 4900
    const int exchanges = vertex.factorisation.approximate().exchanges();
    return exchanges > 0 && cost * (exchanges + 1) > factorisation_in_passes + vertex.cost_before + cost;
}

} // namespace

BoundedSteering::BoundedSteering(std::shared_ptr<const Vertex> from, ArcStart start, Result<Departure> departure,
                                 double step_fraction, CandidateList& candidates)
    : vertex_(std::move(from)), from_(*vertex_), start_(std::move(start)), candidates_(candidates),
      opened_(from_.structure.contacts()[start_.opening.contact.index()]), departure_(std::move(departure)) {
    arc_options_.step_fraction = step_fraction;
    if (departure_.ok()) {
        next_to_ = departure_.value().closes;
        arc_options_.leaving = departure_.value().leaving;
        arc_options_.kept_touching = departure_.value().kept_touching;
        arc_options_.assumed_touching = departure_.value().assumed_touching;
    }
}

/// Rattlers turn far from arc to arc, so reused factors predict their curvature badly. Rattlers are few, so that
/// factors of their block cost little.
void BoundedSteering::refresh() {
    const Opening& opening = start_.opening;
    if (opening.infinitesimal && !from_.factorisation.is_fresh()) {
        fresh_ = Factorisation::of_moving_block(from_.structure, static_cast<int>(opening.contact.index()));
        if (!fresh_) {
            fresh_.emplace(from_.structure);
        }
    }
}

Result<Arc> BoundedSteering::attempt() {
    if (next_to_) {
        Arc none;
        none.end = from_.packing;
        none.closed = *next_to_;
        return none;
    }
    const Opening& opening = start_.opening;
    const ArcOrigin origin{from_.packing, from_.structure, fresh_ ? *fresh_ : from_.factorisation, opening.contact,
                           opening.direction};
    return follow_arc(origin, power_load(*start_.load, opening, start_.kind), candidates_, arc_options_);
}

Result<ArcProposal> BoundedSteering::propose() {
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
        return refused_.value_or(arc.failure()); // beyond a grazing pair nothing is known
    }
    proposed_ = true;
    if (precisely_ && !arc_options_.precisely) {
        improve_end(arc.value());
    }
    return proposal(std::move(arc.value()));
}

void BoundedSteering::improve_end(Arc& path) const {
    auto end = precise_end(
        RoughEnd{from_.structure, start_.opening.contact, path.closed, path.end, path.tangent, path.displacement});
    if (end) {
        path.end = std::move(*end);
    }
}

ArcProposal BoundedSteering::proposal(Arc path) const {
    ArcProposal arc;
    arc.record.step = start_.step;
    arc.record.kind = start_.kind;
    arc.record.opened = opened_;
    arc.record.perturbed = start_.settled;
    record_path(arc.record, path);
    arc.opening = start_.opening;
    arc.end = std::move(path.end);
    arc.tangent = std::move(path.tangent);
    arc.stays = next_to_.has_value();
    arc.kept_touching = departure_.value().kept_touching;
    arc.assumed_touching = departure_.value().assumed_touching;
    arc.settled = departure_.value().settled;
    arc.contacts = IsostaticStructure::exchange(from_.structure, arc.end, start_.opening.contact, path.closed);
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

/// A defect of a refused proposal, and what is proposed instead.
struct BoundedSteering::Remedy {
    bool (*applies)(const BoundedSteering&, const ArcProof&);
    void (*propose)(BoundedSteering&, const ArcProof&);
};

/// The remedies, in the order in which they are tried.
auto BoundedSteering::remedies() -> const std::vector<Remedy>& {
    using S = BoundedSteering;
    using Proof = ArcProof;
    static const std::vector<Remedy> table{
        // Another contact closed before: end the arc there.
        {[](const S&, const Proof& p) { return p.closed_before.has_value(); },
         [](S& s, const Proof& p) { (s.next_to_ ? s.next_to_ : s.arc_options_.closes) = p.closed_before; }},
        // No vertex is proved at an end that old factors found: use fresh factors.
        {[](const S& s, const Proof& p) {
             return !p.vertex && !s.fresh_ && !s.next_to_ && !s.from_.factorisation.is_fresh();
         },
         [](S& s, const Proof&) { s.fresh_.emplace(s.from_.structure); }},
        // The power is proved negative at the end, so it turned before: use a sharper tangent.
        {[](const S& s, const Proof& p) {
             return p.reached && !p.next && !p.record.power_turn && !s.next_to_ && !s.arc_options_.sharp_power &&
                    p.record.power + p.record.power_bound < 0;
         },
         [](S& s, const Proof&) { s.arc_options_.sharp_power = true; }},
        // Double locates the end of a nearly singular list too badly: use more digits at the end.
        {[](const S& s, const Proof& p) {
             return !p.vertex && !s.precisely_ && !s.next_to_ && p.record.closed.kind != ContactKind::held;
         },
         [](S& s, const Proof&) { s.precisely_ = true; }},
        // A nearly singular list has no end in double: follow the whole arc in double-double.
        {[](const S& s, const Proof& p) { return !p.vertex && !s.arc_options_.precisely && !s.next_to_; },
         [](S& s, const Proof& p) {
             s.arc_options_.precisely = true;
             s.refused_ = p.failure;
         }},
        // Where ties are chosen, and no list is regular at the end, the pair may only graze: go on without it. The gaps
        // at the end of the arc decide whether it did.
        {[](const S& s, const Proof& p) {
             const Contact& closed = p.record.closed;
             return !p.vertex && !p.list_for_end && !s.next_to_ && s.from_.perturbed &&
                    s.from_.perturbed->statics.chooses() && closed.kind != ContactKind::held && closed != s.opened_ &&
                    !s.arc_options_.closes;
         },
         [](S& s, const Proof& p) {
             s.arc_options_.assumed_touching.push_back(p.record.closed);
             s.refused_ = p.failure;
         }}};
    return table;
}

auto BoundedSteering::remedy(const ArcProof& refused) const -> const Remedy* {
    const auto& all = remedies();
    const auto first = std::find_if(all.begin(), all.end(), [&](const Remedy& r) { return r.applies(*this, refused); });
    return first == all.end() ? nullptr : &*first;
}

void BoundedSteering::revise(const ArcProof& refused) {
    remedy(refused)->propose(*this, refused);
    proposed_ = false;
}

} // namespace isostat
