#include "trajectory/recorder.hpp"

#include "contact/words.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

void Recorder::count(const Decision& decision) {
    counters.tally.perturbed[static_cast<std::size_t>(decision.kind)] += decision.perturbed ? 1 : 0;
    counters.tally.count(decision.kind, decision.margin, decision.rung);
    margin_ = std::min(margin_, decision.margin);
    rung_ = std::max(rung_, decision.rung);
}

void Recorder::count(const ArcProof& proof) {
    for (const Decision& decision : proof.decisions) {
        count(decision);
    }
}

std::optional<Failure> Recorder::record(ArcProof& proof, int arc, double stress) {
    ArcRecord& record = proof.record;
    const long choices =
        counters.tally.choices + std::count_if(record.perturbed.begin(), record.perturbed.end(),
                                               [](const auto& tie) { return tie.choice != TieChoice::none; });
    if (choices > options.max_choices) {
        return failed(FailureKind::undecided,
                      "the arc that opens {} and closes {} rests on choice {} of the run (cap "
                      "max_choices = {})",
                      named(record.opened, proof.vertex->packing.dimension),
                      named(record.closed, proof.vertex->packing.dimension), choices, options.max_choices);
    }
    counters.tally.choices = choices;
    record.step = ++counters.steps;
    record.equilibrium = counters.equilibria;
    record.arc = arc;
    record.stress = stress;
    count(proof);
    if (record.certificate) {
        count(*record.certificate, proof.seconds);
    }
    observer.on_arc(record);
    return std::nullopt;
}

void Recorder::take_margin(EquilibriumRecord& record) {
    record.margin = std::exchange(margin_, std::numeric_limits<double>::infinity());
    record.decided_by = std::exchange(rung_, Rung::combinatorial);
}

void Recorder::count(const ArcCertificate& certificate, double seconds) {
    ArcTally& tally = counters.arcs;
    const bool proved = certificate.verdict == Verdict::proved;
    (proved ? tally.certified : tally.undecided)++;
    tally.power_undecided += proved && certificate.power != Verdict::proved ? 1 : 0;
    tally.pieces += certificate.pieces;
    tally.factorisations += certificate.factorisations;
    const auto lower = [proved](double& smallest, double margin) {
        if (proved && std::isfinite(margin) && (smallest == 0 || margin < smallest)) {
            smallest = margin;
        }
    };
    lower(tally.tube_margin, certificate.tube_margin);
    lower(tally.gap_margin, certificate.gap_margin);
    tally.seconds += seconds;
}

} // namespace isostat
