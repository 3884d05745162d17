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

/// Arc after arc from a vertex whose opening is given, until no force is negative. Forces, events and the choice of the
/// opening contact are computed in refined double precision. Failures besides those of `follow_arc`: `undecided` when
/// the new contact of an arc carries no compression, or W grew. Cost: about 12 triangular solves per arc, and new
/// factors every 20 arcs at n = 1936, every 40 at 4900.
class FloatingSteering final : public Steering {
  public:
    /// The start of the steering. Must outlive its first arc.
    struct Origin {
        const Packing& packing;
        const IsostaticStructure& structure;
        const Factorisation& factorisation;
    };
    /// The load and the options must outlive the steering.
    FloatingSteering(const Origin& from, const ArcStart& start, const RunOptions& options, CandidateList candidates);

    [[nodiscard]] bool goes_on() const override { return !ended_; }
    Result<ArcProposal> propose() override;

  private:
    /// Data at the start of an arc: the cost of its forces, its predicted end, and the vertex predicted there.
    struct Prediction {
        int passes = 0;
        std::optional<ArcDeparture::Expected> end;
        Future<PredictedVertex> vertex; ///< refers to `end`, and to the vertex at the start
    };
    Result<ArcProposal> next();
    Result<Arc> follow(Prediction& prediction);
    [[nodiscard]] std::optional<Failure> check_work(const ArcRecord& record, const Arc& path) const;
    [[nodiscard]] std::optional<Failure> arrive(ArcProposal& arc, Arc& path, Prediction& prediction);
    [[nodiscard]] ApproximateInverse operator_at(const ExchangedContacts& next, int passes);
    [[nodiscard]] std::optional<Failure> check_power(const ArcRecord& record) const;
    void choose(ArcProposal& arc);

    const Packing* packing_;
    const IsostaticStructure* structure_;
    const Factorisation* factorisation_;
    ArcStart start_; ///< start of the next arc
    const Load& load_;
    CandidateList candidates_;
    ArcOptions arc_options_;
    bool ended_ = false;
    RefactorisationRule rule_;
    Refactorisation refactorisation_;
    std::unique_ptr<FloatingVertex> here_; ///< null: at the start. Declared last because it uses the other members
};

} // namespace isostat
