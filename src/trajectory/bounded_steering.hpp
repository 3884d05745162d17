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
class BoundedSteering final : public Steering {
  public:
    /// `departure`: of the pairs that touch; none overlaps at second order. The candidates and the load must outlive
    /// the steering; the first are made anew where the arc leaves their reach.
    BoundedSteering(std::shared_ptr<const Vertex> from, ArcStart start, Result<Departure> departure,
                    double step_fraction, CandidateList& candidates);

    [[nodiscard]] bool goes_on() const override { return !proposed_; }
    Result<ArcProposal> propose() override;
    [[nodiscard]] bool may_revise(const ArcProof& refused) const override { return remedy(refused) != nullptr; }
    void revise(const ArcProof& refused) override;

  private:
    struct Remedy;
    static const std::vector<Remedy>& remedies();
    /// The first that applies; null: none does.
    [[nodiscard]] const Remedy* remedy(const ArcProof& refused) const;
    void refresh();
    Result<Arc> attempt();
    [[nodiscard]] ArcProposal proposal(Arc path) const;
    void improve_end(Arc& path) const;

    std::shared_ptr<const Vertex> vertex_;
    const Vertex& from_; ///< the same
    ArcStart start_;
    CandidateList& candidates_;
    Contact opened_;
    ArcOptions arc_options_;
    std::optional<Contact> next_to_; ///< closes on a way of length O(eps)
    Result<Departure> departure_;
    std::optional<Factorisation> fresh_; ///< instead of the factors of the vertex
    bool precisely_ = false;             ///< the end of the arc in more digits
    std::optional<Failure> refused_;     ///< of the last end that was to be bettered, or passed by
    int proposals_ = 0;
    bool proposed_ = false;
};

} // namespace isostat
