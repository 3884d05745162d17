#pragma once
// The number types of the rungs, with bounds of the errors of
// their operations: private to the room and to the certificate.

#include "verified/norm.hpp"
#include "verified/upper_bound.hpp"

#include <isostat/core/result.hpp>

#include <qd/dd_real.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace isostat {

/// `unit`: the error of a sum of two numbers is at most unit (|a| + |b|), that of a product, a
/// quotient or a root unit times the result. `difference` of two doubles errs by at most unit
/// times the result, `product` of three by twice that. `Bound`: the type of upper bounds, in a
/// range that they never leave. `corrections`, `refinements`: caps of iterations, which stop
/// earlier at the rounding of the type. `size`: a bound of |x|; `about`: |x| rounded, for bounds
/// that have 2 % to spare. `scaled`: x 2^-exponent in double; `number`: the inverse of `scaled`.
template <class T> class Arithmetic;

/// Doubles and pairs of doubles: `Bound` and all exponents are those of double.
template <class T> class ArithmeticOfDoubles {
  public:
    using Bound = double;
    static double about(const T& x) { return std::abs(Arithmetic<T>::rounded(x)); }
    static double size(const T& x) { return about(x) * (1 + 2 * 0x1p-53); } // exact: u, the unit of rounding
    static T number(double x, long = 0) { return T(x); }
    static long exponent_of(const std::vector<T>&) { return 0; }
    static double scaled(const T& x, long) { return Arithmetic<T>::rounded(x); }
};

template <> class Arithmetic<double> : public ArithmeticOfDoubles<double> {
  public:
    static constexpr Rung rung = Rung::double_bound;
    static constexpr int corrections = 0; // the vertex is enclosed around the stored doubles themselves
    static constexpr int refinements = 2;
    static double unit() { return 0x1p-53; } // exact: u, the unit of rounding
    static double difference(double a, double b) { return a - b; }
    static double product(double a, double b, double c = 1) { return a * b * c; }
    static double rounded(double x) { return x; }
};

/// libqd: its own bounds are 2^-103 for a (sloppy) sum and 2^-102
/// for products; differences and products of two doubles are exact.
template <> class Arithmetic<dd_real> : public ArithmeticOfDoubles<dd_real> {
  public:
    static constexpr Rung rung = Rung::double_double;
    static constexpr int corrections = 8; // 8: cost: passes
    static constexpr int refinements = 8;
    static double unit() { return 0x1p-98; } // true_vertex.md Arithmetic (e of double-double)
    static dd_real difference(double a, double b) { return dd_real::sub(a, b); }
    static dd_real product(double a, double b, double c = 1) { return dd_real::mul(a, b) * c; }
    static double rounded(const dd_real& x) { return x.x[0]; }
};

/// MPFR with any number of bits from 128 on, rounded to nearest; the range of its exponents is never left.
template <> class Arithmetic<Real> {
  public:
    using Bound = UpperBound;
    static constexpr Rung rung = Rung::multiprecision;
    explicit Arithmetic(int bits) : corrections(2 * bits), refinements(2 * bits), bits_(bits) {}

    const int corrections;
    const int refinements;
    [[nodiscard]] int bits() const { return bits_; }
    [[nodiscard]] UpperBound unit() const { return UpperBound::power_of_two(-bits_); }
    [[nodiscard]] Real number(double x, long exponent = 0) const {
        Real result(bits_);
        mpfr_set_d(result.get(), x, MPFR_RNDN);
        mpfr_mul_2si(result.get(), result.get(), exponent, MPFR_RNDN);
        return result;
    }
    [[nodiscard]] Real difference(double a, double b) const { return number(a) - number(b); }
    [[nodiscard]] Real product(double a, double b, double c = 1) const { return number(a) * number(b) * number(c); }
    static double rounded(const Real& x) { return x.nearest(); }
    static UpperBound about(const Real& x) { return UpperBound::magnitude(x); }
    static UpperBound size(const Real& x) { return UpperBound::magnitude(x); }
    /// The exponent of the largest number.
    static long exponent_of(const std::vector<Real>& x) {
        bool any = false;
        long largest = 0;
        for (const Real& c : x) {
            if (mpfr_regular_p(c.get()) != 0) {
                largest = any ? std::max<long>(largest, mpfr_get_exp(c.get())) : mpfr_get_exp(c.get());
                any = true;
            }
        }
        return largest;
    }
    static double scaled(const Real& x, long exponent) {
        Real result = x;
        mpfr_mul_2si(result.get(), result.get(), -exponent, MPFR_RNDN);
        return result.nearest();
    }

  private:
    int bits_;
};

/// Upper bound of the 2-norm of numbers >= 0; scaled, so that tiny
/// numbers do not underflow. A NaN stays NaN, and proves nothing.
template <class Bound> Bound norm_of_bounds(const std::vector<Bound>& x) {
    const Bound largest = x.empty() ? Bound(0) : *std::max_element(x.begin(), x.end());
    Bound square(0);
    for (const Bound& c : x) {
        const Bound part = c / largest;
        square += part * part;
    }
    using std::sqrt;
    return largest <= 0 ? Bound(0) : largest * sqrt(square) * sum_slack(x.size());
}

} // namespace isostat
