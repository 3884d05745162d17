#pragma once
/// \file
/// Random numbers with the same bits everywhere, because the distributions
/// of <random> differ between libraries (its engines do not).

#include <cstdint>
#include <random>

namespace isostat::preparation {

/// Independent uses of one seed.
enum class Stream : std::uint64_t { radii = 1, positions = 2, infinitesimal = 3, jitter = 4 };

/// Seed of one use: splitmix64 of the user's seed and the stream number (Steele, Lea, Flood, OOPSLA 2014).
inline std::uint64_t derived_seed(std::uint64_t seed, Stream stream) {
    std::uint64_t z = seed + static_cast<std::uint64_t>(stream) * 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

/// Uniform in [0, 1), 53 bits.
class Uniform {
  public:
    explicit Uniform(std::uint64_t seed) : engine_(seed) {}
    double operator()() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

  private:
    std::mt19937_64 engine_;
};

} // namespace isostat::preparation
