#include "contact/separation.hpp"
#include "core/roundoff.hpp"
#include "core/work.hpp"
#include "exact/rational_solver.hpp"
#include "rigidity/isostatic.hpp"
#include "verified/force_rung.hpp"
#include "verified/force_solution.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace isostat {

namespace {

using roundoff::infinity;
constexpr mpfr_prec_t shown_bits = 160; ///< of the doubles that are shown for exact numbers; exact: bits of comparisons

/// value = mantissa 2^exponent, mantissa odd or 0.
struct Dyadic {
    mpz_class mantissa;
    long exponent = 0;
};

Dyadic dyadic(const mpq_class& value) {
    Dyadic result{value.get_num(), 0};
    if (result.mantissa != 0) {
        const auto zeros = mpz_scan1(result.mantissa.get_mpz_t(), 0);
        result.mantissa >>= zeros;
        // The denominator is a power of two.
        result.exponent = static_cast<long>(zeros) - static_cast<long>(mpz_scan1(value.get_den_mpz_t(), 0));
    }
    return result;
}

/// Integers value 2^-shift with the largest common shift; returns the shift (0 when all are 0).
long common_integers(const std::vector<mpq_class>& values, std::vector<mpz_class>& integers) {
    std::vector<Dyadic> parts;
    long shift = std::numeric_limits<long>::max();
    for (const mpq_class& value : values) {
        parts.push_back(dyadic(value));
        if (parts.back().mantissa != 0) {
            shift = std::min(shift, parts.back().exponent);
        }
    }
    integers.clear();
    for (const Dyadic& part : parts) {
        integers.push_back(part.mantissa == 0
                               ? mpz_class(0)
                               : mpz_class(part.mantissa << static_cast<mp_bitcnt_t>(part.exponent - shift)));
    }
    return shift == std::numeric_limits<long>::max() ? 0 : shift;
}

/// The scaled system: column l of H times the distance of the centres and times a power of two has integer entries
/// (stored doubles are dyadic), so f_l = unknown_l sqrt(square_l) with a rational unknown and an integer square.
/// Signs are those of the unknowns, ratios of two right-hand sides in one contact are ratios of the unknowns.
class ExactForces {
  public:
    ExactForces(const Packing& packing, const IsostaticStructure& structure);
    /// \pre of the other members
    [[nodiscard]] bool regular() const { return solver_.regular(); }
    /// The unknowns of H f = force, the doubles taken as exact except in the rows of `products`.
    [[nodiscard]] std::vector<mpq_class> solve(const std::vector<double>& force,
                                               std::span<const ExactProduct> products = {}) const;
    [[nodiscard]] const mpz_class& square(ContactId contact) const { return square_[contact.index()]; }

  private:
    static sparse::Matrix<mpz_class> scaled(const Packing& packing, const IsostaticStructure& structure,
                                            std::vector<mpz_class>& square);
    std::vector<mpz_class> square_;
    exact::RationalSolver solver_;
};

sparse::Matrix<mpz_class> ExactForces::scaled(const Packing& packing, const IsostaticStructure& structure,
                                              std::vector<mpz_class>& square) {
    const sparse::Matrix<double>& h = structure.matrix();
    const DofMap& dofs = structure.dofs();
    sparse::Matrix<mpz_class> matrix{h.rows, h.cols, h.start, h.row, {}};
    matrix.value.resize(h.value.size());
    for (std::size_t l = 0; l < structure.contacts().size(); ++l) {
        const Contact& contact = structure.contacts()[l];
        std::vector<mpz_class> integers;
        const Separation separation(contact, packing.layout());
        const bool pair = contact.of_disks();
        mpz_class sum = pair ? 0 : 1;
        if (pair) {
            const auto d =
                separation.of_disks([&](std::size_t k) { return mpq_class(packing.q[k]); },
                                    [](const mpq_class& x, const mpq_class& y) -> mpq_class { return x - y; });
            common_integers(std::vector<mpq_class>(d.begin(), d.end()), integers);
            for (const mpz_class& c : integers) {
                sum += c * c;
            }
        }
        square.push_back(sum);
        PerAxis<mpz_class> normal; // times the square root of `sum`
        std::copy(integers.begin(), integers.end(), normal.begin());
        auto entry = matrix.value.begin() + h.start[l];
        separation.for_each_entry(dofs, normal, [&](int, const mpz_class& value) { *entry++ = value; });
    }
    return matrix;
}

ExactForces::ExactForces(const Packing& packing, const IsostaticStructure& structure)
    : solver_(scaled(packing, structure, square_), structure.ordering()) {}

std::vector<mpq_class> ExactForces::solve(const std::vector<double>& force,
                                          std::span<const ExactProduct> products) const {
    std::vector<mpq_class> values(force.begin(), force.end());
    for (const ExactProduct& product : products) {
        values[static_cast<std::size_t>(product.row)] =
            -((mpq_class(product.a) + product.rest[0] + product.rest[1]) * product.b * product.c);
    }
    std::vector<mpz_class> b;
    const long shift = common_integers(values, b);
    const auto x = solver_.solve(b);
    assert(x && "asked only when regular");
    std::vector<mpq_class> unknown;
    unknown.reserve(b.size());
    for (const mpz_class& numerator : x->numerator) {
        mpq_class value(numerator, x->denominator);
        value.canonicalize();
        if (shift >= 0) {
            value <<= static_cast<mp_bitcnt_t>(shift);
        } else {
            value >>= static_cast<mp_bitcnt_t>(-shift);
        }
        unknown.push_back(std::move(value));
    }
    return unknown;
}

/// Rational times the root of an integer, to `bits` bits (a few units of rounding).
Real root_product(const mpq_class& factor, const mpz_class& square, mpfr_prec_t bits) {
    Real root(bits + 8); // 8: precision.md B7
    mpfr_set_z(root.get(), square.get_mpz_t(), MPFR_RNDN);
    mpfr_sqrt(root.get(), root.get(), MPFR_RNDN);
    Real result(bits + 8);
    mpfr_set_q(result.get(), factor.get_mpq_t(), MPFR_RNDN);
    mpfr_mul(result.get(), result.get(), root.get(), MPFR_RNDN);
    return result;
}

/// An exact number of which only the sign is known.
Order exact_order(int sign) {
    return {true, sign, infinity, Rung::exact, 0, sign == 0 ? -infinity : infinity};
}

/// Numbers x sqrt(s) with x rational and s an integer, see `ExactForces`.
class ExactRung final : public ForceRung {
  public:
    ExactRung(LadderProblem& problem, ExactForces forces, double away)
        : ForceRung(problem, Rung::exact, 0), forces_(std::move(forces)), away_(away) {}

    Order sign(const ForceExpression& a) override {
        ForceExpression numerator = a; // divisors are positive
        numerator.divisor_part = -1;
        return exact_order(sgn(value_of(numerator).factor));
    }
    Order compare(const ForceExpression& a, const ForceExpression& b) override {
        const Value x = value_of(a);
        const Value y = value_of(b);
        const int sign_x = sgn(x.factor);
        const int sign_y = sgn(y.factor);
        return exact_order(sign_x != sign_y ? (sign_x > sign_y ? 1 : -1)
                                            : sign_x * sgn(mpq_class(x.square - y.square)));
    }
    PreciseInterval zero_of(const ForceExpression& force, int bits) override {
        const mpq_class zero = -value_of(force).factor / unknown(force.slope_part, force.contact);
        // 160: exact: bits of comparisons; 32: exact: more bits than the numbers
        PreciseInterval result(std::max(bits + 32, 160));
        mpfr_set_q(result.low.get(), zero.get_mpq_t(), MPFR_RNDD);
        mpfr_set_q(result.high.get(), zero.get_mpq_t(), MPFR_RNDU);
        return result;
    }
    [[nodiscard]] Real digits(const RightHandSide& part, ContactId contact, int bits) const override {
        const Real product = root_product(part.unknown[contact.index()], forces_.square(contact), bits);
        Real value(bits);
        mpfr_set(value.get(), product.get(), MPFR_RNDN);
        return value;
    }
    [[nodiscard]] double bound_exponent(const RightHandSide&) const override { return -infinity; }
    double normal_uncertainty() override { return away_; }
    std::unique_ptr<ForceRung> next() override { return nullptr; }

  private:
    /// A factor with the sign of the expression, and the square of the expression.
    struct Value {
        mpq_class factor;
        mpq_class square;
    };
    Value value_of(const ForceExpression& e);
    void solve(RightHandSide& part) override;
    const mpq_class& unknown(int part, ContactId contact) {
        RightHandSide& p = this->problem_.part(part);
        this->bring(p);
        return p.zero ? nothing_ : p.unknown[contact.index()];
    }

    ExactForces forces_;
    double away_;
    mpq_class nothing_ = 0;
};

auto ExactRung::value_of(const ForceExpression& e) -> Value {
    mpq_class value = unknown(e.part, e.contact);
    if (e.slope_part >= 0 && e.at != e.from) {
        value += (mpq_class(e.at) - mpq_class(e.from)) * unknown(e.slope_part, e.contact);
    }
    if (e.minus_magnitude) {
        value = -abs(value);
    }
    if (e.divisor_part < 0) {
        return {value, value * value * forces_.square(e.contact)};
    }
    value /= abs(unknown(e.divisor_part, e.contact)); // the roots cancel
    return {value, value * value};
}

void ExactRung::solve(RightHandSide& part) {
    ForceSolution& s = part.solution;
    const std::size_t n = part.force.size();
    part.unknown = forces_.solve(part.force, part.terms.products);
    std::vector<Real> x;
    Real error(64); // 64: exact: bits of a bound
    Real size(64);
    for (std::size_t l = 0; l < n; ++l) {
        x.push_back(root_product(part.unknown[l], forces_.square(ContactId(l)), shown_bits));
        mpfr_abs(size.get(), x.back().get(), MPFR_RNDU);
        mpfr_max(error.get(), error.get(), size.get(), MPFR_RNDU);
    }
    mpfr_mul_2si(error.get(), error.get(), -shown_bits, MPFR_RNDU); // the numbers have 8 bits more
    round_to_pairs(x, error, s);
    s.residual = 0;
}

/// True when the loads are finite numbers and the exact numbers describe the vertex that is meant: the stored
/// configuration is the true vertex, and the loads do not depend on the vertex.
bool applies(const LadderProblem& problem) {
    const auto finite = [](const RightHandSide& part) {
        return std::all_of(part.force.begin(), part.force.end(), [](double f) { return std::isfinite(f); });
    };
    if (problem.structure.size() > problem.options.exact_size ||
        !std::all_of(problem.parts.begin(), problem.parts.end(), finite)) {
        return false;
    }
    if (problem.vertex == nullptr) {
        return true;
    }
    const auto closed = [&](const Contact& c) {
        return c.kind == ContactKind::held || gap_sign(problem.packing, c, 0) == 0;
    };
    const auto fixed = [](const RightHandSide& part) { return part.terms.rate == 0 || part.zero; };
    const auto& contacts = problem.structure.contacts();
    return problem.vertex->verdict == Verdict::proved &&
           std::all_of(problem.parts.begin(), problem.parts.end(), fixed) &&
           std::all_of(contacts.begin(), contacts.end(), closed);
}

} // namespace

std::unique_ptr<ForceRung> exact_rung(LadderProblem& problem, ForceRung& last) {
    if (!applies(problem)) {
        return nullptr;
    }
    count_work(Work::exact_solutions);
    ExactForces forces(problem.packing, problem.structure);
    return forces.regular() ? std::make_unique<ExactRung>(problem, std::move(forces), last.normal_uncertainty())
                            : nullptr;
}

} // namespace isostat
