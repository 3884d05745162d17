#pragma once
// Reproducible random numbers: the same bits with every standard library.

#include <cstdint>
#include <random>

namespace isostat::oracle {

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    /// Uniform in [0, 1), 53 bits.
    double real() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double real(double low, double high) { return low + (high - low) * real(); }
    /// Uniform in 0 .. count-1 (the bias of the remainder does not matter here).
    int integer(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
    std::uint64_t bits() { return engine_(); }

  private:
    std::mt19937_64 engine_;
};

} // namespace isostat::oracle
