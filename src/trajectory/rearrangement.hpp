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

/// Where a rearrangement ended: an equilibrium, proved without data of the arcs that led to it.
struct Reached {
    EndProof proof;
    int arcs = 0;
};

/// The current vertex of a rearrangement, and what is known there.
struct CurrentVertex {
    std::shared_ptr<Vertex> vertex; ///< last proved vertex
    Opening opening;                ///< what opens at `vertex`
    ArcKind kind = ArcKind::limit;  ///< kind of the arc that this opening begins
    /// Why this contact opens, and lists that were exchanged. Recorded with the arc.
    std::vector<TieDecision> settled{};
    ContactId fresh_hold{};         ///< held since the power turn that ended at `vertex`
    std::vector<ContactId> idle{};  ///< holds with multiplier 0, up to the uncertainty of the place of their turns
    std::vector<ContactId> zeros{}; ///< forces of an equilibrium that vanish in the base
    bool by_steps = false;          ///< the next arc must be proved before another one is proposed

    [[nodiscard]] ZeroHolds zero_holds() const { return {fresh_hold, idle}; }
    /// Moves to `to`, where `opens` opens, and forgets what was known of the previous vertex.
    void move_to(std::shared_ptr<Vertex> to, const Opening& opens);
};

/// One rearrangement under a constant load (paper, section 2.3): a contact opens, the grains move until another one
/// closes, and the contact with the largest traction opens next, until no contact is in traction. Every arc is
/// *proposed* by a steering, *proved*, *recorded*, and what opens at its end is *decided*. Floating steering goes ahead
/// of the proofs by a window; an arc that is not proved is proposed again by bounded steering, window 0. With
/// first-order ties, and by rules that floating steering cannot resolve, bounded steering proposes every arc.
class Rearrangement {
  public:
    struct Start {
        std::shared_ptr<Vertex> vertex;
        Opening opening;
        ArcKind kind = ArcKind::limit; ///< kind of the first arc
        LimitLoad at;
    };
    /// All arguments must outlive the rearrangement.
    Rearrangement(Start start, Prover& prover, Recorder& recorder);

    /// To be called once.
    Result<Reached> run();
    /// Number of arcs recorded so far.
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
    [[nodiscard]] std::optional<Failure> tilt_has_no_end(const ArcProof& proof) const;
    /// What happens after the last proposed arc was judged.
    enum class Answer {
        agreed,       ///< the arc is recorded: the next one begins at its end
        by_steps,     ///< an arc proposed ahead is not proved: bounded steering proposes it again
        not_proposed, ///< the rearrangement ends: the arc could not be followed to its end
        revised,      ///< another proposal for the same arc
        relisted,     ///< another list at the start of the arc, with which its end may be regular
        next_unknown, ///< the arc is recorded and the rearrangement ends: what opens next is undecided
        set_aside,    ///< a released coordinate is held again, and another contact opens
        refused       ///< the rearrangement ends: the arc is not proved
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
    CurrentVertex here_;
    std::vector<double> tilts_at_start_;
    int arcs_ = 0;
    bool ended_ = false;                   ///< no force is negative at `here_`
    bool ahead_ = false;                   ///< `steering_` goes ahead of the proofs
    int proposed_ = 0;                     ///< number of arcs that `steering_` proposed
    std::unique_ptr<Steering> steering_;   ///< uses `here_.vertex`
    std::optional<SteeredEnd> steered_to_; ///< where `steering_` found no negative force
    std::optional<EndProof> end_;
};

} // namespace isostat
