#pragma once
/// \file
/// Internal unit of length: a power of two, so that conversions to it and back are exact.

#include <isostat/packing/packing.hpp>

#include <cmath>
#include <numeric>
#include <vector>

namespace isostat::preparation {

inline double mean(const std::vector<double>& x) {
    return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

/// Chosen so that the mean radius is in [0.5, 1).
class Scale {
  public:
    explicit Scale(const std::vector<double>& radius) { mean_ = std::frexp(mean(radius), &exponent_); }

    [[nodiscard]] double mean_radius() const { return mean_; }               ///< internal unit
    [[nodiscard]] double unit() const { return std::ldexp(1.0, exponent_); } ///< in the user's unit

    [[nodiscard]] Packing to_internal(Packing packing) const {
        multiply(packing.radius, -exponent_);
        multiply(packing.q, -exponent_);
        multiply(packing.bars, -exponent_);
        return packing;
    }

    /// `radius`: the radii of the user, which this restores bit for bit.
    [[nodiscard]] Packing to_user(Packing packing, const std::vector<double>& radius) const {
        packing.radius = radius;
        multiply(packing.q, exponent_);
        multiply(packing.bars, exponent_);
        return packing;
    }

    void to_internal(std::vector<double>& lengths) const { multiply(lengths, -exponent_); }

  private:
    static void multiply(std::vector<double>& x, int exponent) {
        for (double& c : x) {
            c = std::ldexp(c, exponent);
        }
    }
    static void multiply(std::vector<Bar>& bars, int exponent) {
        for (Bar& bar : bars) {
            bar.length = std::ldexp(bar.length, exponent);
        }
    }
    int exponent_ = 0;
    double mean_ = 0;
};

} // namespace isostat::preparation
