#pragma once
// MPFR numbers as values, and intervals of them: private to the room.

#include <isostat/core/result.hpp>

#include <mpfr.h>

#include <algorithm>
#include <utility>

namespace isostat {

/// An MPFR number with its own precision. Assignment takes value and precision. MPFR's exponents
/// have 63 bits, so nothing over- or underflows. Boost's mpfr_float is as fast, but its
/// precision is in decimal digits, kept for the whole process and changed by every operation
/// (two threads at two precisions would race), and its functions do not round down or up.
class Real {
  public:
    Real() : Real(53) {} // 53: exact: bits of a double
    explicit Real(mpfr_prec_t bits) {
        mpfr_init2(x_, bits);
        mpfr_set_zero(x_, 1);
    }
    /// The double, exactly.
    Real(double value, mpfr_prec_t bits) : Real(bits < 53 ? 53 : bits) { mpfr_set_d(x_, value, MPFR_RNDN); }
    Real(const Real& other) : Real(mpfr_get_prec(other.x_)) { mpfr_set(x_, other.x_, MPFR_RNDN); }
    Real(Real&& other) noexcept : Real(MPFR_PREC_MIN) { mpfr_swap(x_, other.x_); }
    Real& operator=(Real other) noexcept {
        mpfr_swap(x_, other.x_);
        return *this;
    }
    ~Real() { mpfr_clear(x_); }

    [[nodiscard]] mpfr_ptr get() { return x_; }
    [[nodiscard]] mpfr_srcptr get() const { return x_; }
    [[nodiscard]] int sign() const { return mpfr_sgn(x_); }
    /// Nearest double (may underflow to 0).
    [[nodiscard]] double nearest() const { return mpfr_get_d(x_, MPFR_RNDN); }
    /// Smallest double that is not smaller: positive for every positive number.
    [[nodiscard]] double above() const { return mpfr_get_d(x_, MPFR_RNDU); }
    [[nodiscard]] double below() const { return mpfr_get_d(x_, MPFR_RNDD); }

  private:
    mpfr_t x_;
};

/// Rounded to nearest, with the bits of the longer operand; `+=` and `-=` keep the bits of the left one.
template <int (*operation)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t)> Real rounded(const Real& a, const Real& b) {
    Real result(std::max(mpfr_get_prec(a.get()), mpfr_get_prec(b.get())));
    operation(result.get(), a.get(), b.get(), MPFR_RNDN);
    return result;
}
inline Real operator+(const Real& a, const Real& b) {
    return rounded<mpfr_add>(a, b);
}
inline Real operator-(const Real& a, const Real& b) {
    return rounded<mpfr_sub>(a, b);
}
inline Real operator*(const Real& a, const Real& b) {
    return rounded<mpfr_mul>(a, b);
}
inline Real operator/(const Real& a, const Real& b) {
    return rounded<mpfr_div>(a, b);
}
inline Real operator-(Real a) {
    mpfr_neg(a.get(), a.get(), MPFR_RNDN);
    return a;
}
inline Real& operator+=(Real& a, const Real& b) {
    mpfr_add(a.get(), a.get(), b.get(), MPFR_RNDN);
    return a;
}
inline Real& operator-=(Real& a, const Real& b) {
    mpfr_sub(a.get(), a.get(), b.get(), MPFR_RNDN);
    return a;
}
inline Real sqrt(Real a) {
    mpfr_sqrt(a.get(), a.get(), MPFR_RNDN);
    return a;
}

/// A real number between low and high; operations round outwards, with `bits` of the object. NaN: nothing is known.
class PreciseInterval {
  public:
    PreciseInterval() = default;
    explicit PreciseInterval(mpfr_prec_t bits) : low(bits), high(bits) {}
    /// value +- radius, radius >= 0.
    PreciseInterval(const Real& value, const Real& radius, mpfr_prec_t bits) : PreciseInterval(bits) {
        mpfr_sub(low.get(), value.get(), radius.get(), MPFR_RNDD);
        mpfr_add(high.get(), value.get(), radius.get(), MPFR_RNDU);
    }

    Real low;
    Real high;

    [[nodiscard]] mpfr_prec_t bits() const { return mpfr_get_prec(low.get()); }
    [[nodiscard]] bool positive() const { return low.sign() > 0 && mpfr_nan_p(high.get()) == 0; }
    [[nodiscard]] bool negative() const { return high.sign() < 0 && mpfr_nan_p(low.get()) == 0; }
    /// Both ends are 0.
    [[nodiscard]] bool zero() const { return mpfr_zero_p(low.get()) != 0 && mpfr_zero_p(high.get()) != 0; }
    /// |centre| / radius, infinite for a point.
    [[nodiscard]] double margin() const;
    /// The interval in doubles: the rounded middle, with the loss added to the radius.
    [[nodiscard]] Enclosure rounded() const;
};

/// at - from.
PreciseInterval difference(double at, double from, mpfr_prec_t bits);
PreciseInterval operator-(const PreciseInterval& a);
PreciseInterval operator+(const PreciseInterval& a, const PreciseInterval& b);
PreciseInterval operator-(const PreciseInterval& a, const PreciseInterval& b);
PreciseInterval operator*(const PreciseInterval& a, const PreciseInterval& b);
/// \pre b positive
PreciseInterval operator/(const PreciseInterval& a, const PreciseInterval& b);
PreciseInterval magnitude(const PreciseInterval& a);
/// NaN where a may be 0 or less.
PreciseInterval logarithm(const PreciseInterval& a);

} // namespace isostat
