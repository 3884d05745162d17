#pragma once
/// \file
/// The answers of functions. About real numbers that are known up to a bound a question has three answers (`Verdict`),
/// and the type keeps callers from using the third as one of the others. Why something was not done: bad input and
/// failed input or output are exceptions of one type (`Error`); outcomes of the mechanics or of the arithmetic (no
/// equilibrium, undecided tie, overlap) are values (`Result`; std::expected is C++23); programming errors are
/// assertions. And the words of an enum, one for each of its enumerators, which count from 0.

#include <isostat/core/contact.hpp>
#include <isostat/core/machine.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

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

/// Which exit status an error leads to (the values of sysexits.h). `internal`: this computer or this program has a
/// defect; the error says nothing about the input.
enum class ErrorKind { usage, bad_input, internal, cannot_write };

/// Bad input, or a file that cannot be read or written. `what()` is the complete message: file, line or field, the
/// value found and what was expected.
class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    [[nodiscard]] ErrorKind kind() const { return kind_; }
    /// 64, 65, 70 or 74.
    [[nodiscard]] int exit_status() const {
        switch (kind_) {
        case ErrorKind::usage: return 64;        // exact: sysexits.h, EX_USAGE
        case ErrorKind::bad_input: return 65;    // exact: sysexits.h, EX_DATAERR
        case ErrorKind::internal: return 70;     // 70: exact: sysexits.h, EX_SOFTWARE
        case ErrorKind::cannot_write: return 74; // exact: sysexits.h, EX_IOERR
        }
        return 70;
    }

  private:
    ErrorKind kind_;
};

/// Why a computation has no result. These are outcomes of the mechanics or of the arithmetic, not bad input.
enum class FailureKind {
    not_isostatic, ///< N != N_f, or the rank is smaller
    overlap,       ///< two grains overlap
    tie,           ///< two candidates could not be ordered: several contacts at once
    undecided,     ///< a sign could not be decided with the arithmetic allowed
    no_limit,      ///< the load can grow for ever: nothing opens
    flows,         ///< a dead shear force moves the tilt of a cell without end
    unbounded,     ///< a motion finds no new contact, or a linear programme is unbounded
    not_converged, ///< an iteration stopped short
    cap_reached,   ///< a cap on arcs or strain: the sample fails at this load
    contradiction, ///< what was proved in one way is refuted in another: a defect of the program
    interrupted    ///< stopped by the user
};

/// The word used in records and messages.
const char* to_string(FailureKind kind);

/// Words for a reader, put together on request, and the contacts and disks that they name.
class Words {
  public:
    Words() = default;                                      ///< no words
    Words(std::string fixed);                               // NOLINT(google-explicit-constructor)
    Words(const char* fixed) : Words(std::string(fixed)) {} // NOLINT(google-explicit-constructor)
    /// `make` is given the dimension; it must own all that it needs.
    explicit Words(std::function<std::string(int)> make) : make_(std::move(make)) {}

    std::vector<Contact> contacts; ///< in the order in which they are named
    std::vector<int> disks;        ///< disks that are named by themselves

    [[nodiscard]] bool empty() const { return make_ == nullptr; }
    /// `dimension`: of the grains, which the names of contacts depend on.
    [[nodiscard]] std::string text(int dimension = 2) const { return make_ ? make_(dimension) : std::string(); }
    /// Adds the contacts and disks that these words name.
    void name(const Words& others);
    /// Appends `more`.
    Words& operator+=(const Words& more);

  private:
    std::function<std::string(int)> make_;
};

/// The reason: words with the numbers that were measured, and the contacts or disks concerned.
struct Failure {
    FailureKind kind;
    Words words;

    [[nodiscard]] std::string message(int dimension = 2) const { return words.text(dimension); }
    [[nodiscard]] const std::vector<Contact>& contacts() const { return words.contacts; }
    [[nodiscard]] const std::vector<int>& disks() const { return words.disks; }
};

/// Where a failure happened: put before its message, so that the last line of a run says all.
Failure located(const Failure& failure, Words where);

/// Throws std::logic_error, with the reason why there is no value:
/// a `value()` was asked of a failure, or a `failure()` of a value.
[[noreturn]] void throw_no_value(const Failure& failure);
[[noreturn]] void throw_no_failure();

/// Either a value or a `Failure`. Asking for the alternative that is absent is a defect of the caller: in every build
/// this throws std::logic_error, with the message of the failure if there is one.
template <class T> class [[nodiscard]] Result {
  public:
    Result(T value) : content_(std::in_place_index<0>, std::move(value)) {} // NOLINT(google-explicit-constructor)
    Result(Failure failure)
        : content_(std::in_place_index<1>, std::move(failure)) {} // NOLINT(google-explicit-constructor)
    [[nodiscard]] bool ok() const { return content_.index() == 0; }
    [[nodiscard]] T& value() {
        require_value();
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const T& value() const {
        require_value();
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const Failure& failure() const {
        if (ok()) {
            throw_no_failure();
        }
        return *std::get_if<1>(&content_);
    }

  private:
    void require_value() const {
        if (!ok()) {
            throw_no_value(failure());
        }
    }
    std::variant<T, Failure> content_;
};

} // namespace isostat
