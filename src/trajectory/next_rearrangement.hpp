#pragma once
/// \file
/// A rearrangement begun before the equilibrium that it starts from is proved: private to the room.

#include "trajectory/counting.hpp"
#include "trajectory/first_order_side.hpp"
#include "trajectory/floating_steering.hpp"
#include "trajectory/vertex.hpp"

#include <functional>
#include <memory>

namespace isostat {

/// What follows an equilibrium, as forces in plain double precision tell: whoever proves the limit throws it away when
/// another contact opens, or at another load. Owns copies of all that it uses, so that the proof can go on beside it.
template <int Dim> class NextRearrangement final : public Steering<Dim> {
  public:
    /// `candidates`: at the vertex. \pre its factors are fresh
    NextRearrangement(const typename Vertex<Dim>::Beginning& from, CandidateList<Dim> candidates)
        : packing_(from.packing), structure_(from.rank.unproved()), factorisation_(from.factorisation.fresh_copy()),
          candidates_(std::move(candidates)) {}

    /// The limit beyond this load, in the direction of the segment; `step`: of the first arc. False: there is none to
    /// follow.
    bool begin(const Load<Dim>& load, const Segment& segment, const RunOptions& options, long step);
    /// Proposes arcs until `enough`. \pre begin
    void propose_ahead(const std::function<bool()>& enough);
    /// Whether this is what follows.
    [[nodiscard]] bool starts_with(ContactId opens, const LimitLoad<Dim>& at) const {
        return opens_ == opens && at_.stress() == at.stress();
    }
    /// It is: what the proposals so far cost is counted now.
    void count_work() const { count_all(work_); }

    [[nodiscard]] bool goes_on() const override { return steering_->goes_on(); }
    Result<ArcProposal<Dim>> propose() override { return steering_->propose(); }
    bool revise(const ArcProof<Dim>& /*refused*/) override { return false; }

  private:
    Packing<Dim> packing_;
    IsostaticStructure<Dim> structure_; ///< of which nothing is proved
    Factorisation factorisation_;
    CandidateList<Dim> candidates_;
    ContactId opens_;
    LimitLoad<Dim> at_;
    std::unique_ptr<FloatingSteering<Dim>> steering_;
    WorkCounts work_{};
};

extern template class NextRearrangement<2>;

} // namespace isostat
