#include "core/roundoff.hpp"
#include "verified/force_rung.hpp"

namespace isostat {

namespace {

using roundoff::u;

/// Normals of the stored configuration, in double.
class DoubleRung final : public IntervalRung {
  public:
    DoubleRung(LadderProblem& problem, double accuracy)
        : IntervalRung(problem, Rung::double_bound, 53, accuracy > 0), accuracy_(accuracy) {} // exact: bits of a double

    double normal_uncertainty() override { return this->problem_.stored_distance().uncertainty; }

    std::unique_ptr<ForceRung> next() override {
        LadderProblem& problem = this->problem_;
        if (accuracy_ > 0) {
            return double_rung(problem, 0);
        }
        if (problem.inverse.verdict != Verdict::proved) {
            return nullptr;
        }
        auto rung = double_double_rung(problem);
        return rung ? std::move(rung) : multiprecision_rung(problem, problem.options.first_bits);
    }

  private:
    void solve(RightHandSide& part) override {
        this->problem_.solve_in_double(part, accuracy_);
        this->problem_.inflate(part);
    }

    double accuracy_;
};

} // namespace

std::unique_ptr<ForceRung> double_rung(LadderProblem& problem, double accuracy) {
    return std::make_unique<DoubleRung>(problem, accuracy);
}

} // namespace isostat
