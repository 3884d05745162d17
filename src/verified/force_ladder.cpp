#include "verified/force_ladder.hpp"

#include "verified/force_rung.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isostat {

/// The shifts made by a ladder share this: the ladder may be moved, and may end before the shifts.
struct ForceLadder::Implementation {
    explicit Implementation(LadderProblem of, double accuracy)
        : problem(std::move(of)), rung(double_rung(problem, accuracy)) {}

    LadderProblem problem;
    std::unique_ptr<ForceRung> rung;
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
    /// Part `number`, solved on the current rung.
    RightHandSide& solved(int number) {
        RightHandSide& part = problem.part(number);
        rung->bring(part);
        return part;
    }
    /// -(p + (at - from) s) / s, after as many climbs as the bits require.
    class Zero;
};

class ForceLadder::Implementation::Zero final : public LoadShift {
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

ForceLadder::ForceLadder(const Packing& packing, const IsostaticStructure& structure,
                         const Factorisation& factorisation, const InverseBound& inverse, LadderOptions options,
                         const VertexEnclosure* vertex)
    : implementation_(
          std::make_shared<Implementation>(LadderProblem(packing, structure, factorisation, inverse, options, vertex),
                                           factorisation.is_fresh() ? 0 : options.first_accuracy)) {}

ForceLadder::~ForceLadder() = default;
ForceLadder::ForceLadder(ForceLadder&&) noexcept = default;
ForceLadder& ForceLadder::operator=(ForceLadder&&) noexcept = default;

int ForceLadder::add(std::vector<double> force, LoadTerms terms, std::vector<double> guess) {
    RightHandSide part;
    part.zero = std::all_of(force.begin(), force.end(), [](double f) { return f == 0; }) &&
                std::all_of(terms.products.begin(), terms.products.end(), [](const ExactProduct& p) {
                    return p.a == 0 || p.b == 0 || p.c == 0; // a product may underflow
                });
    part.terms = std::move(terms);
    part.force = std::move(force);
    part.guess = std::move(guess);
    implementation_->problem.parts.push_back(std::move(part));
    return static_cast<int>(implementation_->problem.parts.size()) - 1;
}

const std::vector<double>& ForceLadder::force(int part) const {
    return implementation_->problem.part(part).force;
}

const ForceSolution& ForceLadder::solution(int part) const {
    return implementation_->solved(part).solution;
}

std::span<const double> ForceLadder::known(int part) const {
    return implementation_->problem.part(part).solution.value;
}

std::string ForceLadder::digits(int part, ContactId contact, int bits) const {
    const RightHandSide& p = implementation_->solved(part);
    const Real value = p.zero ? Real() : implementation_->rung->digits(p, contact, std::max(bits, 2));
    char* text = nullptr;
    mpfr_asprintf(&text, "%Ra", value.get());
    std::string result(text);
    mpfr_free_str(text);
    return result;
}

double ForceLadder::bound_exponent(int part) const {
    const RightHandSide& p = implementation_->solved(part);
    return p.zero ? -std::numeric_limits<double>::infinity() : implementation_->rung->bound_exponent(p);
}

bool ForceLadder::climb() {
    return implementation_->climb();
}

Rung ForceLadder::rung() const {
    return implementation_->rung->rung();
}

int ForceLadder::bits() const {
    return implementation_->rung->bits();
}

double ForceLadder::normal_uncertainty() const {
    return implementation_->rung->normal_uncertainty();
}

void ForceLadder::without_exact_numbers() {
    implementation_->exact_allowed = false;
}

std::shared_ptr<const LoadShift> ForceLadder::zero_of(const ForceExpression& force) const {
    return std::make_shared<typename Implementation::Zero>(implementation_, force);
}

Order ForceLadder::sign(const ForceExpression& a) const {
    return implementation_->rung->sign(a);
}

Order ForceLadder::compare(const ForceExpression& a, const ForceExpression& b) const {
    return implementation_->rung->compare(a, b);
}

bool is_tie(const Order& order, double size) {
    if (order.decided) {
        return order.sign == 0;
    }
    return size > 0 && order.exponent <= std::log2(size) - tie_bits;
}

} // namespace isostat
