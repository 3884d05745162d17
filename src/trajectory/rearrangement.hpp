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
template <int Dim> struct Reached {
    EndProof<Dim> proof;
    int arcs = 0;
};

/// Where a rearrangement stands, and what is known there.
template <int Dim> struct Standing {
    std::shared_ptr<Vertex<Dim>> vertex; ///< the last one that was proved
    Opening opening;                     ///< what opens there
    ArcKind kind = ArcKind::limit;       ///< of the arc that it begins
    /// Why this one opens, and lists that were exchanged. Recorded with the arc.
    std::vector<TieDecision> settled{};
    ContactId fresh_hold{};           ///< of the power turn that ended there
    std::vector<ContactId> resting{}; ///< holds whose multipliers are 0 as far as their turns are located
    std::vector<ContactId> zeros{};   ///< forces of an equilibrium that vanish in the base
    bool by_steps = false;            ///< the next arc must be proved before going on

    /// To what opens at `vertex`, of which nothing else is known.
    void move_to(std::shared_ptr<Vertex<Dim>> to, const Opening& opens);
};

/// One rearrangement under a constant load (paper, section 2.3): a contact opens, the grains move until another one
/// closes, and the contact with the largest traction opens next, until there is none. Every arc is *proposed* by a
/// steering, *proved*, *recorded*, and its end *decides* what opens. Floating steering goes ahead of the proofs, by a
/// window; where one does not agree the arc is proposed again by bounded steering, window 0. With first-order ties, and
/// by rules whose choice steering does not resolve, bounded steering proposes every arc.
template <int Dim> class Rearrangement {
  public:
    struct Start {
        std::shared_ptr<Vertex<Dim>> vertex;
        Opening opening;
        ArcKind kind = ArcKind::limit; ///< of the first arc
        LimitLoad<Dim> at;
    };
    /// All must outlive the rearrangement.
    Rearrangement(Start start, Prover<Dim>& prover, Recorder<Dim>& recorder);

    /// Once.
    Result<Reached<Dim>> run();
    /// Recorded so far.
    [[nodiscard]] int arcs() const { return arcs_; }

  private:
    [[nodiscard]] const RunOptions& options() const { return recorder_.options; }
    [[nodiscard]] bool floats() const;
    std::optional<Failure> follow_arcs();
    [[nodiscard]] std::optional<Failure> cap() const;
    void begin_steering();
    Result<Departure<Dim>> depart();
    std::optional<Failure> relist(const ListExchange& exchange);
    using Proofs = Pipeline<ArcProposal<Dim>, ArcProof<Dim>>;
    std::optional<Failure> propose(Proofs& proofs);
    std::optional<Failure> record(Proofs& proofs);
    std::optional<Failure> decide(ArcProof<Dim>& proof);
    [[nodiscard]] std::optional<Failure> flows(const ArcProof<Dim>& proof) const;
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
    [[nodiscard]] Answer answer(const ArcProof<Dim>* refused, bool proposed) const;
    std::optional<Failure> act(Answer answer, ArcProof<Dim>* refused, const std::optional<Failure>& not_proposed,
                               bool any);
    std::optional<Failure> set_aside(const ArcRecord<Dim>& record);
    [[nodiscard]] SteeredEnd<Dim> at_here() const;
    EndProof<Dim> prove_end(Prover<Dim>& prover, SteeredEnd<Dim> end);
    [[nodiscard]] std::optional<Failure> judge(const EndProof<Dim>& end) const;
    [[nodiscard]] std::string where(int arc) const;
    [[nodiscard]] std::string at_equilibrium() const;

    Prover<Dim>& prover_;
    Recorder<Dim>& recorder_;
    LimitLoad<Dim> at_;
    Standing<Dim> here_;
    std::vector<double> tilts_at_start_;
    int arcs_ = 0;
    bool ended_ = false;                        ///< no force is negative where it is
    bool ahead_ = false;                        ///< the steering goes ahead of the proofs
    int proposed_ = 0;                          ///< arcs by it
    std::unique_ptr<Steering<Dim>> steering_;   ///< refers to `here_.vertex`
    std::optional<SteeredEnd<Dim>> steered_to_; ///< by `steering_`, if it came to an end
    std::optional<EndProof<Dim>> end_;
};

extern template struct Standing<2>;
extern template class Rearrangement<2>;

} // namespace isostat
