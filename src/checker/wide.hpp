#pragma once
/// \file
/// Integers of 128 and 256 bits, which take no memory of their own, and lengths, which are integers of 128 bits where
/// all of them fit.

#include "checker/rational.hpp"

#include <array>
#include <cstdint>
#include <type_traits>

namespace isostat::checker {

__extension__ using Wide = __int128;
__extension__ using WideMagnitude = unsigned __int128;

inline WideMagnitude magnitude(Wide value) {
    return value < 0 ? -static_cast<WideMagnitude>(value) : static_cast<WideMagnitude>(value);
}

/// To some units: this is three times as fast as the conversion of the compiler's library.
inline double as_double(Wide value) {
    const auto low = static_cast<std::int64_t>(static_cast<std::uint64_t>(value) >> 1U);
    return 0x1p64 * static_cast<double>(static_cast<std::int64_t>(value >> 64U)) + 2 * static_cast<double>(low);
}

/// 256 bits, in two's complement. Nothing is checked: whoever adds knows that sums stay below 2^255.
struct Broad {
    WideMagnitude low = 0;
    Wide high = 0;

    Broad() = default;
    explicit Broad(Wide value) : low(static_cast<WideMagnitude>(value)), high(value < 0 ? -1 : 0) {}
    [[nodiscard]] bool negative() const { return high < 0; }
    Broad& operator+=(const Broad& other) {
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

inline Broad magnitude(const Broad& value) {
    Broad result;
    value.negative() ? result -= value : result += value;
    return result;
}

// What follows is there for `Integer` too, so that one source serves both.

inline long bits(WideMagnitude value) {
    const auto high = static_cast<std::uint64_t>(value >> 64U);
    return high != 0    ? 128 - __builtin_clzll(high)
           : value != 0 ? 64 - __builtin_clzll(static_cast<std::uint64_t>(value))
                        : 0;
}
inline long bits(Wide value) {
    return bits(magnitude(value));
}
inline long bits(const Broad& value) {
    const Broad size = magnitude(value);
    return size.high != 0 ? 128 + bits(size.high) : bits(size.low);
}

inline double approximate(const Broad& value, long exponent) {
    const Broad size = magnitude(value);
    const auto sum = [](WideMagnitude of) {
        return 0x1p64 * static_cast<double>(static_cast<std::uint64_t>(of >> 64U)) +
               static_cast<double>(static_cast<std::uint64_t>(of));
    };
    const double all = 0x1p128 * sum(static_cast<WideMagnitude>(size.high)) + sum(size.low);
    return std::ldexp(value.negative() ? -all : all, static_cast<int>(exponent));
}
inline double approximate(Wide value, long exponent) {
    return approximate(Broad(value), exponent);
}

/// a times b. \pre both are below 2^126
inline void multiply(Broad& product, Wide a, Wide b) {
    const auto low_a = static_cast<std::uint64_t>(a);
    const auto low_b = static_cast<std::uint64_t>(b);
    const Wide high_a = a >> 64U;
    const Wide high_b = b >> 64U;
    const Wide middle = high_a * low_b + high_b * low_a;
    product.low = static_cast<WideMagnitude>(low_a) * low_b;
    product.high = high_a * high_b;
    Broad rest;
    rest.low = static_cast<WideMagnitude>(middle) << 64U;
    rest.high = middle >> 64U;
    product += rest;
}
inline void multiply(Integer& product, const Integer& a, const Integer& b) {
    product = a * b;
}

/// value * 2^shift. \pre it is below 2^255
inline void shift_left(Broad& result, Wide value, long shift) {
    const auto by = static_cast<unsigned>(shift);
    result = Broad(value);
    if (by >= 128) {
        result.high = static_cast<Wide>(result.low << (by - 128));
        result.low = 0;
    } else if (by > 0) {
        result.high = static_cast<Wide>((static_cast<WideMagnitude>(result.high) << by) | (result.low >> (128 - by)));
        result.low <<= by;
    }
}
inline void shift_left(Integer& result, const Integer& value, long shift) {
    mpz_mul_2exp(result.get_mpz_t(), value.get_mpz_t(), static_cast<mp_bitcnt_t>(shift));
}

/// times * value
inline Broad operator*(int times, const Broad& value) {
    Broad result;
    for (int k = 0; k < std::abs(times); ++k) { // seldom more than two
        times < 0 ? result -= value : result += value;
    }
    return result;
}

inline Integer magnitude(const Integer& value) {
    return abs(value);
}
/// The largest magnitude.
inline Broad largest_of(const std::vector<Broad>& values) {
    Broad largest;
    for (const Broad& value : values) {
        const Broad size = magnitude(value);
        largest = largest < size ? size : largest;
    }
    return largest;
}

/// An integer that fits.
template <class Number> Number number(const Integer& value);
template <> inline Integer number<Integer>(const Integer& value) {
    return value;
}
template <> inline Broad number<Broad>(const Integer& value) {
    std::array<std::uint64_t, 4> limb{};
    mpz_export(limb.data(), nullptr, -1, sizeof(std::uint64_t), 0, 0, value.get_mpz_t());
    constexpr unsigned half = 64;
    Broad size;
    size.low = limb[0] | static_cast<WideMagnitude>(limb[1]) << half;
    size.high = static_cast<Wide>(limb[2] | static_cast<WideMagnitude>(limb[3]) << half);
    return value < 0 ? Broad() -= size : size;
}
template <> inline Wide number<Wide>(const Integer& value) {
    return static_cast<Wide>(number<Broad>(value).low);
}

inline const Integer& integer_of(const Integer& value) {
    return value;
}
inline Integer integer_of(const Broad& value) {
    const Broad size = magnitude(value);
    const std::array<std::uint64_t, 4> limb{
        static_cast<std::uint64_t>(size.low), static_cast<std::uint64_t>(size.low >> 64U),
        static_cast<std::uint64_t>(size.high), static_cast<std::uint64_t>(size.high >> 64U)};
    Integer result;
    mpz_import(result.get_mpz_t(), limb.size(), -1, sizeof(std::uint64_t), 0, 0, limb.data());
    return value.negative() ? Integer(-result) : result;
}
inline Integer integer_of(Wide value) {
    return integer_of(Broad(value));
}
inline Integer integer_of(WideMagnitude value) {
    Broad same;
    same.low = value;
    return integer_of(same);
}

/// Of products of such numbers.
template <class Number> using Product = std::conditional_t<std::is_same_v<Number, Wide>, Broad, Integer>;

/// Bits of the largest magnitude.
template <class Number> long most_bits(const std::vector<Number>& values) {
    long most = 0;
    for (const Number& value : values) {
        most = std::max(most, bits(value));
    }
    return most;
}

/// Numbers of 128 bits, or of any size.
class Lengths {
  public:
    Lengths() = default;
    Lengths(std::vector<Wide> numbers) : narrow_(std::move(numbers)) {} // NOLINT: the same numbers
    Lengths(std::vector<Integer> numbers) : any_(std::move(numbers)) {} // NOLINT
    operator std::vector<Integer>() const {                             // NOLINT
        std::vector<Integer> numbers;
        for (std::size_t k = 0; k < size(); ++k) {
            numbers.push_back((*this)[k]);
        }
        return numbers;
    }
    [[nodiscard]] bool narrow() const { return !narrow_.empty(); }
    [[nodiscard]] std::size_t size() const { return narrow_.size() + any_.size(); }
    [[nodiscard]] Integer operator[](std::size_t k) const { return narrow_.empty() ? any_[k] : integer_of(narrow_[k]); }
    /// An element times 2^exponent, as an approximation; all of them.
    [[nodiscard]] double near(std::size_t k, long exponent) const {
        return narrow_.empty() ? approximate(any_[k], exponent) : approximate(narrow_[k], exponent);
    }
    [[nodiscard]] std::vector<double> near(long exponent) const {
        std::vector<double> numbers(size());
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            numbers[k] = near(k, exponent);
        }
        return numbers;
    }
    /// Bits of the largest magnitude.
    [[nodiscard]] long most_bits() const { return std::max(checker::most_bits(narrow_), checker::most_bits(any_)); }
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
