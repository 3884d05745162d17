#pragma once
/// \file
/// Arc after arc without proof: private to the room.

#include "motion/arc.hpp"
#include "trajectory/floating_vertex.hpp"
#include "trajectory/refactorisation.hpp"
#include "trajectory/steering.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <memory>
#include <optional>

namespace isostat {

/// A random number for each step of a run, the same after a resume.
std::uint64_t bits_for(std::uint64_t seed, long step);

/// Arc after arc from a vertex whose opening is given, until no force is negative. Forces, events and the choice of
/// what opens are those of refined double precision. Failures besides those of `follow_arc`: `undecided` when the new
/// contact of an arc carries no compression, or W grew. Cost: 12 triangular solves or so per arc, and new factors every
/// 20 arcs at n = 1936, every 40 at 4900.
template <int Dim> class FloatingSteering final : public Steering<Dim> {
  public:
    /// Where it starts. Must outlive its first arc.
    struct Origin {
        const Packing<Dim>& packing;
        const IsostaticStructure<Dim>& structure;
        const Factorisation& factorisation;
    };
    /// The load and the options must outlive the steering.
    FloatingSteering(const Origin& from, const ArcStart<Dim>& start, const RunOptions& options,
                     CandidateList<Dim> candidates);

    [[nodiscard]] bool goes_on() const override { return !ended_; }
    Result<ArcProposal<Dim>> propose() override;

  private:
    /// What is known at the start of an arc: what its forces cost, and its end as predicted, with the vertex there.
    struct Prediction {
        int passes = 0;
        std::optional<typename ArcDeparture<Dim>::Expected> end;
        Future<PredictedVertex<Dim>> vertex; ///< refers to `end`, and to the vertex at the start
    };
    Result<ArcProposal<Dim>> next();
    Result<Arc<Dim>> follow(Prediction& prediction);
    [[nodiscard]] std::optional<Failure> check_work(const ArcRecord<Dim>& record, const Arc<Dim>& path) const;
    [[nodiscard]] std::optional<Failure> arrive(ArcProposal<Dim>& arc, Arc<Dim>& path, Prediction& prediction);
    [[nodiscard]] ApproximateInverse operator_at(const ExchangedContacts<Dim>& next, int passes);
    [[nodiscard]] std::optional<Failure> check_power(const ArcRecord<Dim>& record) const;
    void choose(ArcProposal<Dim>& arc);

    const Packing<Dim>* packing_;
    const IsostaticStructure<Dim>* structure_;
    const Factorisation* factorisation_;
    ArcStart<Dim> start_; ///< of the next arc
    const Load<Dim>& load_;
    CandidateList<Dim> candidates_;
    ArcOptions arc_options_;
    bool ended_ = false;
    RefactorisationRule rule_;
    Refactorisation refactorisation_;
    std::unique_ptr<FloatingVertex<Dim>> here_; ///< null: at the start. Last: it uses the rest
};

extern template class FloatingSteering<2>;

} // namespace isostat
