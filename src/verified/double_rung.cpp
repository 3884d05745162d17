#include "core/roundoff.hpp"
#include "verified/interval_rung.hpp"

namespace isostat {

namespace {

using roundoff::u;

/// Normals of the stored configuration, in double.
template <int Dim> class DoubleRung final : public IntervalRung<Dim> {
  public:
    DoubleRung(LadderProblem<Dim>& problem, double accuracy)
        : IntervalRung<Dim>(problem, Rung::double_bound, 53, accuracy > 0), accuracy_(accuracy) {}

    double normal_uncertainty() override { return this->problem_.stored_distance().uncertainty; }

    std::unique_ptr<ForceRung<Dim>> next() override {
        LadderProblem<Dim>& problem = this->problem_;
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

template <int Dim> std::unique_ptr<ForceRung<Dim>> double_rung(LadderProblem<Dim>& problem, double accuracy) {
    return std::make_unique<DoubleRung<Dim>>(problem, accuracy);
}

template std::unique_ptr<ForceRung<2>> double_rung<2>(LadderProblem<2>&, double);

} // namespace isostat
