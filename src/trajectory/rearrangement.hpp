#pragma once
/// \file
/// From an equilibrium at its limit to the next one: private to the room.

#include "trajectory/pipeline.hpp"
#include "trajectory/prover.hpp"
#include "trajectory/recorder.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// Where a rearrangement ended: an equilibrium, proved from nothing that the way to it left.
struct Reached {
    EndProof proof;
    int arcs = 0;
};

/// Where a rearrangement stands, and what is known there.
struct Standing {
    std::shared_ptr<Vertex> vertex; ///< the last one that was proved
    Opening opening;                ///< what opens there
    ArcKind kind = ArcKind::limit;  ///< of the arc that it begins
    /// Why this one opens, and lists that were exchanged. Recorded with the arc.
    std::vector<TieDecision> settled{};
    ContactId fresh_hold{};           ///< of the power turn that ended there
    std::vector<ContactId> resting{}; ///< holds whose multipliers are 0 as far as their turns are located
    std::vector<ContactId> zeros{};   ///< forces of an equilibrium that vanish in the base
    bool by_steps = false;            ///< the next arc must be proved before going on

    [[nodiscard]] ZeroHolds zero_holds() const;
    /// To what opens at `vertex`, of which nothing else is known.
    void move_to(std::shared_ptr<Vertex> to, const Opening& opens);
};

/// One rearrangement under a constant load (paper, section 2.3): a contact opens, the grains move until another one
/// closes, and the contact with the largest traction opens next, until there is none. Every arc is *proposed* by a
/// steering, *proved*, *recorded*, and its end *decides* what opens. Floating steering goes ahead of the proofs, by a
/// window; where one does not agree the arc is proposed again by bounded steering, window 0. With first-order ties, and
/// by rules whose choice steering does not resolve, bounded steering proposes every arc.
class Rearrangement {
  public:
    struct Start {
        std::shared_ptr<Vertex> vertex;
        Opening opening;
        ArcKind kind = ArcKind::limit; ///< of the first arc
        LimitLoad at;
    };
    /// All must outlive the rearrangement.
    Rearrangement(Start start, Prover& prover, Recorder& recorder);

    /// Once.
    Result<Reached> run();
    /// Recorded so far.
    [[nodiscard]] int arcs() const { return arcs_; }

  private:
    [[nodiscard]] const RunOptions& options() const { return recorder_.options; }
    [[nodiscard]] bool floats() const;
    std::optional<Failure> follow_arcs();
    [[nodiscard]] std::optional<Failure> cap() const;
    void begin_steering();
    Result<Departure> depart();
    std::optional<Failure> relist(const ListExchange& exchange);
    using Proofs = Pipeline<ArcProposal, ArcProof>;
    std::optional<Failure> propose(Proofs& proofs);
    std::optional<Failure> record(Proofs& proofs);
    std::optional<Failure> decide(ArcProof& proof);
    [[nodiscard]] std::optional<Failure> flows(const ArcProof& proof) const;
    /// What becomes of the last arc that was proposed.
    enum class Answer {
        agreed,       ///< it is recorded: the next one begins at its end
        by_steps,     ///< proposed ahead, in vain: it is proposed again, proved before anything follows
        not_proposed, ///< the rearrangement ends: the arc was not followed to an end
        revised,      ///< another proposal for the same arc
        relisted,     ///< another list at its start, with which its end may be regular
        next_unknown, ///< the rearrangement ends after it: what opens there is not decided
        set_aside,    ///< a held coordinate that was released stays, and another opens
        refused       ///< the rearrangement ends: it is not proved
    };
    [[nodiscard]] Answer answer(const ArcProof* refused, bool proposed) const;
    std::optional<Failure> act(Answer answer, ArcProof* refused, const std::optional<Failure>& not_proposed, bool any);
    std::optional<Failure> set_aside(const ArcRecord& record);
    [[nodiscard]] SteeredEnd at_here() const;
    EndProof prove_end(Prover& prover, SteeredEnd end);
    [[nodiscard]] std::optional<Failure> judge(const EndProof& end) const;
    [[nodiscard]] std::string where(int arc) const;
    [[nodiscard]] std::string at_equilibrium() const;

    Prover& prover_;
    Recorder& recorder_;
    LimitLoad at_;
    Standing here_;
    std::vector<double> tilts_at_start_;
    int arcs_ = 0;
    bool ended_ = false;                   ///< no force is negative where it is
    bool ahead_ = false;                   ///< the steering goes ahead of the proofs
    int proposed_ = 0;                     ///< arcs by it
    std::unique_ptr<Steering> steering_;   ///< refers to `here_.vertex`
    std::optional<SteeredEnd> steered_to_; ///< by `steering_`, if it came to an end
    std::optional<EndProof> end_;
};

} // namespace isostat
