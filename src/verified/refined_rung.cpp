#include "core/roundoff.hpp"
#include "core/work.hpp"
#include "verified/force_rung.hpp"
#include "verified/norm.hpp"

#include <algorithm>
#include <type_traits>

namespace isostat {

namespace {

using roundoff::u;

/// The result with fewer digits, as a guess.
dd_real sum_of(const Arithmetic<dd_real>&, double high, double low) {
    return {high, low};
}
Real sum_of(const Arithmetic<Real>& arithmetic, double high, double low) {
    return arithmetic.number(high) + arithmetic.number(low);
}

/// The contact matrix in double-double or MPFR, at the true vertex, enclosed with as many digits, when that is meant.
template <class T> class RefinedRung final : public IntervalRung {
  public:
    using A = Arithmetic<T>;
    static constexpr bool in_pairs = std::is_same_v<T, dd_real>; ///< two doubles hold every digit

    RefinedRung(LadderProblem& problem, const A& arithmetic, std::optional<EnclosedVertex<T>> vertex, int bits)
        : IntervalRung(problem, A::rung, bits), vertex_(std::move(vertex)),
          system_(vertex_ ? ContactSystem<T>(*vertex_, problem.structure, problem.factorisation)
                          : ContactSystem<T>(CorrectedConfiguration<T>(arithmetic, problem.packing), problem.structure,
                                             problem.factorisation, problem.inverse.sigma_min, 0)) {
        count_work(in_pairs ? Work::double_double : Work::multiprecision);
    }

    double normal_uncertainty() override {
        return vertex_ ? this->problem_.normal_rate() * above(vertex_->distance()) : 0;
    }
    std::unique_ptr<ForceRung> next() override;
    [[nodiscard]] Real digits(const RightHandSide& part, ContactId contact, int bits) const override {
        if constexpr (in_pairs) {
            return IntervalRung::digits(part, contact, bits);
        }
        Real value(bits);
        mpfr_set(value.get(), part.refined.value[contact.index()].get(), MPFR_RNDN);
        return value;
    }
    [[nodiscard]] double bound_exponent(const RightHandSide& part) const override {
        if constexpr (in_pairs) {
            return IntervalRung::bound_exponent(part);
        }
        Real logarithm(64); // exact: bits of a bound
        mpfr_log2(logarithm.get(), part.refined.bound.real().get(), MPFR_RNDU);
        return logarithm.above();
    }

  private:
    void solve(RightHandSide& part) override;
    [[nodiscard]] std::vector<T> load(const RightHandSide& part) const;
    [[nodiscard]] std::vector<T> guess(const RightHandSide& part) const;
    void take(BoundedVector<T> solved, RightHandSide& part) const;
    [[nodiscard]] PreciseInterval enclosed(const RightHandSide& part, std::size_t l) const override {
        if constexpr (in_pairs) {
            return IntervalRung::enclosed(part, l);
        }
        // exact: more bits than the numbers
        return {part.refined.value[l], part.refined.bound.real(), this->bits() + 32};
    }
    /// Whether the bounds are below 2^(-bits/2) of the largest force, so that more bits will decide more.
    [[nodiscard]] bool converged() const;

    std::optional<EnclosedVertex<T>> vertex_; ///< empty: the stored configuration is meant
    ContactSystem<T> system_;
};

/// Products of two doubles are exact; the bound of the residual allows two roundings for a product of three.
template <class T> std::vector<T> RefinedRung<T>::load(const RightHandSide& part) const {
    const A& a = system_.arithmetic();
    std::vector<T> force;
    force.reserve(part.force.size());
    for (const double f : part.force) {
        force.push_back(a.number(f));
    }
    for (const ExactProduct& product : part.terms.products) {
        T& sum = force[static_cast<std::size_t>(product.row)] = -a.product(product.a, product.b, product.c);
        for (const double rest : product.rest) {
            sum = rest == 0 ? sum : sum - a.product(rest, product.b, product.c);
        }
    }
    return force;
}

template <class T> std::vector<T> RefinedRung<T>::guess(const RightHandSide& part) const {
    const ForceSolution& s = part.solution;
    if constexpr (!in_pairs) {
        if (!part.refined.value.empty()) {
            return part.refined.value;
        }
    }
    std::vector<T> x;
    x.reserve(s.value.size());
    for (std::size_t l = 0; l < s.value.size(); ++l) {
        x.push_back(sum_of(system_.arithmetic(), s.value[l], s.low.empty() ? 0.0 : s.low[l]));
    }
    return x;
}

template <class T> void RefinedRung<T>::solve(RightHandSide& part) {
    this->problem_.solve_in_double(part, 0);
    const double rate = part.terms.rate;
    // precision.md B1 (last operations)
    const double error = rate == 0 || !vertex_ ? 0 : rate * above(vertex_->distance()) * (1 + 4 * u);
    std::vector<T> start = guess(part);
    BoundedVector<T> solved = system_.forces(load(part), error, start);
    if (solved.value.empty()) { // no bound is known
        solved.value = std::move(start);
    }
    take(std::move(solved), part);
}

template <class T> void RefinedRung<T>::take(BoundedVector<T> solved, RightHandSide& part) const {
    ForceSolution& s = part.solution;
    s.residual = solved.residual;
    if constexpr (in_pairs) {
        s.low.resize(s.value.size());
        for (std::size_t l = 0; l < s.value.size(); ++l) {
            s.value[l] = solved.value[l].x[0];
            s.low[l] = solved.value[l].x[1];
        }
        s.bound = solved.bound;
    } else {
        round_to_pairs(solved.value, solved.bound.real(), s);
        part.refined = std::move(solved);
    }
}

template <class T> bool RefinedRung<T>::converged() const {
    const auto& parts = this->problem_.parts;
    return std::all_of(parts.begin(), parts.end(), [&](const RightHandSide& part) {
        const ForceSolution& s = part.solution;
        if (part.zero || s.value.empty() || s.rung != this->rung() || s.bits != this->bits()) {
            return true;
        }
        UpperBound size;
        for (const Real& x : part.refined.value) {
            size = std::max(size, UpperBound::magnitude(x));
        }
        return part.refined.bound <= size * UpperBound::power_of_two(-this->bits() / 2);
    });
}

template <class T> std::unique_ptr<ForceRung> RefinedRung<T>::next() {
    const LadderOptions& options = this->problem_.options;
    if constexpr (in_pairs) {
        return options.first_bits > options.max_bits ? nullptr
                                                     : multiprecision_rung(this->problem_, options.first_bits);
    } else {
        const int more = 2 * this->bits();
        return more > options.max_bits || !converged()
                   ? nullptr
                   : multiprecision_rung(this->problem_, more,
                                         vertex_ ? vertex_->at().correction() : std::vector<Real>());
    }
}

/// Null when the true vertex is meant and no enclosure of the true vertex exists.
template <class T>
std::unique_ptr<ForceRung> refined_rung(LadderProblem& problem, const Arithmetic<T>& arithmetic,
                                        const std::vector<T>& start, int bits) {
    std::optional<EnclosedVertex<T>> vertex;
    if (problem.vertex != nullptr) {
        vertex.emplace(arithmetic, problem.packing, problem.structure, problem.factorisation,
                       Neighbourhood::of(problem.packing, problem.structure.contacts(), problem.inverse), start);
        if (!vertex->exists() || !(vertex->sigma() > 0)) {
            return nullptr;
        }
    }
    return std::make_unique<RefinedRung<T>>(problem, arithmetic, std::move(vertex), bits);
}

} // namespace

std::unique_ptr<ForceRung> double_double_rung(LadderProblem& problem) {
    const auto& parts = problem.parts;
    const bool loads = std::all_of(parts.begin(), parts.end(), [](const RightHandSide& part) {
        return part.zero || in_range_of_products(norm_above(part.force));
    });
    // exact: bits of double-double
    return loads && in_range_of_products(problem.packing) ? refined_rung<dd_real>(problem, {}, {}, 106) : nullptr;
}

std::unique_ptr<ForceRung> multiprecision_rung(LadderProblem& problem, int bits, const std::vector<Real>& start) {
    return refined_rung<Real>(problem, Arithmetic<Real>(bits), start, bits);
}

} // namespace isostat
