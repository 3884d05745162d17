#pragma once
/// \file
/// One arc from a proved vertex: private to the room.

#include "motion/arc.hpp"
#include "trajectory/steering.hpp"
#include "trajectory/ties/ties.hpp"

namespace isostat {

/// The arc from a vertex, with the factors of the vertex, or with fresh ones where iterations with the former converge
/// slowly, and with residuals in double-double where the iteration does not converge otherwise. Another proposal
/// follows a refused one when a remedy of the table in bounded_steering.cpp applies. Failures besides those of
/// `follow_arc`: that of `departure`; that of a refused end to which no remedy applies; `undecided` when several
/// proposals leave the order of the closing contacts open.
class BoundedSteering final : public Steering {
  public:
    /// `departure`: what the touching pairs do; none of them overlaps at second order. The candidates and the load must
    /// outlive the steering; the candidates are made anew where the arc leaves their reach.
    BoundedSteering(std::shared_ptr<const Vertex> from, ArcStart start, Result<Departure> departure,
                    double step_fraction, CandidateList& candidates);

    [[nodiscard]] bool goes_on() const override { return !proposed_; }
    Result<ArcProposal> propose() override;
    [[nodiscard]] bool may_revise(const ArcProof& refused) const override { return remedy(refused) != nullptr; }
    void revise(const ArcProof& refused) override;

  private:
    struct Remedy;
    static const std::vector<Remedy>& remedies();
    /// The first remedy that applies; null: no remedy does.
    [[nodiscard]] const Remedy* remedy(const ArcProof& refused) const;
    void refresh();
    Result<Arc> attempt();
    [[nodiscard]] ArcProposal proposal(Arc path) const;
    void improve_end(Arc& path) const;

    std::shared_ptr<const Vertex> vertex_;
    const Vertex& from_; ///< the same vertex
    ArcStart start_;
    CandidateList& candidates_;
    Contact opened_;
    ArcOptions arc_options_;
    std::optional<Contact> next_to_; ///< contact that closes on a path of length O(eps)
    Result<Departure> departure_;
    std::optional<Factorisation> fresh_; ///< replaces the factors of the vertex
    bool precisely_ = false;             ///< more digits at the end of the arc
    std::optional<Failure> refused_;     ///< failure of the last end that a remedy was for
    int proposals_ = 0;
    bool proposed_ = false;
};

} // namespace isostat
