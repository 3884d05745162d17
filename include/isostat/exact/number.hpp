#pragma once
/// \file
/// Real numbers kept exactly: sums of rationals times square roots of rationals (multi-quadratic numbers).

#include <isostat/core/verdict.hpp>

#include <compare>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace isostat::exact {

struct Terms; // sorted pairs (square-free positive integer d, non-zero rational c); private to the room

/// The exact real sum over d of c_d sqrt(d), with rational c_d != 0 and distinct square-free positive integers d.
///
/// The square roots of distinct square-free integers are linearly independent over Q, so this form is unique: a number
/// is zero exactly when it has no term, and equality is equality of the terms. Every operation returns this form; none
/// rounds. Immutable value, copies share their terms (thread-safe). Cost: + and - linear in the terms, * quadratic, /
/// exponential in the number of independent radicands (2 for Q(sqrt 3), 4 for Q(sqrt 2, sqrt 3)).
class Number {
  public:
    Number() = default;                                               ///< 0
    Number(long long integer);                                        // NOLINT(google-explicit-constructor)
    Number(long integer) : Number(static_cast<long long>(integer)) {} // NOLINT(google-explicit-constructor)
    Number(int integer) : Number(static_cast<long long>(integer)) {}  // NOLINT(google-explicit-constructor)
    explicit Number(std::shared_ptr<const Terms> terms) : terms_(std::move(terms)) {} ///< canonical terms; null = 0

    /// The dyadic rational that a finite double is. \pre finite
    static Number from_double(double value);

    /// Reads the text form: sums and differences of products and quotients of numbers and `sqrt(q)`:
    /// `0.1` (one tenth), `1e-3`, `7/3`, `0x1.8p+3` (hex float, exact), `1/2*sqrt(3)`, `1 + 3/2*sqrt(2) - sqrt(5/7)`,
    /// `sqrt(3)/2`. Under the root: one non-negative number or quotient of two. Spaces may stand between the tokens.
    /// Throws `Error(bad_input)` with the text, the position (from 1) and what was expected there, for anything else:
    /// nested roots, other functions, parentheses, trailing text, inf and nan, division by zero, exponents beyond
    /// +-10000, and a radicand from which no square-free part can be found (a factor above 10^18 left after the small
    /// primes).
    static Number parse(std::string_view text);

    [[nodiscard]] bool is_zero() const { return terms_ == nullptr; }
    [[nodiscard]] bool is_rational() const;
    /// -1, 0 or 1, always decided: zero by the form, otherwise by rational enclosures refined until they exclude 0.
    [[nodiscard]] int sign() const;
    /// A double enclosure; the radius is below 1 ulp of the value and is 0 when the value is a double. Infinite radius
    /// beyond the range of double.
    [[nodiscard]] Enclosure enclosure() const;
    /// Nearest double up to 1 ulp.
    [[nodiscard]] double to_double() const { return enclosure().value; }
    /// Text that `parse` reads back to the same number: `0`, `-7/3`, `1/2*sqrt(3)`, `1 - 3/2*sqrt(2)`.
    [[nodiscard]] std::string text() const;
    /// The radicands d of the terms, decimal.
    [[nodiscard]] std::vector<std::string> radicands() const;

    /// 1 / this. \pre not zero
    [[nodiscard]] Number inverse() const;
    Number operator-() const;
    friend Number operator+(const Number& a, const Number& b);
    friend Number operator-(const Number& a, const Number& b);
    friend Number operator*(const Number& a, const Number& b);
    /// \pre b is not zero
    friend Number operator/(const Number& a, const Number& b) { return a * b.inverse(); }
    Number& operator+=(const Number& b) { return *this = *this + b; }
    Number& operator-=(const Number& b) { return *this = *this - b; }
    Number& operator*=(const Number& b) { return *this = *this * b; }
    friend bool operator==(const Number& a, const Number& b);
    friend std::strong_ordering operator<=>(const Number& a, const Number& b) { return (a - b).sign() <=> 0; }

    /// For the room's own files.
    [[nodiscard]] const Terms* terms() const { return terms_.get(); }

  private:
    std::shared_ptr<const Terms> terms_;
};

/// The non-negative square root of a non-negative rational, in canonical form: sqrt(p/q) = sqrt(p q) / q with the
/// square part taken out. Throws `Error(bad_input)` when the number is negative, is not rational (nested root), or
/// cannot be factored (see `Number::parse`).
Number sqrt(const Number& rational);

} // namespace isostat::exact
