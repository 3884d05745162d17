#pragma once
/// \file
/// Integers of 128 and 256 bits, which take no memory of their own. The functions here are there for `Integer` too, so
/// that one source serves numbers of either kind.

#include "checker/rational.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

// exact: all other numbers of this file: half of 128 bits

namespace isostat::checker {

__extension__ using Wide = __int128;
__extension__ using WideMagnitude = unsigned __int128;

/// 256 bits, in two's complement. Nothing is checked: whoever adds knows that sums stay below 2^255.
struct Broad {
    Wide high = 0;
    WideMagnitude low = 0;

    Broad() = default;
    explicit Broad(Wide value) : high(value < 0 ? -1 : 0), low(static_cast<WideMagnitude>(value)) {}
    Broad& operator+=(Broad other) { // by value: of itself too
        low += other.low;
        high += other.high + (low < other.low ? 1 : 0);
        return *this;
    }
    Broad& operator-=(const Broad& other) {
        high -= other.high + (low < other.low ? 1 : 0);
        low -= other.low;
        return *this;
    }
    friend bool operator<(const Broad& a, const Broad& b) { return a.high != b.high ? a.high < b.high : a.low < b.low; }
};

/// Of products of such numbers.
template <class Number> using Product = std::conditional_t<std::is_same_v<Number, Wide>, Broad, Integer>;

inline WideMagnitude magnitude(Wide value) {
    return value < 0 ? -static_cast<WideMagnitude>(value) : static_cast<WideMagnitude>(value);
}
inline Broad magnitude(const Broad& value) {
    return value.high < 0 ? Broad() -= value : value;
}
inline Integer magnitude(const Integer& value) {
    return abs(value);
}

inline long bits(Wide value) {
    const WideMagnitude size = magnitude(value);
    const auto high = static_cast<std::uint64_t>(size >> 64U);
    return static_cast<long>(high != 0 ? 64 + std::bit_width(high) : std::bit_width(static_cast<std::uint64_t>(size)));
}
inline long bits(const Broad& value) {
    const Broad size = magnitude(value);
    // exact: the sign of 128 bits
    const bool top = size.low >> 127U != 0; // of the lower half, which `bits` would take for a sign
    // exact: half of 256 bits
    return size.high != 0 ? 128 + bits(size.high) : top ? 128 : bits(static_cast<Wide>(size.low));
}
/// Bits of the largest magnitude.
template <class Number> long most_bits(const std::vector<Number>& values) {
    long most = 0;
    for (const Number& value : values) {
        most = std::max(most, bits(value));
    }
    return most;
}

/// To some units: this is three times as fast as the conversion of the compiler's library.
inline double as_double(Wide value) {
    const auto low = static_cast<std::int64_t>(static_cast<std::uint64_t>(value) >> 1U);
    return 0x1p64 * static_cast<double>(static_cast<std::int64_t>(value >> 64U)) + 2 * static_cast<double>(low);
}
inline double approximate(const Broad& value, long exponent) {
    const Broad size = magnitude(value);
    const auto sum = [](WideMagnitude of) {
        return 0x1p64 * static_cast<double>(static_cast<std::uint64_t>(of >> 64U)) +
               static_cast<double>(static_cast<std::uint64_t>(of));
    };
    const double all = 0x1p128 * sum(static_cast<WideMagnitude>(size.high)) + sum(size.low); // exact: half of 256 bits
    return times_power(value.high < 0 ? -all : all, exponent);
}

/// a times b. \pre both are below 2^126
inline void multiply(Broad& product, Wide a, Wide b) {
    const auto low_a = static_cast<std::uint64_t>(a);
    const auto low_b = static_cast<std::uint64_t>(b);
    const Wide high_a = a >> 64U;
    const Wide high_b = b >> 64U;
    Broad middle(high_a * low_b + high_b * low_a);
    product.high = high_a * high_b + (static_cast<Wide>(middle.low) >> 64U);
    product.low = middle.low << 64U;
    middle = Broad();
    middle.low = static_cast<WideMagnitude>(low_a) * low_b;
    product += middle;
}
inline void multiply(Integer& product, const Integer& a, const Integer& b) {
    product = a * b;
}

/// \pre the value fits.
template <class Number> Number number(const Integer& value) {
    if constexpr (std::is_same_v<Number, Integer>) {
        return value;
    } else {
        std::array<WideMagnitude, 2> halves{};
        mpz_export(halves.data(), nullptr, -1, sizeof(WideMagnitude), 0, 0, value.get_mpz_t());
        Broad size;
        size.low = halves[0];
        size.high = static_cast<Wide>(halves[1]);
        const Broad exact = value < 0 ? Broad() -= size : size;
        if constexpr (std::is_same_v<Number, Broad>) {
            return exact;
        } else {
            return static_cast<Wide>(exact.low);
        }
    }
}
inline const Integer& integer_of(const Integer& value) {
    return value;
}
inline Integer integer_of(const Broad& value) {
    const Broad size = magnitude(value);
    const std::array<WideMagnitude, 2> halves{size.low, static_cast<WideMagnitude>(size.high)};
    Integer result;
    mpz_import(result.get_mpz_t(), halves.size(), -1, sizeof(WideMagnitude), 0, 0, halves.data());
    return value.high < 0 ? Integer(-result) : result;
}
inline Integer integer_of(Wide value) {
    return integer_of(Broad(value));
}

/// The largest magnitude.
template <class Number> Integer largest_of(const std::vector<Number>& values) {
    Number largest = Number();
    for (const Number& value : values) {
        const auto size = static_cast<Number>(magnitude(value));
        largest = largest < size ? size : largest;
    }
    return integer_of(largest);
}

/// Numbers of 128 bits where all of them fit, or of any size.
class Lengths {
  public:
    Lengths() = default;
    Lengths(std::vector<Wide> numbers) : narrow_(std::move(numbers)) {} // NOLINT: the same numbers
    Lengths(std::vector<Integer> numbers) : any_(std::move(numbers)) {} // NOLINT
    operator std::vector<Integer>() const {                             // NOLINT
        std::vector<Integer> numbers = any_;
        for (const Wide number : narrow_) {
            numbers.push_back(integer_of(number));
        }
        return numbers;
    }
    [[nodiscard]] bool narrow() const { return !narrow_.empty(); }
    [[nodiscard]] std::size_t size() const { return narrow_.size() + any_.size(); }
    [[nodiscard]] Integer operator[](std::size_t k) const { return narrow() ? integer_of(narrow_[k]) : any_[k]; }
    [[nodiscard]] long most_bits() const { return std::max(checker::most_bits(narrow_), checker::most_bits(any_)); }
    /// An element times 2^exponent, as an approximation; all of them.
    [[nodiscard]] double near(std::size_t k, long exponent) const {
        return narrow() ? approximate(Broad(narrow_[k]), exponent) : approximate(any_[k], exponent);
    }
    [[nodiscard]] std::vector<double> near(long exponent) const {
        std::vector<double> numbers(size());
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            numbers[k] = near(k, exponent);
        }
        return numbers;
    }
    /// \pre they are of this kind.
    template <class Number> [[nodiscard]] const std::vector<Number>& in() const {
        if constexpr (std::is_same_v<Number, Wide>) {
            return narrow_;
        } else {
            return any_;
        }
    }

  private:
    std::vector<Wide> narrow_;
    std::vector<Integer> any_;
};

} // namespace isostat::checker
