#pragma once
/// \file
/// Answers about real numbers that are known up to a bound. A question about such numbers has three answers, and the
/// type keeps callers from using the third as one of the others.

#include <isostat/core/machine.hpp>
#include <isostat/core/words.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace isostat {

/// The answer of a check.
/// - `proved`: the statement holds, and the function that returned it says by which argument;
/// - `refuted`: the negation of the statement holds;
/// - `undecided`: neither was shown with the arithmetic that was allowed; each of the two may still be true.
/// There is no conversion to bool: compare with the verdict you mean.
enum class Verdict : std::uint8_t { proved, refuted, undecided };

/// The words used in records and messages.
inline constexpr auto verdict_words = words_of<Verdict>("proved", "refuted", "undecided");
constexpr std::string_view to_string(Verdict verdict) {
    return word_of(verdict, verdict_words);
}

/// The arithmetic that settled a decision, in the order in which it is tried.
/// - `combinatorial`: no number was needed (structural zeros);
/// - `double_bound`: double precision with a rigorous error bound smaller than the margin;
/// - `double_double`: residuals and corrections in double-double, same kind of bound;
/// - `multiprecision`: MPFR; `exact`: integers or rationals; `none`: undecided.
enum class Rung : std::uint8_t { combinatorial, double_bound, double_double, multiprecision, exact, none };

/// The words used in records and messages.
inline constexpr auto rung_words = words_of<Rung>("combinatorial", "double", "double-double", "mpfr", "exact", "none");
constexpr std::string_view to_string(Rung rung) {
    return word_of(rung, rung_words);
}

/// The exact value lies in [value - radius, value + radius]. With a NaN nothing is known.
struct Enclosure {
    double value = 0;
    double radius = 0;
    [[nodiscard]] bool positive() const { return value > radius; }
    [[nodiscard]] bool negative() const { return -value > radius; }
    /// True: the sign is proved. False says nothing.
    [[nodiscard]] bool decided() const { return positive() || negative(); }
    /// |value| / radius: above 1 the sign is proved. Infinity when the radius is 0 and the value is not.
    [[nodiscard]] double margin() const { return std::abs(value) / radius; }
};

/// Enclosure of the difference; the rounding of the subtraction is added to the radius (2 ulp).
Enclosure operator-(const Enclosure& a, const Enclosure& b);

} // namespace isostat
