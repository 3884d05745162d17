#pragma once
/// \file
/// Exact numbers of the checker: GMP integers, rationals, and ranges
/// of rationals. Only quotients of ranges are rounded, outwards.

#include <gmpxx.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace isostat::checker {

using Integer = mpz_class;
using Rational = mpq_class;

/// Multiplies by 2^exponent.
inline void scale(Rational& value, long exponent) {
    if (exponent >= 0) {
        mpq_mul_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
    } else {
        mpq_div_2exp(value.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
    }
}
/// value * 2^exponent.
inline Rational dyadic(const Integer& value, long exponent) {
    Rational result(value);
    scale(result, exponent);
    return result;
}

/// The quotient value * 2^exponent as a division of GMP rounds it.
template <auto Division> Integer rounded(const Rational& value, long exponent) {
    Integer result = value.get_num();
    Integer divisor = value.get_den();
    Integer& longer = exponent >= 0 ? result : divisor;
    mpz_mul_2exp(longer.get_mpz_t(), longer.get_mpz_t(), static_cast<mp_bitcnt_t>(std::abs(exponent)));
    Division(result.get_mpz_t(), result.get_mpz_t(), divisor.get_mpz_t());
    return result;
}
/// The largest integer that is at most value * 2^exponent.
inline Integer floor_of(const Rational& value, long exponent = 0) {
    return rounded<mpz_fdiv_q>(value, exponent);
}
/// The smallest integer that is at least value * 2^exponent.
inline Integer ceiling_of(const Rational& value, long exponent = 0) {
    return rounded<mpz_cdiv_q>(value, exponent);
}

inline Integer shifted_left(const Integer& value, long bits) {
    Integer result;
    mpz_mul_2exp(result.get_mpz_t(), value.get_mpz_t(), static_cast<mp_bitcnt_t>(bits));
    return result;
}

/// The number of bits of |value|.
inline long bits(const Integer& value) {
    return value == 0 ? 0 : static_cast<long>(mpz_sizeinbase(value.get_mpz_t(), 2));
}

/// 2^exponent.
inline Rational power_of_two(long exponent) {
    return dyadic(1, exponent);
}

/// value * 2^exponent as `std::ldexp` rounds it, without a call: there are millions.
inline double times_power(double value, long exponent) {
    // 1023: exact: the bias of the exponent of a double; 1024: exact: the first exponent that no double has
    const bool normal = exponent > -1023 && exponent < 1024;
    // exact: bits of the fraction of a double
    const auto bits_of = [](long e) { return static_cast<std::uint64_t>(e + 1023) << 52U; };
    return normal ? value * std::bit_cast<double>(bits_of(exponent)) : std::ldexp(value, static_cast<int>(exponent));
}

/// An integer times 2^exponent, as an approximation (for solvers that are not trusted).
inline double approximate(const Integer& value, long exponent) {
    long own = 0;
    const double mantissa = mpz_get_d_2exp(&own, value.get_mpz_t());
    // exact: beyond the exponents of doubles
    return std::ldexp(mantissa, static_cast<int>(std::min<long>(std::max<long>(own + exponent, -5000), 5000)));
}

/// A double that is at least a rational, and at most one step above it
/// (or the smallest normal number, for smaller rationals; or infinity).
inline double rounded_up(const Rational& value) {
    constexpr double largest = std::numeric_limits<double>::max();
    if (value > Rational(largest)) {
        return std::numeric_limits<double>::infinity();
    }
    if (value < Rational(-largest)) {
        return -largest;
    }
    double near = value.get_d();
    if (Rational(near) < value) {
        near = std::nextafter(near, std::numeric_limits<double>::infinity());
    }
    return Rational(near) < value ? std::numeric_limits<double>::min() : near;
}
inline double rounded_down(const Rational& value) {
    return -rounded_up(-value);
}

/// Above a rational by less than 2^-250 of it: a quotient becomes a binary fraction, which speeds up later operations.
inline Rational short_above(const Rational& value) {
    if (value == 0) {
        return value;
    }
    // exact: bits of a rounded ratio, direction known
    const long shift = 256 - bits(value.get_num()) + bits(value.get_den());
    return dyadic(ceiling_of(value, shift), -shift);
}

/// All numbers from lower to upper.
struct Range {
    Rational lower;
    Rational upper;
    Range() = default;
    explicit Range(const Rational& value) : lower(value), upper(value) {}
    Range(Rational from, Rational to) : lower(std::move(from)), upper(std::move(to)) {}
    static Range around(const Rational& middle, const Rational& radius) { return {middle - radius, middle + radius}; }
    [[nodiscard]] bool positive() const { return lower > 0; }
    [[nodiscard]] bool negative() const { return upper < 0; }
    [[nodiscard]] bool has_zero() const { return lower <= 0 && upper >= 0; }
};

inline Range operator+(const Range& a, const Range& b) {
    return {a.lower + b.lower, a.upper + b.upper};
}
inline Range operator-(const Range& a, const Range& b) {
    return {a.lower - b.upper, a.upper - b.lower};
}
inline Range operator-(const Range& a) {
    return {-a.upper, -a.lower};
}
inline Range operator*(const Range& a, const Range& b) {
    const Rational p = a.lower * b.lower;
    const Rational q = a.lower * b.upper;
    const Rational r = a.upper * b.lower;
    const Rational s = a.upper * b.upper;
    return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
/// A narrow range that contains the quotient. \pre !b.has_zero()
inline Range operator/(const Range& a, const Range& b) {
    const Range exact = a * Range(1 / b.upper, 1 / b.lower);
    return {-short_above(-exact.lower), short_above(exact.upper)};
}

/// A narrow range that contains ln of all numbers of the range (K27, proofs/checker.md). \pre x.positive()
Range logarithm(const Range& x);

} // namespace isostat::checker
