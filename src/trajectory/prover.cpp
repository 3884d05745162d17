#include "trajectory/prover.hpp"

#include "contact/words.hpp"
#include "core/dot.hpp"
#include "motion/certify_arc.hpp"
#include "trajectory/descent.hpp"
#include "trajectory/floating_steering.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace isostat {

namespace {

/// Relative accuracy of forces during a rearrangement: enough for records, and more than most decisions need.
constexpr double enough_to_decide = 1e-12;

double size_of_work(const Load& load, const Vertex& from) {
    double size = 0;
    for (const WallForce& wall : load.wall_forces(from.packing)) {
        size += std::abs(wall.stress * wall.length * from.packing.q[static_cast<std::size_t>(wall.coordinate)]);
    }
    return size;
}

/// The bound for the work of an arc under dead loads that a record should have (`record_tolerance`, proofs/checker.md,
/// accepts somewhat larger ones).
double wanted_bound(const Load& load, const Vertex& from) {
    constexpr double enough = 4e-10;
    return enough * size_of_work(load, from);
}

/// The work from rounded coordinates, with its distance to the proved value as bound; the proved value where this
/// distance is too large. `decrease`: of the potential, when the finite loads decided.
void record_work(ArcRecord& record, const Vertex& from, const Vertex& to, const Load& load,
                 const std::optional<Enclosure>& decrease) {
    record.work = work_of(load, from.packing, to.packing).value;
    if (load.kind == LoadKind::nominal) {
        const Enclosure work = decrease ? *decrease : work_between(from, to, load);
        // Where the sign took many digits: no finer than double-double, in which a checker can confirm the record.
        const double size = size_of_work(load, from);
        if (std::abs(record.work - work.value) > wanted_bound(load, from)) {
            record.work = work.value;
        }
        record.work_bound =
            (std::abs(record.work - work.value) + std::max(work.radius, 0x1p-98 * size)) * (1 + 0x1p-50);
    }
}

/// Pairs that touch at both ends of an arc: grains that make one
/// body; all pairs, with the contact that opens, when nothing moves.
ZeroGaps touch_still(const Vertex& from, const ArcProposal& arc) {
    ZeroGaps still;
    for (const auto& pair : from.perturbed ? from.perturbed->zero : ZeroGaps()) {
        if (arc.stays ||
            std::find(arc.kept_touching.begin(), arc.kept_touching.end(), pair.first) != arc.kept_touching.end()) {
            still.push_back(pair);
            if (arc.stays && pair.first == arc.record.closed) {
                still.back().first = arc.record.opened;
            }
        }
    }
    return still;
}

/// The bound of a force gives its sign, but is too wide for a record: `verify` accepts a thousandth of the largest
/// force (`force_tolerance`, proofs/checker.md). Nearly singular contacts have such bounds in double.
bool says_too_little(const Statics& statics, const Enclosure& f, double stress, bool infinitesimal) {
    constexpr double enough = 9e-4;
    if (!(f.radius > enough * std::abs(f.value))) {
        return false;
    }
    double largest = 0;
    for (std::size_t l = 0; l < statics.structure().contacts().size(); ++l) {
        const ContactId contact(l);
        const Enclosure other = infinitesimal ? statics.infinitesimal(contact) : statics.force(contact, stress);
        largest = std::max(largest, std::abs(other.value));
    }
    return f.radius > enough * largest;
}

bool overlaps_at_first_order(const Vertex& vertex) {
    return vertex.perturbed && std::any_of(vertex.perturbed->touching.begin(), vertex.perturbed->touching.end(),
                                           [](const auto& pair) { return pair.second.negative(); });
}

/// The end moved to the grid point nearest to its true vertex, if it is
/// farther away: later lists at these coordinates may be nearly singular.
std::optional<Packing> nearer(const Vertex& vertex) {
    const double far = 64 * grid_step(vertex.packing);
    if (vertex.enclosure.distance() <= far) {
        return std::nullopt;
    }
    const VertexEnclosure there =
        enclose_vertex_double_double(vertex.packing, vertex.structure, vertex.factorisation, vertex.inverse);
    if (there.verdict != Verdict::proved || !(largest(there.correction) > far)) {
        return std::nullopt;
    }
    Packing at = vertex.packing;
    for (std::size_t k = 0; k < at.q.size(); ++k) {
        at.q[k] += there.correction[k];
    }
    snap_to_grid(at);
    return at;
}

/// The guesses are moved out of the proposal.
Exchange exchange_of(ArcProposal& arc) {
    return {arc.end,
            arc.opening.contact,
            arc.record.closed,
            std::move(arc.contacts),
            std::move(arc.approximate),
            std::move(arc.forces),
            std::move(arc.tangent),
            arc.cost_before};
}

/// A coarser grid rounds a held coordinate, or the coordinate relative to which it is held: then it is held elsewhere
/// at the end of the arc, and the end belongs to another curve.
bool holds_elsewhere(const Vertex& from, const ArcProposal& arc) {
    const std::vector<Contact>& contacts = from.structure.contacts();
    const std::vector<double>& before = from.packing.q;
    bool holds = arc.record.closed.kind == ContactKind::held;
    bool moved = false;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (contacts[l].kind == ContactKind::held && ContactId(l) != arc.opening.contact) {
            const auto k = static_cast<std::size_t>(contacts[l].i);
            holds = true;
            moved = moved || arc.end.q[k] != before[k];
        }
    }
    for (std::size_t k = 0; holds && k < before.size(); ++k) {
        moved = moved || (from.structure.dofs().dof_of(k) < 0 && arc.end.q[k] != before[k]);
    }
    return moved;
}

} // namespace

void ArcProof::count(const Decision& decision) {
    decisions.push_back(decision);
    record.margin = std::min(record.margin, decision.margin);
    record.decided_by = std::max(record.decided_by, decision.rung);
}

void Prover::start_at(const Packing& packing, const std::shared_ptr<const RegularTriangulation>& near) {
    if (candidates_.reference != packing.q || candidates_.contacts.empty()) { // otherwise the list would be the same
        candidates_ = find_candidates(packing, candidate_fraction, near ? near : candidates_.triangulation);
    }
    certified_bounds_.forget();
}

Result<std::shared_ptr<Vertex>> Prover::vertex(Packing packing, std::vector<Contact> contacts, const LimitLoad& at) {
    bounds_.forget(); // the bound is that which `certify` finds of this state
    auto made = Vertex::make(std::move(packing), std::move(contacts), at.load, bounds_, ladder());
    if (!made.ok()) {
        return made.failure();
    }
    ties_->attach(*made.value(), at);
    return std::shared_ptr<Vertex>(std::move(made.value()));
}

LadderOptions Prover::ladder() const {
    LadderOptions options;
    if (options_->chooses()) {
        options.first_bits = 280;
        options.max_bits = 1120; // tie_bits, and bits lost by a bad condition number
    }
    return options;
}

Result<OpeningDecision> Prover::decide(Vertex& vertex, double stress, const ZeroHolds& zero, long step) const {
    auto decision = decide_opening(vertex.statics, stress, options_->rule, zero, bits_for(options_->rule_seed, step),
                                   vertex.first_order());
    if (!decision.ok() || !decision.value().opening) {
        return decision;
    }
    Opening& opening = *decision.value().opening;
    Statics& statics = vertex.statics;
    if (statics.structure().contacts()[opening.contact.index()].kind != ContactKind::held) {
        while (says_too_little(statics, opening.force, stress, opening.infinitesimal) && statics.climb()) {
            opening.force =
                opening.infinitesimal ? statics.infinitesimal(opening.contact) : statics.force(opening.contact, stress);
        }
    }
    return decision;
}

ArcProof Prover::prove(const Vertex& from, ArcProposal arc, const Opening& opening, const LimitLoad& at) {
    ArcProof proof;
    ArcRecord& record = proof.record;
    record = arc.record;
    record.force = opening.force.value;
    record.force_bound =
        record.kind == ArcKind::limit ? 0 : opening.force.radius; // the load is the one where the force vanishes
    record.margin = std::numeric_limits<double>::infinity();
    record.decided_by = Rung::combinatorial;
    proof.count({DecisionKind::opening, opening.margin, opening.rung, opening.perturbed});
    proof.failure = reach(proof, from, arc, at);
    if (!proof.reached) {
        return proof;
    }
    proof.failure = descend(proof, from, opening, at.load);
    if (!proof.failure && opening.moves_rattlers()) {
        proof.failure = work_of_load(proof, opening, at.stress());
    }
    if (!proof.failure && !record.power_turn) {
        proof.failure = power(proof, opening, at.stress());
    }
    if (proof.failure || (proof.turned_back() && (arc.ahead || !proof.descends))) {
        return proof;
    }
    record_strain(record, *proof.vertex, at.load);
    proof.next = decide(*proof.vertex, at.stress(), record.power_turn ? ZeroHolds{opening.contact, {}} : ZeroHolds{},
                        record.step);
    take_log(*proof.vertex, record.perturbed);
    if (options_->certify == CertifyLevel::arcs && (proof.agrees() || !arc.ahead)) {
        certify(proof, from, opening, at.load);
    }
    return proof;
}

/// Proves the vertex at the end, and that no gap closed before.
std::optional<Failure> Prover::reach(ArcProof& proof, const Vertex& from, ArcProposal& arc, const LimitLoad& at) {
    const auto at_end = [&](const Failure& failure) {
        return located(failure, words("at the end of the arc that opens {} and closes {}", named(proof.record.opened),
                                      named(proof.record.closed)));
    };
    if (holds_elsewhere(from, arc)) {
        return at_end(Failure{FailureKind::undecided, "coordinates are held, and the grid became coarser: where they "
                                                      "are held would change by a rounding"});
    }
    LadderOptions options = ladder();
    options.first_accuracy = ties_->settles() ? 0 : enough_to_decide; // telling ties from zeros needs full accuracy
    auto made = Vertex::exchanged(from, exchange_of(arc), at.load, bounds_, options);
    if (!made.ok()) {
        if (from.perturbed && from.perturbed->statics.chooses() && !arc.stays) {
            proof.list_for_end = list_for_the_end(from, arc, at.stress());
        }
        return at_end(not_proved(made.failure()));
    }
    proof.vertex = std::move(made.value());
    if (auto end = ties_->settles() && !arc.stays ? nearer(*proof.vertex) : std::nullopt) {
        auto again = Vertex::make(std::move(*end), proof.vertex->structure.contacts(), at.load, bounds_, options);
        if (again.ok()) {
            proof.vertex = std::move(again.value());
        }
    }
    ties_->attach(*proof.vertex, at);
    const auto found = gaps(*proof.vertex, touch_still(from, arc));
    if (!found.ok()) {
        return at_end(found.failure());
    }
    proof.closed_before = found.value().negative;
    const std::vector<Contact>& taken = arc.assumed_touching;
    if (proof.closed_before && std::find(taken.begin(), taken.end(), *proof.closed_before) != taken.end()) {
        return at_end(failed(FailureKind::undecided,
                             "{} overlap: they touch where it begins, and neither the rate nor the second derivative "
                             "of their gap is told from 0 there",
                             named(*proof.closed_before)));
    }
    if (proof.closed_before) {
        return std::nullopt;
    }
    std::vector<Contact> touching = arc.kept_touching;
    touching.insert(touching.end(), taken.begin(), taken.end());
    const bool overlapped = arc.relists || overlaps_at_first_order(from);
    return arrive(proof, arc.settled, {arc.opening.contact, arc.stays, touching, overlapped}, found.value());
}

Result<std::shared_ptr<Vertex>> Prover::exchange(const Vertex& from, const ListExchange& exchange,
                                                 const LimitLoad& at) {
    ArcProposal arc;
    arc.record.opened = from.structure.contacts()[exchange.leaves.index()];
    arc.record.closed = exchange.enters;
    arc.opening.contact = exchange.leaves;
    arc.end = from.packing;
    arc.stays = arc.relists = true;
    arc.contacts = IsostaticStructure::exchange(from.structure, arc.end, exchange.leaves, exchange.enters);
    if (arc.contacts) {
        arc.approximate = from.factorisation.approximate().exchanged(arc.contacts->slot(), arc.contacts->matrix());
        arc.cost_before = from.cost_before;
    }
    ArcProof proof;
    proof.record = arc.record;
    if (auto failure = reach(proof, from, arc, at)) {
        return *failure;
    }
    if (proof.closed_before) {
        return failed(FailureKind::undecided, "where {} gives way to {}: {} overlap", named(arc.record.opened),
                      named(arc.record.closed), named(*proof.closed_before));
    }
    return proof.vertex;
}

/// Judges pairs that touch at the end at first order.
std::optional<Failure> Prover::arrive(ArcProof& proof, std::vector<TieDecision> settled, const Way& way,
                                      const Vertex::Gaps& gaps) const {
    if (!gaps.zero.empty()) {
        auto arrival = isostat::arrive(*proof.vertex, gaps.zero, way);
        if (!arrival.ok()) {
            return arrival.failure();
        }
        proof.closed_before = arrival.value().earlier;
        if (proof.closed_before) {
            return std::nullopt;
        }
        settled.insert(settled.end(), arrival.value().settled.begin(), arrival.value().settled.end());
    }
    proof.record.perturbed.insert(proof.record.perturbed.end(), settled.begin(), settled.end());
    proof.count({DecisionKind::gaps, gaps.margin, gaps.rung, !settled.empty()});
    proof.reached = true;
    return std::nullopt;
}

std::optional<Failure> Prover::descend(ArcProof& proof, const Vertex& from, const Opening& opening, const Load& load) {
    const Vertex& to = *proof.vertex;
    if (!has_potential(load, opening.moves_rattlers())) {
        proof.record.work = work_of(load, from.packing, to.packing).value;
        return std::nullopt;
    }
    const bool recorded = load.kind == LoadKind::nominal && !opening.moves_rattlers();
    const Enclosure decrease =
        potential_decrease(from, to, load, opening.moves_rattlers(),
                           recorded ? wanted_bound(load, from) : std::numeric_limits<double>::infinity());
    record_work(proof.record, from, to, load, opening.moves_rattlers() ? std::nullopt : std::optional(decrease));
    proof.descends = decrease.positive();
    // An arc of length O(eps) ends where it began: first-order terms decide there.
    const bool at_once = from.perturbed && from.packing.q == to.packing.q;
    if (proof.descends || at_once) {
        return std::nullopt;
    }
    if (decrease.negative()) {
        return failed(FailureKind::undecided,
                      "the potential rises by {:.6g}, known to {:.3g}, along the arc that opens {} and closes {}",
                      -decrease.value, decrease.radius, named(proof.record.opened), named(proof.record.closed));
    }
    return failed(FailureKind::undecided,
                  "the potential is not proved to decrease along the arc that opens {} and closes {}: by "
                  "{:.6g}, known to {:.3g}",
                  named(proof.record.opened), named(proof.record.closed), decrease.value, decrease.radius);
}

/// The load does no work on an arc of rattlers; where a contact that bears force closes, its power has not turned.
std::optional<Failure> Prover::work_of_load(const ArcProof& proof, const Opening& opening, double stress) {
    const Statics& statics = proof.vertex->statics;
    const ContactId slot = opening.contact;
    const bool moves_no_load = statics.is_structural_zero(slot) || proof.vertex->perturbed;
    if (moves_no_load || (!proof.record.power_turn && statics.force(slot, stress).positive())) {
        return std::nullopt;
    }
    return failed(
        FailureKind::undecided,
        "grains that bear force move on the arc that opens {} and ends with {}, which the infinitesimal loads "
        "open: the power of the load on that arc is not followed",
        named(proof.record.opened), named(proof.record.closed));
}

/// F.t = f_c (G t)_c at the event, and the new gap closes, so the power is positive there iff the new force is.
std::optional<Failure> Prover::power(ArcProof& proof, const Opening& opening, double stress) {
    Vertex& to = *proof.vertex;
    ArcRecord& record = proof.record;
    const ContactId closed = opening.contact; // in the same slot
    const auto force = [&] {
        return opening.moves_rattlers() ? to.statics.infinitesimal(closed) : to.statics.force(closed, stress);
    };
    Enclosure f = force();
    record.power = f.value;
    record.power_bound = f.radius;
    if (to.perturbed && !opening.moves_rattlers() && !f.decided() && !to.statics.is_structural_zero(closed)) {
        const Order order = to.statics.sign(to.statics.force_expression(closed, stress));
        PerturbedStatics& side = to.perturbed->statics;
        if ((!order.decided || order.sign == 0) && is_tie(order, side.size())) {
            f = side.force(closed);
            const bool stays_zero = !f.positive() && side.chooses(); // such a force opens nothing (C1 d)
            if (!f.positive() && !stays_zero) {
                return failed(FailureKind::undecided,
                              "the new force in {} vanishes, and its first-order term is {:.6g} +- "
                              "{:.3g}: the power of the load is not proved positive at the end of the arc",
                              named(record.closed), f.value, f.radius);
            }
            record.perturbed.push_back({"force",
                                        record.closed,
                                        f,
                                        {ContactKind::disk_disk, -1, -1},
                                        {},
                                        order.exponent,
                                        order.bits,
                                        stays_zero ? TieChoice::zero : TieChoice::none});
            constexpr double chosen = std::numeric_limits<double>::infinity();
            proof.count({DecisionKind::power, stays_zero ? chosen : f.margin(), to.statics.rung(), true});
            return std::nullopt;
        }
        if (order.decided && order.sign > 0) {
            proof.count({DecisionKind::power, order.margin, order.rung});
            return std::nullopt;
        }
    }
    while ((!f.decided() || says_too_little(to.statics, f, stress, opening.moves_rattlers())) && to.statics.climb()) {
        f = force();
        record.power = f.value;
        record.power_bound = f.radius;
    }
    if (!opening.moves_rattlers() && to.statics.is_structural_zero(closed)) {
        return std::nullopt;
    }
    if (!f.positive()) {
        return failed(FailureKind::undecided,
                      "the power of the load along the arc that opens {} and closes {} is not proved "
                      "positive at its end: force {:.3g} in the new contact, proved to {:.3g}",
                      named(record.opened), named(record.closed), f.value, f.radius);
    }
    proof.count({DecisionKind::power, f.margin(), to.statics.rung()});
    return std::nullopt;
}

/// Level `arcs`: the certificate does not depend on how the arc was found, and an arc without one stays in the run.
void Prover::certify(ArcProof& proof, const Vertex& from, const Opening& opening, const Load& load) {
    const auto begin = std::chrono::steady_clock::now();
    // Fresh factors, whose passes do not count in the run; those of the end keep the order of those of the start.
    const Vertex& to = *proof.vertex;
    const std::shared_ptr<const Vertex> start = std::exchange(certified_end_, proof.vertex); // the factors refer to it
    const std::optional<Factorisation> first = start.get() == &from            ? std::exchange(factors_there_, {})
                                               : from.factorisation.is_fresh() ? from.factorisation.shared()
                                                                               : Factorisation(from.structure);
    factors_there_ =
        Factorisation::of(to.structure, first->approximate()
                                            .exchanged(static_cast<int>(opening.contact.index()), to.structure.matrix())
                                            .renewed(to.structure.matrix(), ApproximateInverse::Use::few_solves));
    const auto vertex = [](const Vertex& v, const Factorisation& factorisation) {
        return ArcVertex{v.packing, v.structure, factorisation, v.inverse, v.enclosure};
    };
    proof.record.certificate =
        certify_arc(vertex(from, *first), opening.contact, opening.direction, vertex(to, *factors_there_),
                    power_load(load, opening, proof.record.kind), candidates_, certified_bounds_);
    proof.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

EndProof Prover::prove_end(Vertex::Beginning beginning, const LimitLoad& limit, const ZeroHolds& zero,
                           const std::vector<ContactId>& zeros, long step) {
    EndProof proof;
    bounds_.forget();
    auto made = Vertex::make(std::move(beginning), limit.load, bounds_, ladder());
    if (!made.ok()) {
        proof.failure = made.failure();
        return proof;
    }
    proof.vertex = std::move(made.value());
    Vertex& vertex = *proof.vertex;
    ties_->attach(vertex, {limit.load}); // the load is again the stored one, if the forces allow it
    auto found = gaps(vertex);
    if (!found.ok()) {
        proof.failure = found.failure();
        return proof;
    }
    proof.gaps = std::move(found.value());
    if (proof.gaps.negative) {
        return proof;
    }
    proof.failure = ties_->settle_end(vertex, limit, zeros, proof.gaps.zero);
    if (proof.failure) {
        return proof;
    }
    proof.decision = ties_->settles() ? ask_again(vertex, limit.stress()) : decide(vertex, limit.stress(), zero, step);
    if (proof.decision->ok() && !proof.decision->value().opening) {
        if (!ties_->settles()) {
            (void)ask_again(vertex, limit.stress());
        }
        proof.description = describe(vertex, limit.load);
    }
    return proof;
}

Result<OpeningDecision> Prover::ask_again(Vertex& vertex, double stress) const {
    auto decision = decide_opening(vertex.statics, stress, options_->rule, {}, 0, vertex.first_order());
    if (vertex.perturbed) {
        vertex.perturbed->statics.log.clear();
        if (decision.ok()) {
            vertex.perturbed->zeros = decision.value().zeros;
        }
    }
    return decision;
}

std::optional<ArcProof> ProofChain::prove(ArcProposal& arc) {
    const auto same = [](const Opening& a, const Opening& b) {
        return a.contact == b.contact && a.direction == b.direction && a.infinitesimal == b.infinitesimal;
    };
    if (!due_ || !same(*due_, arc.opening)) {
        return std::nullopt; // it starts with another contact than the one that opens
    }
    const WorkCounts steering = arc.work;
    WorkCounts counts{};
    ArcProof proof;
    {
        const CountingIn counting(&counts);
        proof = prover_.prove(*from_, std::move(arc), *due_, at_);
    }
    proof.work = counts;
    if (!proof.agrees()) {
        refused_ = std::move(proof);
        return std::nullopt;
    }
    add(proof.work, steering);
    from_ = proof.vertex;
    due_ = proof.next->value().opening;
    return proof;
}

} // namespace isostat
