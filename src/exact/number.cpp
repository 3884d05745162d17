#include "exact/terms.hpp"

#include <isostat/core/result.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace isostat::exact {

namespace {

const std::vector<Term>& list_of(const Number& number) {
    static const std::vector<Term> none;
    return number.terms() == nullptr ? none : number.terms()->list;
}

struct Interval {
    mpq_class lower, upper;
};

/// Rational bounds from floor(sqrt(d) 2^bits) <= sqrt(d) 2^bits < floor + 1.
Interval bounds(const std::vector<Term>& list, unsigned long bits) {
    Interval sum;
    mpz_class scale = 1;
    scale <<= bits;
    for (const Term& term : list) {
        if (term.radicand == 1) {
            sum.lower += term.coefficient;
            sum.upper += term.coefficient;
            continue;
        }
        mpz_class shifted = term.radicand;
        shifted <<= 2 * bits;
        const mpz_class floor = ::sqrt(shifted);
        mpq_class below(floor, scale);
        mpq_class above(floor + 1, scale);
        below.canonicalize();
        above.canonicalize();
        const bool positive = term.coefficient > 0;
        sum.lower += term.coefficient * (positive ? below : above);
        sum.upper += term.coefficient * (positive ? above : below);
    }
    return sum;
}

/// Returns (u, v) with x = u + v sqrt(b), where no radicand of u and v shares a factor with b.
/// \pre b divides each radicand or is coprime to it.
std::pair<Number, Number> split(const std::vector<Term>& list, const mpz_class& b) {
    std::vector<Term> without, with;
    for (const Term& term : list) {
        if (mpz_divisible_p(term.radicand.get_mpz_t(), b.get_mpz_t()) != 0) {
            with.push_back({term.radicand / b, term.coefficient});
        } else {
            without.push_back(term);
        }
    }
    return {make_number(std::move(without)), make_number(std::move(with))};
}

} // namespace

Number make_number(std::vector<Term> list) {
    std::ranges::sort(list, [](const Term& a, const Term& b) { return a.radicand < b.radicand; });
    Terms terms;
    for (Term& term : list) {
        if (!terms.list.empty() && terms.list.back().radicand == term.radicand) {
            terms.list.back().coefficient += term.coefficient;
        } else {
            terms.list.push_back(std::move(term));
        }
    }
    std::erase_if(terms.list, [](const Term& term) { return term.coefficient == 0; });
    return terms.list.empty() ? Number() : Number(std::make_shared<const Terms>(std::move(terms)));
}

Number make_rational(const mpq_class& value) {
    return value == 0 ? Number() : make_number({{1, value}});
}

std::pair<mpz_class, mpz_class> square_free_part(mpz_class value) {
    assert(value > 0);
    mpz_class root = 1, free = 1;
    const auto take = [&](const mpz_class& prime) {
        const mp_bitcnt_t times = mpz_remove(value.get_mpz_t(), value.get_mpz_t(), prime.get_mpz_t());
        for (mp_bitcnt_t k = 0; k < times / 2; ++k) {
            root *= prime;
        }
        if (times % 2 == 1) {
            free *= prime;
        }
    };
    // A cofactor without a prime factor up to `limit` and below limit^3 is 1, a prime, a square of a prime or a product
    // of two primes.
    constexpr unsigned long limit = 1000000;
    for (unsigned long prime = 2; prime <= limit && value > 1; prime += prime == 2 ? 1 : 2) {
        if (mpz_divisible_ui_p(value.get_mpz_t(), prime) != 0) {
            take(prime);
        }
        if (prime * prime * prime > value) {
            break;
        }
    }
    if (mpz_perfect_square_p(value.get_mpz_t()) != 0) {
        root *= ::sqrt(value);
        return {root, free};
    }
    const mpz_class largest = mpz_class(limit) * limit * limit;
    if (value > largest) {
        throw Error(ErrorKind::bad_input,
                    "the square-free part of a radicand cannot be found: its factor " + value.get_str() +
                        " has no prime factor below 10^6; expected a smaller or smoother radicand");
    }
    return {root, free * value};
}

std::vector<mpz_class> coprime_base(const std::vector<mpz_class>& square_free) {
    std::vector<mpz_class> base;
    std::vector<mpz_class> waiting = square_free;
    while (!waiting.empty()) {
        mpz_class next = std::move(waiting.back());
        waiting.pop_back();
        for (std::size_t k = 0; k < base.size() && next > 1; ++k) {
            const mpz_class common = gcd(next, base[k]);
            if (common == 1) {
                continue;
            }
            if (common != base[k]) {
                waiting.push_back(base[k] / common);
                base[k] = common;
            }
            next /= common;
        }
        if (next > 1) {
            base.push_back(std::move(next));
        }
    }
    std::ranges::sort(base);
    return base;
}

Number::Number(long long integer) {
    if (integer != 0) {
        mpz_class value = static_cast<long>(integer);
        static_assert(sizeof(long) == sizeof(long long));
        terms_ = make_rational(value).terms_;
    }
}

Number Number::from_double(double value) {
    assert(std::isfinite(value));
    return make_rational(mpq_class(value));
}

bool Number::is_rational() const {
    const auto& list = list_of(*this);
    return list.empty() || (list.size() == 1 && list.front().radicand == 1);
}

int Number::sign() const {
    const auto& list = list_of(*this);
    if (list.empty()) {
        return 0;
    }
    bool up = true, down = true;
    for (const Term& term : list) {
        (term.coefficient > 0 ? down : up) = false;
    }
    if (up || down) {
        return up ? 1 : -1;
    }
    for (unsigned long bits = 64;; bits *= 2) { // ends because the number is not zero
        const Interval interval = bounds(list, bits);
        if (interval.lower > 0) {
            return 1;
        }
        if (interval.upper < 0) {
            return -1;
        }
    }
}

Enclosure Number::enclosure() const {
    const auto& list = list_of(*this);
    if (list.empty()) {
        return {0, 0};
    }
    Interval interval;
    // Refines until the width is below 2^-60 of the value, which ends because the number is not zero.
    for (unsigned long bits = 128;; bits *= 2) {
        interval = bounds(list, bits);
        const mpq_class width = (interval.upper - interval.lower) * mpq_class(mpz_class(1) << 60);
        if (width <= abs(interval.lower) && width <= abs(interval.upper)) {
            break;
        }
    }
    const mpq_class middle = (interval.lower + interval.upper) / 2;
    const double value = middle.get_d(); // truncated
    if (!std::isfinite(value) || abs(middle) > std::numeric_limits<double>::max()) {
        return {middle > 0 ? std::numeric_limits<double>::max() : -std::numeric_limits<double>::max(),
                std::numeric_limits<double>::infinity()};
    }
    const mpq_class stored(value);
    const mpq_class above = abs(interval.upper - stored);
    const mpq_class below = abs(interval.lower - stored);
    const mpq_class& error = above > below ? above : below;
    const double radius = error == 0 ? 0 : std::nextafter(error.get_d(), std::numeric_limits<double>::infinity());
    return {value, radius};
}

std::string Number::text() const {
    const auto& list = list_of(*this);
    if (list.empty()) {
        return "0";
    }
    std::string out;
    for (const Term& term : list) {
        const mpq_class size = abs(term.coefficient);
        const bool negative = term.coefficient < 0;
        out += out.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
        const std::string root = "sqrt(" + term.radicand.get_str() + ")";
        if (term.radicand == 1) {
            out += size.get_str();
        } else {
            out += size == 1 ? root : size.get_str() + "*" + root;
        }
    }
    return out;
}

std::vector<std::string> Number::radicands() const {
    std::vector<std::string> out;
    for (const Term& term : list_of(*this)) {
        out.push_back(term.radicand.get_str());
    }
    return out;
}

Number Number::operator-() const {
    std::vector<Term> list = list_of(*this);
    for (Term& term : list) {
        term.coefficient = -term.coefficient;
    }
    return make_number(std::move(list));
}

Number operator+(const Number& a, const Number& b) {
    if (a.is_zero() || b.is_zero()) {
        return a.is_zero() ? b : a;
    }
    std::vector<Term> list = list_of(a);
    list.insert(list.end(), list_of(b).begin(), list_of(b).end());
    return make_number(std::move(list));
}

Number operator-(const Number& a, const Number& b) {
    return b.is_zero() ? a : a + -b;
}

Number operator*(const Number& a, const Number& b) {
    std::vector<Term> list;
    list.reserve(list_of(a).size() * list_of(b).size());
    for (const Term& s : list_of(a)) {
        for (const Term& t : list_of(b)) {
            // sqrt(g a') sqrt(g b') = g sqrt(a' b'), and a' b' is square-free again.
            const mpz_class common = gcd(s.radicand, t.radicand);
            list.push_back({s.radicand / common * (t.radicand / common), s.coefficient * t.coefficient * common});
        }
    }
    return make_number(std::move(list));
}

bool operator==(const Number& a, const Number& b) {
    const auto& s = list_of(a);
    const auto& t = list_of(b);
    return std::ranges::equal(
        s, t, [](const Term& x, const Term& y) { return x.radicand == y.radicand && x.coefficient == y.coefficient; });
}

Number Number::inverse() const {
    assert(!is_zero());
    const auto& list = list_of(*this);
    if (list.size() == 1) { // 1 / (c sqrt(d)) = sqrt(d) / (c d)
        return make_number({{list[0].radicand, 1 / (list[0].coefficient * list[0].radicand)}});
    }
    std::vector<mpz_class> square_free;
    for (const Term& term : list) {
        square_free.push_back(term.radicand);
    }
    const mpz_class b = coprime_base(square_free).front();
    const auto [u, v] = split(list, b);
    // The norm u^2 - b v^2 has one independent radicand less; it is not 0: sqrt(b) is not in the field of u and v.
    const Number norm = u * u - make_rational(mpq_class(b)) * v * v;
    return (u - v * make_number({{b, 1}})) * norm.inverse();
}

Number sqrt(const Number& rational) {
    if (!rational.is_rational()) {
        throw Error(ErrorKind::bad_input,
                    "nested root sqrt(" + rational.text() + "); expected a rational number under the root");
    }
    if (rational.is_zero()) {
        return {};
    }
    const mpq_class& q = list_of(rational).front().coefficient;
    if (q < 0) {
        throw Error(ErrorKind::bad_input, "square root of the negative number " + q.get_str() +
                                              "; expected a non-negative rational under the root");
    }
    // Numerator and denominator are coprime, so that each is factored by itself, which is cheaper.
    const auto [a, c] = square_free_part(q.get_num());
    const auto [b, d] = square_free_part(q.get_den());
    mpq_class coefficient(a, b * d);
    coefficient.canonicalize();
    return make_number({{c * d, coefficient}});
}

} // namespace isostat::exact
