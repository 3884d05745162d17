#pragma once
/// \file
/// One arc from a proved vertex: private to the room.

#include "motion/arc.hpp"
#include "trajectory/steering.hpp"
#include "trajectory/vertex.hpp"

namespace isostat {

/// The arc from a vertex, with its factors or fresh ones where these serve badly. A proof that finds another contact
/// closed before, a power that is negative at the end, or nothing at all with old factors, is answered by another
/// proposal; where ties are chosen also one that finds no regular vertex with fresh factors: the pair that seemed to
/// close may only graze, and is passed by.
/// Failures besides those of `follow_arc`: `undecided` when first-order rates do not tell what happens to pairs that
/// touch at the start, or when the order of the contacts that close is not settled in a few proposals.
template <int Dim> class BoundedSteering final : public Steering<Dim> {
  public:
    /// The candidates and the load must outlive the steering; the first are made anew where the arc leaves their reach.
    BoundedSteering(std::shared_ptr<const Vertex<Dim>> from, ArcStart<Dim> start, double step_fraction,
                    CandidateList<Dim>& candidates);

    [[nodiscard]] bool goes_on() const override { return !proposed_; }
    Result<ArcProposal<Dim>> propose() override;
    bool revise(const ArcProof<Dim>& refused) override;

  private:
    std::optional<Failure> depart();
    Result<Arc<Dim>> attempt();
    ArcProposal<Dim> proposal(Arc<Dim> path) const;
    [[nodiscard]] bool went_too_far(const ArcProof<Dim>& refused) const;
    [[nodiscard]] bool may_graze(const ArcProof<Dim>& refused) const;

    std::shared_ptr<const Vertex<Dim>> vertex_;
    const Vertex<Dim>& from_; ///< the same
    ArcStart<Dim> start_;
    CandidateList<Dim>& candidates_;
    Contact opened_;
    ArcOptions arc_options_;
    std::optional<Contact> next_to_;     ///< closes on a way of length O(eps)
    std::vector<TieDecision> departure_; ///< what was settled there
    std::vector<Contact> resting_;       ///< pairs that touch all along
    std::optional<Factorisation> fresh_; ///< instead of the factors of the vertex
    int proposals_ = 0;
    bool proposed_ = false;
};

extern template class BoundedSteering<2>;

} // namespace isostat
