#pragma once
/// \file
/// Random numbers with the same bits everywhere, because the distributions
/// of <random> differ between libraries (its engines do not).

#include "core/splitmix.hpp"

#include <cstdint>
#include <random>

namespace isostat::preparation {

/// Independent uses of one seed.
enum class Stream : std::uint64_t { radii = 1, positions = 2, infinitesimal = 3, jitter = 4 };

/// Seed of one use: splitmix64 of the user's seed and the stream number.
inline std::uint64_t derived_seed(std::uint64_t seed, Stream stream) {
    return splitmix(seed, static_cast<std::uint64_t>(stream));
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
