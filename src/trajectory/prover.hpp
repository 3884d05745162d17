#pragma once
/// \file
/// Proves what steering proposes, and equilibria without data of earlier proofs: private to the room.

#include "trajectory/counting.hpp"
#include "trajectory/record.hpp"
#include "trajectory/steering.hpp"
#include "trajectory/ties/second_order.hpp"
#include "trajectory/ties/settling.hpp"
#include "trajectory/ties/ties.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// One decision, for the tally.
struct Decision {
    DecisionKind kind;
    double margin;
    Rung rung;
    bool perturbed = false;
};

/// What was proved about the end of a proposed arc.
struct ArcProof {
    ArcRecord record;
    std::vector<Decision> decisions;             ///< decisions that were made
    std::shared_ptr<Vertex> vertex;              ///< vertex at the end; null: nothing was proved of the end
    std::optional<ListExchange> list_for_end;    ///< contacts at the end are dependent, but not with this list
    std::optional<Contact> closed_before;        ///< contact that closed before the proposed end
    bool reached = false;                        ///< no gap closed before the proposed end
    std::optional<Failure> failure;              ///< what could not be proved of the arc
    bool descends = false;                       ///< the potential is proved to decrease
    std::optional<Result<OpeningDecision>> next; ///< what opens at the end; absent when this was not reached
    double seconds = 0;                          ///< time of the certificate, at level `arcs`
    WorkCounts work{};                           ///< counted when the arc is recorded

    void count(const Decision& decision);
    /// The proposed arc is proved, and so is what opens at its end.
    [[nodiscard]] bool agrees() const { return next && next->ok(); }
    [[nodiscard]] bool turned_back() const { return record.power_turn && record.closed == record.opened; }
};

/// What was proved of a vertex as an equilibrium, as far as the answer needed it.
struct EndProof {
    std::shared_ptr<Vertex> vertex;
    Vertex::Gaps gaps;
    std::optional<Failure> failure; ///< of the vertex, its gaps or its load: then the other fields are empty
    std::optional<Result<OpeningDecision>> decision; ///< absent: a gap is negative
    std::optional<Result<Description>> description;  ///< filled for an equilibrium only
    WorkCounts work{};                               ///< counted when the equilibrium is accepted
};

/// A failure of an arc or at its end, where N = N_f, turned into an undecided one, because a rank that is not proved
/// full may be full, and an iteration that did not converge does not refute a vertex.
inline Failure not_proved(Failure failure) {
    if (failure.kind == FailureKind::not_isostatic || failure.kind == FailureKind::not_converged) {
        failure.kind = FailureKind::undecided;
    }
    return failure;
}

/// Owns the data that successive proofs share: candidates, flags of those that are contacts, bounds of the inverse. No
/// other object uses these, whatever thread the prover works on; only one thread at a time may use a prover.
class Prover {
  public:
    /// Both must outlive the prover.
    Prover(const RunOptions& options, const TieSettling& ties) : options_(&options), ties_(&ties) {}
    /// A prover with the same options that shares no data with this one.
    [[nodiscard]] Prover another() const { return {*options_, *ties_}; }

    /// Drops the data of earlier arcs except a list of candidates that is complete at the packing, so that what follows
    /// does not depend on the past and a resumed run goes the same way: what the last proof without earlier data left
    /// for the next bound of the inverse stays, because a resumed run has made that proof too. `near`: see
    /// `find_candidates`.
    void start_at(const Packing& packing, const std::shared_ptr<const RegularTriangulation>& near = nullptr);
    /// The list for steering that starts from the vertices of this prover and runs on its thread.
    [[nodiscard]] CandidateList& candidates() { return candidates_; }

    /// A vertex without data of earlier proofs: full exact elimination, fresh factors and bound.
    Result<std::shared_ptr<Vertex>> vertex(Packing packing, std::vector<Contact> contacts, const LimitLoad& at);
    /// `known`: pairs that are already known to touch.
    Result<Vertex::Gaps> gaps(Vertex& vertex, const ZeroGaps& known = {}) {
        return vertex.check_gaps(candidates_, kept_, ties_->settles() ? &known : nullptr);
    }
    /// Whether the arc from a vertex, along the motion that `opening` begins, ends where it is proposed to end, and
    /// what opens there: regularity, true vertex, order of the gaps, descent, power, next opening.
    ArcProof prove(const Vertex& from, ArcProposal arc, const Opening& opening, const LimitLoad& at);

    /// The same configuration with another list of contacts (C3). Failures: those of `Vertex::exchanged` and `arrive`.
    Result<std::shared_ptr<Vertex>> exchange(const Vertex& from, const ListExchange& exchange, const LimitLoad& at);

    /// Whether a vertex, proved without earlier data, is an equilibrium. `limit`: start of the rearrangement; `zeros`:
    /// forces that vanish in the base; `zero`: holds with multiplier 0. The list of candidates is that at the vertex.
    EndProof prove_end(Vertex::Beginning beginning, const LimitLoad& limit, const ZeroHolds& zero,
                       const std::vector<ContactId>& zeros, long step);
    /// Repeats the decision that made a vertex an equilibrium: after a resume the statics are then on the same rung as
    /// before. With first order the answer must be the same with the load that the state stores.
    Result<OpeningDecision> ask_again(Vertex& vertex, double stress) const;
    /// What opens, by the rule of the run; `step`: number of the arc that led there.
    Result<OpeningDecision> decide(Vertex& vertex, double stress, const ZeroHolds& zero, long step) const;

  private:
    /// The precisions that a sign may climb through. Where ties are chosen, the last precision is the one at which a
    /// sign counts as tied, because more digits would change no answer.
    [[nodiscard]] LadderOptions ladder() const;
    void certify(ArcProof& proof, const Vertex& from, const Opening& opening, const Load& load);
    std::optional<Failure> reach(ArcProof& proof, const Vertex& from, ArcProposal& arc, const LimitLoad& at);
    std::optional<Failure> arrive(ArcProof& proof, std::vector<TieDecision> settled, const Way& way,
                                  const Vertex::Gaps& gaps) const;
    static std::optional<Failure> descend(ArcProof& proof, const Vertex& from, const Opening& opening,
                                          const Load& load);
    static std::optional<Failure> work_of_load(const ArcProof& proof, const Opening& opening, double stress);
    static std::optional<Failure> power(ArcProof& proof, const Opening& opening, double stress);

    const RunOptions* options_;
    const TieSettling* ties_;
    CandidateList candidates_;
    KeptCandidates kept_; ///< flags of `candidates_`
    InverseBoundCache bounds_;
    InverseBoundCache certified_bounds_; ///< of the centres on certified arcs
    /// The end of the last certified arc, where the next one mostly starts, with new factors.
    std::shared_ptr<const Vertex> certified_end_;
    std::optional<Factorisation> factors_there_;
};

/// Proofs of successive arcs, each from the end of the previous arc. The first arc that is not proved ends the chain.
class ProofChain {
  public:
    ProofChain(Prover& prover, std::shared_ptr<const Vertex> from, const Opening& opening, const LimitLoad& at)
        : prover_(prover), from_(std::move(from)), due_(opening), at_(at) {}
    /// Empty when the arc is not proved.
    std::optional<ArcProof> prove(ArcProposal& arc);
    /// The proof of the arc that ended the chain, as far as it went.
    [[nodiscard]] std::optional<ArcProof>& refused() { return refused_; }

  private:
    Prover& prover_;
    std::shared_ptr<const Vertex> from_;
    std::optional<Opening> due_; ///< what opens at `from_`
    const LimitLoad& at_;
    std::optional<ArcProof> refused_;
};

} // namespace isostat
