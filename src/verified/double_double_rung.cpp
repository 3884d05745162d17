#include "verified/interval_rung.hpp"
#include "verified/norm.hpp"

#include <isostat/core/work.hpp>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;

/// Normals in double-double, at the vertex in double-double when the true one is meant.
template <int Dim> class DoubleDoubleRung final : public IntervalRung<Dim> {
  public:
    DoubleDoubleRung(LadderProblem<Dim>& problem, const std::vector<double>& correction, const Place& place)
        : IntervalRung<Dim>(problem, Rung::double_double, 106), place_(place),
          matrix_(std::make_shared<const ExtendedMatrix>(
              extended_contact_matrix(problem.packing, problem.structure, correction))) {
        count_work(Work::double_double);
    }

    std::unique_ptr<ForceRung<Dim>> next() override {
        const LadderOptions& options = this->problem_.options;
        return options.first_bits > options.max_bits
                   ? nullptr
                   : multiprecision_rung(this->problem_, {matrix_, {}}, options.first_bits);
    }

  private:
    void solve(RightHandSide& part) override {
        this->problem_.solve_in_double(part, 0);
        this->problem_.solve_in_double_double(part, *matrix_);
        this->problem_.inflate(part, place_, false);
    }

    const Place& where() override { return place_; }

    Place place_;
    std::shared_ptr<const ExtendedMatrix> matrix_;
};

} // namespace

template <int Dim> std::unique_ptr<ForceRung<Dim>> double_double_rung(LadderProblem<Dim>& problem) {
    VertexEnclosure at;
    Place here;
    if (problem.vertex != nullptr) {
        at = enclose_vertex_double_double(problem.packing, problem.structure, problem.factorisation, problem.inverse);
        if (at.verdict != Verdict::proved) {
            return nullptr;
        }
        here.shift = norm_above(at.correction);
        here.away = (here.shift + at.radius) * (1 + 4 * u);
        here.uncertainty = problem.normal_rate() * (at.radius + 0x1p-90 * here.shift);
    }
    return std::make_unique<DoubleDoubleRung<Dim>>(problem, at.correction, here);
}

template std::unique_ptr<ForceRung<2>> double_double_rung<2>(LadderProblem<2>&);

} // namespace isostat
