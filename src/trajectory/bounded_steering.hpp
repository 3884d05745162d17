#pragma once
/// \file
/// One arc from a proved vertex: private to the room.

#include "motion/arc.hpp"
#include "trajectory/steering.hpp"
#include "trajectory/ties/ties.hpp"

namespace isostat {

/// The arc from a vertex, with its factors or fresh ones where these serve badly, and with residuals in double-double
/// where it does not converge otherwise. A proposal that was refused is followed by another one where a remedy applies
/// (the table in bounded_steering.cpp). Failures besides those of `follow_arc`: that of `departure`; that of an end for
/// which nothing better was found; `undecided` when the order of the contacts that close is not settled in a few
/// proposals.
template <int Dim> class BoundedSteering final : public Steering<Dim> {
  public:
    /// `departure`: of the pairs that touch; none overlaps at second order. The candidates and the load must outlive
    /// the steering; the first are made anew where the arc leaves their reach.
    BoundedSteering(std::shared_ptr<const Vertex<Dim>> from, ArcStart<Dim> start, Result<Departure<Dim>> departure,
                    double step_fraction, CandidateList<Dim>& candidates);

    [[nodiscard]] bool goes_on() const override { return !proposed_; }
    Result<ArcProposal<Dim>> propose() override;
    [[nodiscard]] bool may_revise(const ArcProof<Dim>& refused) const override { return remedy(refused) != nullptr; }
    void revise(const ArcProof<Dim>& refused) override;

  private:
    struct Remedy;
    static const std::vector<Remedy>& remedies();
    /// The first that applies; null: none does.
    [[nodiscard]] const Remedy* remedy(const ArcProof<Dim>& refused) const;
    void refresh();
    Result<Arc<Dim>> attempt();
    [[nodiscard]] ArcProposal<Dim> proposal(Arc<Dim> path) const;
    void improve_end(Arc<Dim>& path) const;

    std::shared_ptr<const Vertex<Dim>> vertex_;
    const Vertex<Dim>& from_; ///< the same
    ArcStart<Dim> start_;
    CandidateList<Dim>& candidates_;
    Contact opened_;
    ArcOptions arc_options_;
    std::optional<Contact> next_to_; ///< closes on a way of length O(eps)
    Result<Departure<Dim>> departure_;
    std::optional<Factorisation> fresh_; ///< instead of the factors of the vertex
    bool precisely_ = false;             ///< the end of the arc in more digits
    std::optional<Failure> refused_;     ///< of the last end that was to be bettered, or passed by
    int proposals_ = 0;
    bool proposed_ = false;
};

extern template class BoundedSteering<2>;

} // namespace isostat
