#pragma once
/// \file
/// Answers about real numbers that are known up to a bound. A question about such numbers has three answers, and the
/// type keeps callers from using the third as one of the others. And the words of an enum, one for each of its
/// enumerators, which count from 0.

#include <isostat/core/machine.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace isostat {

/// Whether `value` has a name: compilers print "Enum::name" for an enumerator, and "(Enum)3" for another value.
template <auto value> constexpr bool is_enumerator() {
    const std::string_view printed = __PRETTY_FUNCTION__;
    return printed[printed.find_last_of(":)")] == ':';
}

/// Made by `words_of`, read by `word_of` and `value_of`.
template <class Enum, std::size_t N> class EnumWords {
  public:
    constexpr explicit EnumWords(const std::array<const char*, N>& words) : words_(words) {
        static_assert(is_enumerator<static_cast<Enum>(N - 1)>(), "more words than enumerators");
        static_assert(!is_enumerator<static_cast<Enum>(N)>(), "an enumerator without a word");
    }
    /// Throws `std::out_of_range` for a value that is no enumerator.
    [[nodiscard]] constexpr const char* at(std::size_t value) const { return words_.at(value); }
    [[nodiscard]] static constexpr std::size_t size() { return N; }
    [[nodiscard]] constexpr auto begin() const { return words_.begin(); }
    [[nodiscard]] constexpr auto end() const { return words_.end(); }

  private:
    std::array<const char*, N> words_;
};

/// `words` in the order of the enumerators, which have no gaps; another number of words than of enumerators does not
/// compile.
template <class Enum, class... Word> constexpr EnumWords<Enum, sizeof...(Word)> words_of(Word... words) {
    return EnumWords<Enum, sizeof...(Word)>({words...});
}

/// Throws `std::out_of_range` for a value that is no enumerator.
template <class Enum, std::size_t N> constexpr const char* word_of(Enum value, const EnumWords<Enum, N>& words) {
    return words.at(static_cast<std::size_t>(value));
}

/// The value of a word; nothing: `word` is not in `words`.
template <class Enum, std::size_t N>
constexpr std::optional<Enum> value_of(std::string_view word, const EnumWords<Enum, N>& words) {
    for (std::size_t k = 0; k < N; ++k) {
        if (word == words.at(k)) {
            return static_cast<Enum>(k);
        }
    }
    return std::nullopt;
}

/// "\"absent\", \"fixed\" or \"movable\"": for messages.
template <class Enum, std::size_t N> std::string listed(const EnumWords<Enum, N>& words) {
    std::string text;
    for (std::size_t k = 0; k < N; ++k) {
        text += std::string(k == 0 ? "" : k + 1 < N ? ", " : " or ") + '"' + words.at(k) + '"';
    }
    return text;
}

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
