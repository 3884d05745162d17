#pragma once
/// \file
/// splitmix64 (Steele, Lea, Flood, OOPSLA 2014).

#include <cstdint>

// exact: all other numbers of this file: splitmix64

namespace isostat {

/// Number `place` of the sequence that begins behind `seed`, from 1.
constexpr std::uint64_t splitmix(std::uint64_t seed, std::uint64_t place) {
    std::uint64_t z = seed + place * 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

} // namespace isostat
