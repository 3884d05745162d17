#include "verified/force_ladder.hpp"

#include "verified/force_rung.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

/// Shared with the shifts made of it: the ladder may move, and end before them.
template <int Dim> struct ForceLadder<Dim>::Implementation {
    explicit Implementation(const LadderProblem<Dim>& of, double accuracy)
        : problem(of), rung(double_rung(problem, accuracy)) {}

    LadderProblem<Dim> problem;
    std::unique_ptr<ForceRung<Dim>> rung;
    bool exact_allowed = true;

    bool climb() {
        auto next = rung->next();
        if (!next && exact_allowed && rung->rung() != Rung::exact) {
            next = exact_rung(problem, *rung);
        }
        if (next) {
            rung = std::move(next);
            return true;
        }
        return false;
    }
    /// Part `number`, solved on the present rung.
    RightHandSide& solved(int number) {
        RightHandSide& part = problem.part(number);
        rung->bring(part);
        return part;
    }
    /// -(p + (at - from) s) / s, after as many climbs as it takes.
    class Zero;
};

template <int Dim> class ForceLadder<Dim>::Implementation::Zero final : public LoadShift {
  public:
    Zero(std::shared_ptr<Implementation> ladder, const ForceExpression& force)
        : ladder_(std::move(ladder)), force_(force) {}
    [[nodiscard]] PreciseInterval value(int bits) const override {
        while (ladder_->rung->rung() != Rung::exact && ladder_->rung->bits() < bits && ladder_->climb()) {
        }
        return ladder_->rung->zero_of(force_, bits);
    }

  private:
    std::shared_ptr<Implementation> ladder_;
    ForceExpression force_;
};

template <int Dim>
ForceLadder<Dim>::ForceLadder(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                              const Factorisation& factorisation, const InverseBound& inverse, LadderOptions options,
                              const VertexEnclosure* vertex)
    : implementation_(std::make_shared<Implementation>(
          LadderProblem<Dim>(packing, structure, factorisation, inverse, options, vertex),
          factorisation.is_fresh() ? 0 : options.first_accuracy)) {}

template <int Dim> ForceLadder<Dim>::~ForceLadder() = default;
template <int Dim> ForceLadder<Dim>::ForceLadder(ForceLadder&&) noexcept = default;
template <int Dim> ForceLadder<Dim>& ForceLadder<Dim>::operator=(ForceLadder&&) noexcept = default;

template <int Dim> int ForceLadder<Dim>::add(std::vector<double> force, LoadTerms terms, std::vector<double> guess) {
    RightHandSide part;
    part.zero = std::all_of(force.begin(), force.end(), [](double f) { return f == 0; }) &&
                std::all_of(terms.products.begin(), terms.products.end(), [](const ExactProduct& p) {
                    return p.a == 0 || p.b == 0; // a product may underflow
                });
    part.terms = std::move(terms);
    part.force = std::move(force);
    part.guess = std::move(guess);
    implementation_->problem.parts.push_back(std::move(part));
    return static_cast<int>(implementation_->problem.parts.size()) - 1;
}

template <int Dim> const std::vector<double>& ForceLadder<Dim>::force(int part) const {
    return implementation_->problem.part(part).force;
}

template <int Dim> const ForceSolution& ForceLadder<Dim>::solution(int part) const {
    return implementation_->solved(part).solution;
}

template <int Dim> std::span<const double> ForceLadder<Dim>::known(int part) const {
    return implementation_->problem.part(part).solution.value;
}

template <int Dim> std::string ForceLadder<Dim>::digits(int part, ContactId contact, int bits) const {
    const RightHandSide& p = implementation_->solved(part);
    const Real value = p.zero ? Real() : implementation_->rung->digits(p, contact, std::max(bits, 2));
    char* text = nullptr;
    mpfr_asprintf(&text, "%Ra", value.get());
    std::string result(text);
    mpfr_free_str(text);
    return result;
}

template <int Dim> double ForceLadder<Dim>::bound_exponent(int part) const {
    const RightHandSide& p = implementation_->solved(part);
    return p.zero ? -std::numeric_limits<double>::infinity() : implementation_->rung->bound_exponent(p);
}

template <int Dim> bool ForceLadder<Dim>::climb() {
    return implementation_->climb();
}

template <int Dim> Rung ForceLadder<Dim>::rung() const {
    return implementation_->rung->rung();
}

template <int Dim> int ForceLadder<Dim>::bits() const {
    return implementation_->rung->bits();
}

template <int Dim> double ForceLadder<Dim>::normal_uncertainty() const {
    return implementation_->rung->normal_uncertainty();
}

template <int Dim> void ForceLadder<Dim>::without_exact_numbers() {
    implementation_->exact_allowed = false;
}

template <int Dim> std::shared_ptr<const LoadShift> ForceLadder<Dim>::zero_of(const ForceExpression& force) const {
    return std::make_shared<typename Implementation::Zero>(implementation_, force);
}

template <int Dim> Order ForceLadder<Dim>::sign(const ForceExpression& a) const {
    return implementation_->rung->sign(a);
}

template <int Dim> Order ForceLadder<Dim>::compare(const ForceExpression& a, const ForceExpression& b) const {
    return implementation_->rung->compare(a, b);
}

bool is_tie(const Order& order, double size) {
    if (order.decided) {
        return order.sign == 0;
    }
    return size > 0 && order.exponent <= std::log2(size) - tie_bits;
}

template class ForceLadder<2>;

} // namespace isostat
