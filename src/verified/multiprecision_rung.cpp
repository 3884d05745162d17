#include "verified/interval_rung.hpp"
#include "verified/refined_vertex.hpp"

#include <isostat/core/work.hpp>

#include <algorithm>
#include <limits>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;

Real sum_of(double a, double b) {
    Real sum(128);
    mpfr_set_d(sum.get(), a, MPFR_RNDN);
    mpfr_add_d(sum.get(), sum.get(), b, MPFR_RNDN);
    return sum;
}

/// The right-hand side, its products exact.
std::vector<Real> exact_force(const RightHandSide& part) {
    std::vector<Real> force;
    force.reserve(part.force.size());
    for (const double f : part.force) {
        force.emplace_back(f, 53);
    }
    for (const ExactProduct& product : part.terms.products) {
        Real exact(128);
        mpfr_set_d(exact.get(), -product.a, MPFR_RNDN);
        mpfr_mul_d(exact.get(), exact.get(), product.b, MPFR_RNDN); // 106 bits
        force[static_cast<std::size_t>(product.row)] = std::move(exact);
    }
    return force;
}

/// The system in MPFR, at the vertex to as many bits when the true one is meant.
template <int Dim> class MultiprecisionRung final : public IntervalRung<Dim> {
  public:
    MultiprecisionRung(LadderProblem<Dim>& problem, MultiprecisionStart start, const Place& place, double sigma,
                       Real uncertainty, int bits)
        : IntervalRung<Dim>(problem, Rung::multiprecision, bits), start_(std::move(start)), place_(place),
          system_(problem.structure, start_.coordinate, problem.factorisation, sigma, std::move(uncertainty), bits) {
        count_work(Work::multiprecision);
    }

    std::unique_ptr<ForceRung<Dim>> next() override {
        return 2 * this->bits() > this->problem_.options.max_bits || !converged()
                   ? nullptr
                   : multiprecision_rung(this->problem_, start_, 2 * this->bits());
    }

    [[nodiscard]] Real digits(const RightHandSide& part, ContactId contact, int bits) const override {
        Real value(bits);
        mpfr_set(value.get(), part.refined.value[contact.index()].get(), MPFR_RNDN);
        return value;
    }

    [[nodiscard]] double bound_exponent(const RightHandSide& part) const override {
        Real logarithm(64);
        mpfr_log2(logarithm.get(), part.refined.bound.get(), MPFR_RNDU);
        return logarithm.above();
    }

  private:
    void solve(RightHandSide& part) override;
    [[nodiscard]] PreciseInterval enclosed(const RightHandSide& part, std::size_t l) const override {
        return {part.refined.value[l], part.refined.bound, this->bits() + 32};
    }
    const Place& where() override { return place_; }
    [[nodiscard]] const RefinedSystem<Dim>* system() const override { return &system_; }
    /// The bits were used: more of them will tell more.
    [[nodiscard]] bool converged() const;

    MultiprecisionStart start_;
    Place place_;
    RefinedSystem<Dim> system_;
};

template <int Dim> void MultiprecisionRung<Dim>::solve(RightHandSide& part) {
    ForceSolution& s = part.solution;
    this->problem_.solve_in_double(part, 0);
    if (start_.matrix) {
        this->problem_.solve_in_double_double(part, *start_.matrix);
    }
    const std::size_t n = part.force.size();
    std::vector<Real> guess = part.refined.value;
    if (guess.size() != n) {
        guess.clear();
        for (std::size_t l = 0; l < n; ++l) {
            guess.push_back(sum_of(s.value[l], s.low.empty() ? 0.0 : s.low[l]));
        }
    }
    const double rate = part.terms.rate;
    const Real error(rate == 0 ? 0 : rate * place_.away * (1 + 4 * u), 64);
    part.refined = system_.solve(exact_force(part), guess, false, error);
    if (part.refined.value.size() == n) {
        round_to_pairs(part.refined.value, part.refined.bound, s);
        s.residual = part.refined.residual;
    } else {
        part.refined.value = std::move(guess); // nothing is known
        s.bound = std::numeric_limits<double>::infinity();
    }
}

template <int Dim> bool MultiprecisionRung<Dim>::converged() const {
    const auto& parts = this->problem_.parts;
    return std::all_of(parts.begin(), parts.end(), [&](const RightHandSide& part) {
        const ForceSolution& s = part.solution;
        if (part.zero || s.value.empty() || s.rung != this->rung() || s.bits != this->bits()) {
            return true;
        }
        Real size(64);
        Real upper(64);
        for (const Real& x : part.refined.value) {
            mpfr_abs(upper.get(), x.get(), MPFR_RNDU);
            mpfr_max(size.get(), size.get(), upper.get(), MPFR_RNDU);
        }
        mpfr_mul_2si(size.get(), size.get(), -this->bits() / 2, MPFR_RNDN);
        return mpfr_lessequal_p(part.refined.bound.get(), size.get()) != 0;
    });
}

} // namespace

template <int Dim>
std::unique_ptr<ForceRung<Dim>> multiprecision_rung(LadderProblem<Dim>& problem, MultiprecisionStart start, int bits) {
    if (start.coordinate.empty()) {
        start.coordinate = exact_coordinates(problem.packing.q, {});
    }
    double sigma = problem.inverse.sigma_min;
    Real uncertainty(64);
    Place here;
    if (problem.vertex != nullptr) {
        RefinedVertex found = refine_vertex(problem.packing, problem.structure, problem.factorisation, problem.inverse,
                                            start.coordinate, bits);
        if (found.verdict != Verdict::proved) {
            return nullptr;
        }
        here.shift = found.shift;
        here.away = (found.shift + found.radius.above()) * (1 + 4 * u);
        // May be far below the range of double.
        mpfr_mul_d(uncertainty.get(), found.radius.get(), problem.normal_rate(), MPFR_RNDU);
        sigma = (sigma - problem.normal_rate() * here.shift - uncertainty.above()) * (1 - 8 * u);
        if (!(sigma > 0)) {
            return nullptr;
        }
        here.uncertainty = uncertainty.above();
        start.coordinate = std::move(found.coordinate);
    }
    return std::make_unique<MultiprecisionRung<Dim>>(problem, std::move(start), here, sigma, std::move(uncertainty),
                                                     bits);
}

template std::unique_ptr<ForceRung<2>> multiprecision_rung<2>(LadderProblem<2>&, MultiprecisionStart, int);

} // namespace isostat
