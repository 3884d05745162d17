#include "trajectory/rearrangement.hpp"

#include "contact/words.hpp"
#include "trajectory/bounded_steering.hpp"
#include "trajectory/floating_steering.hpp"

#include <fmt/format.h>

#include <cmath>

namespace isostat {

namespace {

constexpr std::size_t most_exchanges = 1000; ///< exchanges of lists at one configuration

} // namespace

void CurrentVertex::move_to(std::shared_ptr<Vertex> to, const Opening& opens) {
    const ArcKind begins = kind_of(to->structure.contacts()[opens.contact.index()], opens.infinitesimal);
    *this = {std::move(to), opens, begins};
}

Rearrangement::Rearrangement(Start start, Prover& prover, Recorder& recorder)
    : prover_(prover), recorder_(recorder), at_(std::move(start.at)),
      here_{std::move(start.vertex), start.opening, start.kind},
      tilts_at_start_(here_.vertex->packing.q.begin() +
                          static_cast<std::ptrdiff_t>(here_.vertex->packing.length_at(here_.vertex->packing.axes())),
                      here_.vertex->packing.q.end()) {}

std::string Rearrangement::where(int arc) const {
    return fmt::format("arc {} of the rearrangement at sigma = {:.17g}", arc, at_.stress());
}

std::string Rearrangement::at_equilibrium() const {
    return fmt::format("equilibrium at sigma = {:.17g}", at_.stress());
}

Result<Reached> Rearrangement::run() {
    if (auto failure = follow_arcs()) {
        return *failure;
    }
    if (!end_) {
        end_ = prove_end(prover_, at_here());
    }
    count_all(end_->work);
    if (auto failure = judge(*end_)) {
        return *failure;
    }
    return Reached{std::move(*end_), arcs_};
}

/// The other rules choose by differences that floating steering does not resolve.
bool Rearrangement::floats() const {
    return !options().at_first_order() && options().rule == OpeningRule::most_negative && !here_.by_steps &&
           here_.idle.empty();
}

/// Propose, prove, record, decide, until no force is negative.
std::optional<Failure> Rearrangement::follow_arcs() {
    constexpr std::size_t window = 6; // proposals ahead of their proofs
    while (!ended_) {
        if (auto failure = cap()) {
            return failure;
        }
        if (!steering_) {
            begin_steering();
        }
        ProofChain chain(prover_, here_.vertex, here_.opening, at_);
        Proofs proofs([&](ArcProposal& arc) { return chain.prove(arc); }, ahead_ ? window : 0);
        const int before = arcs_;
        proposed_ = 0;
        steered_to_.reset();
        std::optional<Failure> failed; // why the next arc could not be proposed
        while (steering_->goes_on() && !failed && !proofs.ended() && !recorder_.stopped() &&
               before + proposed_ < options().max_arcs) {
            failed = propose(proofs);
            if (auto failure = record(proofs)) {
                return failure;
            }
        }
        Prover other = prover_.another();
        std::optional<EndProof> end;
        if (ahead_ && steered_to_ && !steered_to_->zero.fresh.valid() && !proofs.ended()) {
            end = prove_end(other, std::move(*steered_to_)); // earlier proofs may still refuse this end
        }
        proofs.finish();
        if (auto failure = record(proofs)) {
            return failure;
        }
        if (ended_ && end && arcs_ == before + proposed_) {
            prover_ = std::move(other);
            end_ = std::move(end);
        }
        ArcProof* refused = chain.refused() ? &*chain.refused() : nullptr;
        if (auto failure = act(answer(refused, !failed), refused, failed, arcs_ > before)) {
            return failure;
        }
    }
    return std::nullopt;
}

std::optional<Failure> Rearrangement::cap() const {
    if (recorder_.stopped()) {
        return failed(FailureKind::interrupted,
                      "stopped after {} arcs of a rearrangement at sigma = "
                      "{:.17g}",
                      arcs_, at_.stress());
    }
    if (arcs_ >= options().max_arcs) {
        return failed(FailureKind::cap_reached,
                      "no equilibrium after {} arcs at sigma = {:.17g}: the "
                      "sample fails here (cap max_arcs)",
                      arcs_, at_.stress());
    }
    return std::nullopt;
}

/// Begins at the current vertex, ahead of the proofs or not; the list there may be exchanged.
void Rearrangement::begin_steering() {
    ahead_ = floats();
    const long step = recorder_.counters.steps + 1;
    if (ahead_) {
        const Vertex& from = *here_.vertex;
        steering_ = std::make_unique<FloatingSteering>(
            FloatingSteering::Origin{from.packing, from.structure, from.factorisation},
            ArcStart{here_.opening, here_.kind, step, &at_.load, {}}, options(), prover_.candidates());
        return;
    }
    if (arcs_ == 0) {
        take_log(*here_.vertex, here_.settled);
    }
    auto departure = depart();
    steering_ = std::make_unique<BoundedSteering>(here_.vertex,
                                                  ArcStart{here_.opening, here_.kind, step, &at_.load, here_.settled},
                                                  std::move(departure), options().step_fraction, prover_.candidates());
}

/// What the touching pairs do, on a list with which the contact can open (C3): this may exchange the list of `here_`.
Result<Departure> Rearrangement::depart() {
    if (!here_.vertex->perturbed || here_.vertex->perturbed->touching.empty()) {
        return Departure{};
    }
    while (true) {
        auto departure = isostat::depart(*here_.vertex, here_.opening.contact, here_.opening.direction);
        if (!departure.ok() || !departure.value().overlaps) {
            return departure;
        }
        const BentPair& bent = *departure.value().overlaps;
        if (here_.settled.size() >= most_exchanges) {
            return failed(FailureKind::undecided, "{} lists were exchanged where pairs touch, and {} would overlap",
                          here_.settled.size(), named(bent.pair));
        }
        const auto exchange = give_way(*here_.vertex, here_.opening, bent, at_.stress());
        if (!exchange.ok()) {
            return exchange.failure();
        }
        if (auto failure = relist(exchange.value())) {
            return *failure;
        }
    }
}

/// Exchanges the list at the same configuration.
std::optional<Failure> Rearrangement::relist(const ListExchange& exchange) {
    auto next = prover_.exchange(*here_.vertex, exchange, at_);
    if (!next.ok()) {
        return next.failure();
    }
    here_.vertex = std::move(next.value());
    here_.settled.push_back(exchange.decision);
    return std::nullopt;
}

std::optional<Failure> Rearrangement::propose(Proofs& proofs) {
    auto arc = steering_->propose();
    if (!arc.ok()) {
        return arc.failure();
    }
    ++proposed_;
    steered_to_ = std::move(arc.value().last);
    proofs.submit(std::move(arc.value()));
    return std::nullopt;
}

std::optional<Failure> Rearrangement::record(Proofs& proofs) {
    while (!recorder_.stopped()) {
        auto proof = proofs.next();
        if (!proof) {
            break;
        }
        count_all(proof->work);
        if (auto failure = recorder_.record(*proof, ++arcs_, at_.stress())) {
            return located(*failure, where(arcs_));
        }
        if (auto failure = decide(*proof)) {
            return failure;
        }
    }
    return std::nullopt;
}

std::optional<Failure> Rearrangement::decide(ArcProof& proof) {
    const ArcRecord& record = proof.record;
    const OpeningDecision& decision = proof.next->value();
    recorder_.counters.tally.structural_ties += decision.opening && decision.opening->equal_forces ? 1 : 0;
    if (std::abs(record.strain) > options().max_strain) {
        return failed(FailureKind::cap_reached,
                      "|{}| = {:.6g} at sigma = {:.17g}: the sample fails "
                      "here (cap max_strain = {:.6g})",
                      at_.load.strain_name(), std::abs(record.strain), at_.stress(), options().max_strain);
    }
    if (auto failure = tilt_has_no_end(proof)) {
        return failure;
    }
    const ContactId held = record.power_turn ? here_.opening.contact : ContactId();
    if (decision.opening) {
        here_.move_to(proof.vertex, *decision.opening);
        here_.fresh_hold = held;
        return std::nullopt;
    }
    here_ = {.vertex = proof.vertex, .opening = here_.opening, .fresh_hold = held, .zeros = decision.zeros};
    ended_ = true;
    recorder_.count({DecisionKind::equilibrium, decision.margin, decision.rung, decision.perturbed});
    return std::nullopt;
}

/// A dead shear force may do work without bound: W has no minimum along the tilt.
std::optional<Failure> Rearrangement::tilt_has_no_end(const ArcProof& proof) const {
    const Packing& now = proof.vertex->packing;
    for (std::size_t k = now.length_at(now.axes()); k < now.q.size(); ++k) {
        const std::size_t tilt = k - now.length_at(now.axes());
        const double shear = (now.q[k] - tilts_at_start_[tilt]) / now.length(Cell::axes_of_tilt(tilt)[1]);
        if (std::abs(shear) > options().max_strain) {
            return failed(FailureKind::flows,
                          "a shear of {:.6g} after {} arcs at a constant load, sigma = {:.17g}: the tilt went from "
                          "{:.6g} to {:.6g} without an equilibrium (cap max_strain = {:.6g})",
                          std::abs(shear), arcs_, at_.stress(), tilts_at_start_[tilt], now.q[k], options().max_strain);
        }
    }
    return std::nullopt;
}

auto Rearrangement::answer(const ArcProof* refused, bool proposed) const -> Answer {
    if (ahead_) {
        return Answer::by_steps;
    }
    if (!proposed) {
        return Answer::not_proposed;
    }
    if (refused == nullptr) {
        return Answer::agreed;
    }
    if (steering_->may_revise(*refused)) {
        return Answer::revised;
    }
    if (refused->list_for_end && here_.settled.size() < most_exchanges) {
        return Answer::relisted;
    }
    if (refused->next) {
        return Answer::next_unknown;
    }
    return refused->reached && here_.kind == ArcKind::release && !refused->descends ? Answer::set_aside
                                                                                    : Answer::refused;
}

/// `any`: some arcs proposed before this one were proved.
std::optional<Failure> Rearrangement::act(Answer answer, ArcProof* refused, const std::optional<Failure>& not_proposed,
                                          bool any) {
    if (refused != nullptr) {
        count_all(refused->work);
    }
    switch (answer) {
    case Answer::agreed: steering_.reset(); return std::nullopt; // bounded steering serves one arc
    case Answer::by_steps:
        here_.by_steps = !any;
        steering_.reset();
        return std::nullopt;
    case Answer::not_proposed:
        ++recorder_.counters.steps;
        recorder_.count({DecisionKind::opening, here_.opening.margin, here_.opening.rung, here_.opening.perturbed});
        return located(not_proved(*not_proposed), where(arcs_ + 1));
    case Answer::revised: steering_->revise(*refused); return std::nullopt;
    case Answer::relisted:
        steering_.reset();
        if (auto failure = relist(*refused->list_for_end)) {
            return located(*failure, where(arcs_ + 1));
        }
        return std::nullopt;
    case Answer::next_unknown: {
        const auto over = recorder_.record(*refused, ++arcs_, at_.stress());
        return located(over.value_or(refused->next->failure()), where(arcs_));
    }
    case Answer::set_aside: recorder_.count(*refused); return set_aside(refused->record);
    case Answer::refused: break;
    }
    recorder_.count(*refused);
    ++recorder_.counters.steps;
    return located(*refused->failure, where(arcs_ + 1));
}

/// A released hold that was held again at once, or whose arc goes up, has a multiplier of 0 up to rounding, and no
/// descent. Releasing it again would repeat this without end.
std::optional<Failure> Rearrangement::set_aside(const ArcRecord& record) {
    here_.idle.push_back(here_.opening.contact);
    auto again = prover_.decide(*here_.vertex, at_.stress(), here_.zero_holds(), recorder_.counters.steps);
    if (!again.ok()) {
        return located(again.failure(), where(arcs_ + 1));
    }
    const bool free = !here_.vertex->packing.bars.empty() && !holds_what_bears(*here_.vertex);
    if (!again.value().opening && free) { // a free motion of a clump, which does no work at any held value (U2)
        here_.zeros = again.value().zeros;
        ended_ = true;
        recorder_.count({DecisionKind::equilibrium, again.value().margin, again.value().rung, again.value().perturbed});
        return std::nullopt;
    }
    if (!again.value().opening) {
        return failed(FailureKind::undecided,
                      "{}: every force is positive, and the multiplier of {} is 0 as far as the power "
                      "turn is located: whether and where it moves is not decided",
                      where(arcs_ + 1), named(record.opened));
    }
    here_.opening = *again.value().opening;
    here_.kind =
        kind_of(here_.vertex->structure.contacts()[here_.opening.contact.index()], here_.opening.infinitesimal);
    steering_.reset();
    return std::nullopt;
}

SteeredEnd Rearrangement::at_here() const {
    return {here_.vertex->packing, here_.vertex->structure.contacts(), here_.zero_holds(), {}};
}

/// The proof of the end uses no data of the arcs: full exact elimination, fresh factors and bound. A resumed run
/// therefore starts from the same bits.
EndProof Rearrangement::prove_end(Prover& prover, SteeredEnd end) {
    EndProof proof;
    WorkCounts work{};
    {
        const CountingIn counting(&work);
        Task listing([&prover, packing = end.packing, near = end.triangulation] { prover.start_at(packing, near); });
        auto begun = Vertex::begin(std::move(end.packing), std::move(end.contacts));
        listing.finish();
        if (begun.ok()) {
            proof = prover.prove_end(std::move(begun.value()), at_, end.zero, here_.zeros, recorder_.counters.steps);
        } else {
            proof.failure = begun.failure();
        }
    }
    proof.work = work;
    return proof;
}

std::optional<Failure> Rearrangement::judge(const EndProof& end) const {
    if (end.failure) {
        return located(not_proved(*end.failure), at_equilibrium());
    }
    if (end.gaps.negative) {
        return failed(FailureKind::overlap, "{}: {} overlap", at_equilibrium(), named(*end.gaps.negative));
    }
    const Result<OpeningDecision>& decision = *end.decision;
    if (decision.ok() && !decision.value().opening) {
        return std::nullopt;
    }
    return failed(FailureKind::undecided, "{}: not found again with {}{}", at_equilibrium(),
                  options().at_first_order() ? "the load as it is stored" : "fresh factors and bounds",
                  decision.ok() ? Words() : words(": {}", decision.failure()));
}

} // namespace isostat
