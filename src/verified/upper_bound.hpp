#pragma once
// Upper bounds beyond the range of double: private to the room.

#include "verified/real.hpp"

namespace isostat {

/// An upper bound of a number >= 0: 64 bits, any exponent, every operation rounded up. Comparisons with NaN are false.
class UpperBound {
  public:
    UpperBound(double value = 0) : x_(value, bits) {} // NOLINT(google-explicit-constructor): as doubles do
    /// |x|
    static UpperBound magnitude(const Real& x) {
        UpperBound result;
        mpfr_abs(result.x_.get(), x.get(), MPFR_RNDU);
        return result;
    }
    static UpperBound power_of_two(long exponent) {
        UpperBound result(1);
        mpfr_mul_2si(result.x_.get(), result.x_.get(), exponent, MPFR_RNDU);
        return result;
    }
    [[nodiscard]] const Real& real() const { return x_; }
    [[nodiscard]] double above() const { return x_.above(); }

    UpperBound& operator+=(const UpperBound& b) {
        mpfr_add(x_.get(), x_.get(), b.x_.get(), MPFR_RNDU);
        return *this;
    }
    UpperBound& operator*=(const UpperBound& b) {
        mpfr_mul(x_.get(), x_.get(), b.x_.get(), MPFR_RNDU);
        return *this;
    }
    /// \pre b > 0 is exact, or a lower bound.
    UpperBound& operator/=(const UpperBound& b) {
        mpfr_div(x_.get(), x_.get(), b.x_.get(), MPFR_RNDU);
        return *this;
    }
    friend UpperBound operator+(UpperBound a, const UpperBound& b) { return a += b; }
    friend UpperBound operator*(UpperBound a, const UpperBound& b) { return a *= b; }
    friend UpperBound operator/(UpperBound a, const UpperBound& b) { return a /= b; }
    friend bool operator<(const UpperBound& a, const UpperBound& b) { return mpfr_less_p(a.x_.get(), b.x_.get()) != 0; }
    friend bool operator<=(const UpperBound& a, const UpperBound& b) {
        return mpfr_lessequal_p(a.x_.get(), b.x_.get()) != 0;
    }
    friend UpperBound sqrt(UpperBound a) {
        mpfr_sqrt(a.x_.get(), a.x_.get(), MPFR_RNDU);
        return a;
    }

  private:
    static constexpr mpfr_prec_t bits = 64; // exact: bits of a bound
    Real x_;
};

inline double above(const UpperBound& b) {
    return b.above();
}
inline double above(double b) {
    return b;
}

} // namespace isostat
