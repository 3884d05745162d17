#pragma once
// Arithmetic mod p = 2^bits - 1 (bits = 61, 31) on unreduced words: the bounds are part of each function's contract.

#include "exact/rank.hpp"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace isostat::exact {

__extension__ using Wide = unsigned __int128;

/// `Value` holds residues; `Word` holds any number congruent to one. All words that the functions return are below
/// 2^64, so that nothing overflows as long as the preconditions hold.
template <int Bits> struct Field {
    static_assert(Bits == 61 || Bits == 31);
    using Value = std::conditional_t<Bits == 61, std::uint64_t, std::uint32_t>;
    using Word = std::uint64_t;
    static constexpr Word p = (Word{1} << Bits) - 1;

    /// The residue in [0, p) of any word.
    static Value canonical(Word x) {
        x = fold(x);
        if constexpr (Bits == 31) {
            x = fold(x); // the first fold leaves 34 bits
        }
        return static_cast<Value>(x >= p ? x - p : x);
    }

    static Value multiply(Value a, Value b) {
        if constexpr (Bits == 61) {
            return canonical(fold_wide(static_cast<Wide>(a) * b));
        } else {
            return canonical(static_cast<Word>(a) * b);
        }
    }

    static Value negate(Value a) { return a == 0 ? a : static_cast<Value>(p - a); }

    /// x + sum over k of l[k][q] * factor[k], one reduction for all, for residues l and factor.
    /// \pre x below 2^61 + 7 (61 bits) or 2^34 (31 bits). The result has the same bound.
    template <std::size_t Columns>
    static Word add_products(Word x, const std::array<const Value*, Columns>& l,
                             const std::array<Value, Columns>& factor, std::ptrdiff_t q) {
        static_assert(Columns <= 4);
        if constexpr (Bits == 61) {
            // Four products are below 2^124; folded below 5 * 2^61, with x below 2^64.
            Wide sum = 0;
            unroll<Columns>([&](auto k) { sum += static_cast<Wide>(l[k][q]) * factor[k]; });
            return fold(x + fold_wide(sum));
        } else {
            // Four products are below 4 (2^31 - 2)^2 = 2^64 - 2^35 + 16.
            Word sum = 0;
            unroll<Columns>([&](auto k) { sum += static_cast<Word>(l[k][q]) * factor[k]; });
            return fold(x + fold(sum));
        }
    }

    /// 1 / a. Binary extended Euclid without reductions (Kaliski's almost inverse): a r = -e u 2^k and a s = e v 2^k
    /// mod p with e = +-1, u s + v r = p, so that nothing overflows. At u = v = 1 only 2^k is left to divide by, a
    /// rotation. No unpredictable branch. \pre 0 < a < p.
    static Value inverse(Value a) {
        assert(a != 0 && a < p);
        Word u = p;
        int k = std::countr_zero(a);
        Word v = a >> k;
        Word r = 0;
        Word s = 1;
        Word negative = 0;
        for (Word d = u - v; d != 0; d = u - v) {
            const Word swap = u > v ? ~Word{0} : 0; // then v is kept, and the difference replaces u
            const int zeros = std::countr_zero(d);
            const Word sum = r + s;
            r = (r ^ ((r ^ s) & swap)) << zeros;
            s = sum;
            u = v + (d & ~swap);
            v = ((d ^ ~swap) - ~swap) >> zeros;
            negative ^= swap;
            k += zeros;
        }
        const Word x = rotate(s, Bits - k % Bits);
        return static_cast<Value>(negative != 0 ? p - x : x);
    }

    /// m 2^e mod p for a finite double m 2^e.
    static Value residue(double value) {
        assert(std::isfinite(value));
        if (value == 0) {
            return 0;
        }
        int exponent = 0;
        const double mantissa = std::frexp(std::abs(value), &exponent);
        const auto integer = static_cast<Word>(std::ldexp(mantissa, 53)); // exact: 53 bits, also for denormals
        // 2^Bits = 1: powers of two rotate.
        const auto r = static_cast<Value>(rotate(canonical(integer), ((exponent - 53) % Bits + Bits) % Bits));
        return value < 0 ? negate(r) : r;
    }

  private:
    /// A congruent word: below p + 8 (61 bits) or p + 2^33 (31 bits).
    static Word fold(Word x) { return (x & p) + (x >> Bits); }

    /// A congruent word of x < 2^125: below x / 2^61 + 2^61.
    static Word fold_wide(Wide x) { return (static_cast<Word>(x) & p) + static_cast<Word>(x >> Bits); }

    /// x 2^k for x <= p, 0 <= k <= Bits.
    static Word rotate(Word x, int k) { return ((x << k) & p) | (x >> (Bits - k)); }

    template <std::size_t Count, class Body> static void unroll(Body body) {
        [&]<std::size_t... K>(std::index_sequence<K...>) {
            (body(std::integral_constant<std::size_t, K>()), ...);
        }(std::make_index_sequence<Count>());
    }
};

} // namespace isostat::exact
