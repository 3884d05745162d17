#pragma once
/// \file
/// Proves what steering proposes, and equilibria from nothing: private to the room.

#include "trajectory/counting.hpp"
#include "trajectory/kept_candidates.hpp"
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

/// What was found out about the end of a proposed arc.
struct ArcProof {
    ArcRecord record;
    std::vector<Decision> decisions;             ///< that were made
    std::shared_ptr<Vertex> vertex;              ///< the end; null: nothing was proved of it
    std::optional<ListExchange> list_for_end;    ///< its contacts are dependent: with this list before the arc not so
    std::optional<Contact> closed_before;        ///< the arc does not end there: this one closed first
    bool reached = false;                        ///< no gap is closed before
    std::optional<Failure> failure;              ///< what is not proved of the arc
    bool descends = false;                       ///< the potential is proved to decrease
    std::optional<Result<OpeningDecision>> next; ///< what opens at the end; none when that was not asked
    double seconds = 0;                          ///< of the certificate, at level `arcs`
    WorkCounts work{};                           ///< to be counted when it is recorded

    void count(const Decision& decision);
    /// The arc is what happens, and it is known what follows.
    [[nodiscard]] bool agrees() const { return next && next->ok(); }
    [[nodiscard]] bool turned_back() const { return record.power_turn && record.closed == record.opened; }
};

/// What was found out about a vertex as an equilibrium, as far as there was need of it.
struct EndProof {
    std::shared_ptr<Vertex> vertex;
    Vertex::Gaps gaps;
    std::optional<Failure> failure; ///< of the vertex, its gaps or its load: then nothing else is there
    std::optional<Result<OpeningDecision>> decision; ///< none: a gap is negative
    std::optional<Result<Description>> description;  ///< of an equilibrium only
    WorkCounts work{};                               ///< to be counted when it is taken
};

/// A failure of an arc or at its end, where N = N_f, as an undecided one: a rank that is not proved full may be full,
/// and an iteration that did not converge does not show that there is no vertex.
inline Failure not_proved(Failure failure) {
    if (failure.kind == FailureKind::not_isostatic || failure.kind == FailureKind::not_converged) {
        failure.kind = FailureKind::undecided;
    }
    return failure;
}

/// Owns what successive proofs leave for the next ones: candidates, which of them are contacts, bounds of the inverse.
/// Nothing else touches these, whatever thread the prover works on; one thread at a time.
class Prover {
  public:
    /// Both must outlive the prover.
    Prover(const RunOptions& options, const TieSettling& ties) : options_(&options), ties_(&ties) {}
    /// Another one, which keeps nothing of what was before.
    [[nodiscard]] Prover another() const { return {*options_, *ties_}; }

    /// Keeps nothing of what was before but a complete list of candidates at the packing, if it has that: what follows
    /// does not depend on the past, so that a resumed run goes the same way. `near`: see `find_candidates`.
    void start_at(const Packing& packing, const std::shared_ptr<const RegularTriangulation>& near = nullptr);
    /// Lent to steering that starts from the vertices of this prover, on its thread.
    [[nodiscard]] CandidateList& candidates() { return candidates_; }

    /// A vertex from nothing: full exact elimination, fresh factors and bound.
    Result<std::shared_ptr<Vertex>> vertex(Packing packing, std::vector<Contact> contacts, const LimitLoad& at);
    /// `known`: pairs that touch, as far as that is known before.
    Result<Vertex::Gaps> gaps(Vertex& vertex, const ZeroGaps& known = {}) {
        return vertex.check_gaps(candidates_, kept_, ties_->settles() ? &known : nullptr);
    }
    /// Whether the arc from a vertex, which starts with what was proved to open there, ends where it is proposed to,
    /// and what opens there: regularity, true vertex, order of the gaps, descent, power, next opening.
    ArcProof prove(const Vertex& from, ArcProposal arc, const Opening& opening, const LimitLoad& at);

    /// The same configuration with another list (C3). Failures: those of `Vertex::exchanged` and `arrive`.
    Result<std::shared_ptr<Vertex>> exchange(const Vertex& from, const ListExchange& exchange, const LimitLoad& at);

    /// Whether a vertex, proved from nothing, is an equilibrium. `limit`: that the rearrangement started from; `zeros`:
    /// forces that vanish in the base; `hold`: held just now. The list of candidates is that at the vertex.
    EndProof prove_end(Vertex::Beginning beginning, const LimitLoad& limit, const ZeroHolds& zero,
                       const std::vector<ContactId>& zeros, long step);
    /// Asks again what made a vertex an equilibrium: after a resume the statics then stand on the same rung. With first
    /// order the answer must be the same with the load that the state stores.
    Result<OpeningDecision> ask_again(Vertex& vertex, double stress) const;
    /// What opens, by the rule of the run; `step`: of the arc that led there.
    Result<OpeningDecision> decide(Vertex& vertex, double stress, const ZeroHolds& zero, long step) const;

  private:
    /// The precisions that signs may climb through. Where ties are chosen the last one is that at which a sign counts
    /// as tied: more digits would change no answer.
    [[nodiscard]] LadderOptions ladder() const;
    void certify(ArcProof& proof, const Vertex& from, const Opening& opening, const Load& load) const;
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
    KeptCandidates kept_; ///< of `candidates_`
    InverseBoundCache bounds_;
};

/// Proofs of successive arcs, each from the end of the one before. One that does not agree ends it.
class ProofChain {
  public:
    ProofChain(Prover& prover, std::shared_ptr<const Vertex> from, const Opening& opening, const LimitLoad& at)
        : prover_(prover), from_(std::move(from)), due_(opening), at_(at) {}
    /// Nothing: it does not agree.
    std::optional<ArcProof> prove(ArcProposal& arc);
    /// The proof that did not agree, if it got so far.
    [[nodiscard]] std::optional<ArcProof>& refused() { return refused_; }

  private:
    Prover& prover_;
    std::shared_ptr<const Vertex> from_;
    std::optional<Opening> due_; ///< what opens at `from_`
    const LimitLoad& at_;
    std::optional<ArcProof> refused_;
};

} // namespace isostat
