#include "exact/rational_solver.hpp"

#include "exact/field.hpp"
#include "exact/sparse_lu.hpp"

#include <algorithm>
#include <variant>

namespace isostat::exact {

namespace {

static_assert(sizeof(unsigned long) == 8, "GMP's unsigned long carries a residue");

template <int Bits> struct Modular {
    using F = Field<Bits>;
    using Value = typename F::Value;
    static Value zero() { return 0; }
    static bool is_zero(Value x) { return x == 0; }
    static void subtract_product(Value& x, Value a, Value b) {
        x = F::canonical(static_cast<typename F::Word>(x) + F::multiply(F::negate(a), b));
    }
    static void multiply(Value& x, Value a) { x = F::multiply(x, a); }
    static Value reciprocal(Value x) { return F::inverse(x); }
    static double weight(Value x) { return x == 0 ? 0 : 1; }
    static Value residue(const mpz_class& x) { return static_cast<Value>(mpz_fdiv_ui(x.get_mpz_t(), F::p)); }
};

template <int Bits>
SparseLu<Modular<Bits>> factorise(const sparse::Matrix<mpz_class>& a, const sparse::Ordering& order) {
    sparse::Matrix<typename Modular<Bits>::Value> reduced{a.rows, a.cols, a.start, a.row, {}};
    reduced.value.reserve(a.value.size());
    std::ranges::transform(a.value, std::back_inserter(reduced.value), Modular<Bits>::residue);
    return {Modular<Bits>(), reduced, order};
}

/// r -= A x, or r -= A^T x when `transposed`.
void subtract_product(const sparse::Matrix<mpz_class>& a, bool transposed, const std::vector<unsigned long>& x,
                      std::vector<mpz_class>& r) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(a.cols); ++j) {
        for (auto e = static_cast<std::size_t>(a.start[j]); e < static_cast<std::size_t>(a.start[j + 1]); ++e) {
            const auto i = static_cast<std::size_t>(a.row[e]);
            if (transposed) {
                mpz_submul_ui(r[j].get_mpz_t(), a.value[e].get_mpz_t(), x[i]);
            } else {
                mpz_submul_ui(r[i].get_mpz_t(), a.value[e].get_mpz_t(), x[j]);
            }
        }
    }
}

/// Sum of digit[k] p^k over [first, last), computed by halves; `power[s]` = p^(2^s).
mpz_class combine(const std::vector<std::vector<unsigned long>>& digits, std::size_t unknown, std::size_t first,
                  std::size_t last, const std::vector<mpz_class>& power) {
    if (last - first == 1) {
        return digits[first][unknown];
    }
    std::size_t s = 0;
    while ((std::size_t{2} << s) < last - first) {
        ++s;
    }
    const std::size_t middle = first + (std::size_t{1} << s);
    mpz_class high = combine(digits, unknown, middle, last, power);
    high *= power[s];
    high += combine(digits, unknown, first, middle, power);
    return high;
}

/// Finds n / d = x mod m with |n|, d <= bound, by the extended Euclidean
/// algorithm stopped half way; false when no such fraction exists.
bool reconstruct(const mpz_class& x, const mpz_class& m, const mpz_class& bound, mpz_class& n, mpz_class& d) {
    mpz_class r0 = m;
    mpz_class r1 = x;
    mpz_class t0 = 0;
    mpz_class t1 = 1;
    mpz_class quotient;
    mpz_class rest;
    while (r1 > bound) {
        mpz_fdiv_qr(quotient.get_mpz_t(), rest.get_mpz_t(), r0.get_mpz_t(), r1.get_mpz_t());
        r0.swap(r1);
        r1.swap(rest);
        mpz_submul(t0.get_mpz_t(), quotient.get_mpz_t(), t1.get_mpz_t());
        t0.swap(t1);
    }
    n = sgn(t1) < 0 ? mpz_class(-r1) : r1;
    d = abs(t1);
    return d != 0 && d <= bound;
}

/// The small vector of rationals with one denominator that is congruent to x mod m; false when there is none.
bool reconstruct(const std::vector<mpz_class>& x, const mpz_class& m, RationalVector& out) {
    const mpz_class bound = sqrt(mpz_class(m / 2));
    const mpz_class half = m / 2;
    out.denominator = 1;
    out.numerator.assign(x.size(), 0);
    mpz_class y;
    for (std::size_t l = 0; l < x.size(); ++l) {
        y = x[l] * out.denominator;
        mpz_fdiv_r(y.get_mpz_t(), y.get_mpz_t(), m.get_mpz_t());
        mpz_class& n = out.numerator[l];
        n = y > half ? mpz_class(y - m) : y;
        if (abs(n) <= bound) {
            continue;
        }
        mpz_class d;
        if (!reconstruct(y, m, bound, n, d)) {
            return false;
        }
        out.denominator *= d;
        if (out.denominator > bound) {
            return false;
        }
        for (std::size_t k = 0; k < l; ++k) {
            out.numerator[k] *= d;
        }
    }
    return true;
}

bool satisfies(const sparse::Matrix<mpz_class>& a, bool transposed, const RationalVector& x,
               const std::vector<mpz_class>& b) {
    std::vector<mpz_class> r(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) {
        r[i] = b[i] * x.denominator;
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(a.cols); ++j) {
        for (auto e = static_cast<std::size_t>(a.start[j]); e < static_cast<std::size_t>(a.start[j + 1]); ++e) {
            const auto i = static_cast<std::size_t>(a.row[e]);
            r[transposed ? j : i] -= a.value[e] * x.numerator[transposed ? i : j];
        }
    }
    return std::ranges::all_of(r, [](const mpz_class& c) { return c == 0; });
}

template <int Bits>
RationalVector lift(const SparseLu<Modular<Bits>>& lu, const sparse::Matrix<mpz_class>& a,
                    const std::vector<mpz_class>& b, bool transposed) {
    const std::size_t n = b.size();
    std::vector<mpz_class> residual = b;
    std::vector<mpz_class> x(n, 0);
    std::vector<mpz_class> power{mpz_class(static_cast<unsigned long>(Field<Bits>::p))};
    mpz_class modulus = 1;
    std::vector<std::vector<unsigned long>> digits;
    RationalVector out;
    std::vector<typename Modular<Bits>::Value> digit(n);
    // The loop ends: once the modulus exceeds twice the square of the
    // numbers of Cramer's rule, the reconstruction is the solution.
    for (std::size_t done = 0, next = 2;; next += std::max<std::size_t>(2, next / 2)) {
        digits.clear();
        for (; done < next; ++done) {
            std::ranges::transform(residual, digit.begin(), Modular<Bits>::residue);
            if (transposed) {
                lu.solve_transposed(digit);
            } else {
                lu.solve(digit);
            }
            digits.emplace_back(digit.begin(), digit.end());
            subtract_product(a, transposed, digits.back(), residual);
            for (mpz_class& r : residual) {
                mpz_divexact_ui(r.get_mpz_t(), r.get_mpz_t(), Field<Bits>::p);
            }
        }
        while ((std::size_t{1} << power.size()) <= digits.size()) {
            power.emplace_back(power.back() * power.back());
        }
        for (std::size_t l = 0; l < n; ++l) {
            x[l] += modulus * combine(digits, l, 0, digits.size(), power);
        }
        mpz_class step;
        mpz_pow_ui(step.get_mpz_t(), power[0].get_mpz_t(), digits.size());
        modulus *= step;
        if (reconstruct(x, modulus, out) && satisfies(a, transposed, out, b)) {
            return out;
        }
    }
}

} // namespace

struct RationalSolver::Implementation {
    Implementation(sparse::Matrix<mpz_class> a, const sparse::Ordering& ordering)
        : matrix(std::move(a)), lu(factorise<61>(matrix, ordering)) {
        if (!std::get<0>(lu).regular()) {
            lu.emplace<1>(factorise<31>(matrix, ordering));
        }
    }
    sparse::Matrix<mpz_class> matrix;
    std::variant<SparseLu<Modular<61>>, SparseLu<Modular<31>>> lu;
};

RationalSolver::RationalSolver(sparse::Matrix<mpz_class> matrix, const sparse::Ordering& ordering)
    : implementation_(std::make_unique<Implementation>(std::move(matrix), ordering)) {}

RationalSolver::~RationalSolver() = default;
RationalSolver::RationalSolver(RationalSolver&&) noexcept = default;
RationalSolver& RationalSolver::operator=(RationalSolver&&) noexcept = default;

bool RationalSolver::regular() const {
    return std::visit([](const auto& lu) { return lu.regular(); }, implementation_->lu);
}

std::optional<RationalVector> RationalSolver::solve(const std::vector<mpz_class>& b, bool transposed) const {
    if (!regular()) {
        return std::nullopt;
    }
    return std::visit([&](const auto& lu) { return lift(lu, implementation_->matrix, b, transposed); },
                      implementation_->lu);
}

} // namespace isostat::exact
