#pragma once
// Arithmetic mod p = 2^61 - 1 on unreduced words: the bounds are part of each function's contract.

#include <isostat/exact/rank.hpp>

#include <cstdint>

namespace isostat::exact {

__extension__ using Wide = unsigned __int128;

/// Brings any 64-bit word to a congruent one below 2^61 + 7.
inline std::uint64_t fold(std::uint64_t x) {
    return (x & mersenne61) + (x >> 61);
}

/// The residue in [0, p) of any word.
inline std::uint64_t canonical(std::uint64_t x) {
    x = fold(x);
    return x >= mersenne61 ? x - mersenne61 : x;
}

/// A congruent word of x < 2^125: below x / 2^61 + 2^61.
inline std::uint64_t fold_wide(Wide x) {
    return (static_cast<std::uint64_t>(x) & mersenne61) + static_cast<std::uint64_t>(x >> 61);
}

/// A product of two words below 2^62, below 2^61 + 7.
inline std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    return fold(fold_wide(static_cast<Wide>(a) * b));
}

} // namespace isostat::exact
