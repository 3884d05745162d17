#include "verified/real.hpp"

#include <algorithm>
#include <limits>

// exact: all other numbers of this file: bits of a margin

namespace isostat {

double PreciseInterval::margin() const {
    Real centre(64);
    Real radius(64);
    mpfr_add(centre.get(), low.get(), high.get(), MPFR_RNDN);
    mpfr_sub(radius.get(), high.get(), low.get(), MPFR_RNDU);
    mpfr_div(centre.get(), centre.get(), radius.get(), MPFR_RNDD);
    mpfr_abs(centre.get(), centre.get(), MPFR_RNDD);
    return centre.below();
}

Enclosure PreciseInterval::rounded() const {
    Real centre(64);
    mpfr_add(centre.get(), low.get(), high.get(), MPFR_RNDN);
    mpfr_div_2ui(centre.get(), centre.get(), 1, MPFR_RNDN);
    const Real value(centre.nearest(), 53); // exact: bits of a double
    Real below(64);
    Real over(64);
    mpfr_sub(below.get(), value.get(), low.get(), MPFR_RNDU);
    mpfr_sub(over.get(), high.get(), value.get(), MPFR_RNDU);
    // mpfr_max ignores a NaN, so both ends are tested.
    const bool known = mpfr_number_p(low.get()) != 0 && mpfr_number_p(high.get()) != 0;
    mpfr_max(over.get(), over.get(), below.get(), MPFR_RNDU);
    return {value.nearest(), known ? over.above() : std::numeric_limits<double>::infinity()};
}

PreciseInterval difference(double at, double from, mpfr_prec_t bits) {
    const Real a(at, 53); // 53: exact: bits of a double
    const Real b(from, 53);
    PreciseInterval result(bits);
    mpfr_sub(result.low.get(), a.get(), b.get(), MPFR_RNDD);
    mpfr_sub(result.high.get(), a.get(), b.get(), MPFR_RNDU);
    return result;
}

PreciseInterval operator-(const PreciseInterval& a) {
    PreciseInterval result(a.bits());
    mpfr_neg(result.low.get(), a.high.get(), MPFR_RNDD);
    mpfr_neg(result.high.get(), a.low.get(), MPFR_RNDU);
    return result;
}

PreciseInterval operator+(const PreciseInterval& a, const PreciseInterval& b) {
    PreciseInterval result(std::max(a.bits(), b.bits()));
    mpfr_add(result.low.get(), a.low.get(), b.low.get(), MPFR_RNDD);
    mpfr_add(result.high.get(), a.high.get(), b.high.get(), MPFR_RNDU);
    return result;
}

PreciseInterval operator-(const PreciseInterval& a, const PreciseInterval& b) {
    return a + -b;
}

PreciseInterval operator*(const PreciseInterval& a, const PreciseInterval& b) {
    PreciseInterval result(std::max(a.bits(), b.bits()));
    Real product(result.bits());
    bool first = true;
    const auto extend = [&](Real& end, const Real& x, const Real& y, auto outer, mpfr_rnd_t outwards) {
        mpfr_mul(product.get(), x.get(), y.get(), outwards);
        if (first || mpfr_nan_p(product.get()) != 0) {
            mpfr_set(end.get(), product.get(), outwards);
        } else if (mpfr_nan_p(end.get()) == 0) {
            outer(end.get(), end.get(), product.get(), outwards);
        }
    };
    for (const Real* x : {&a.low, &a.high}) {
        for (const Real* y : {&b.low, &b.high}) {
            extend(result.low, *x, *y, mpfr_min, MPFR_RNDD);
            extend(result.high, *x, *y, mpfr_max, MPFR_RNDU);
            first = false;
        }
    }
    return result;
}

PreciseInterval operator/(const PreciseInterval& a, const PreciseInterval& b) {
    PreciseInterval result(std::max(a.bits(), b.bits()));
    mpfr_div(result.low.get(), a.low.get(), (a.low.sign() >= 0 ? b.high : b.low).get(), MPFR_RNDD);
    mpfr_div(result.high.get(), a.high.get(), (a.high.sign() >= 0 ? b.low : b.high).get(), MPFR_RNDU);
    return result;
}

PreciseInterval magnitude(const PreciseInterval& a) {
    if (a.low.sign() >= 0) {
        return a;
    }
    if (a.high.sign() <= 0) {
        return -a;
    }
    PreciseInterval result = -a;
    mpfr_max(result.high.get(), result.high.get(), a.high.get(), MPFR_RNDU);
    mpfr_set_zero(result.low.get(), 1);
    return result;
}

PreciseInterval logarithm(const PreciseInterval& a) {
    PreciseInterval result(a.bits());
    mpfr_log(result.low.get(), a.low.get(), MPFR_RNDD);
    mpfr_log(result.high.get(), a.high.get(), MPFR_RNDU);
    if (!a.positive()) {
        mpfr_set_nan(result.low.get());
        mpfr_set_nan(result.high.get());
    }
    return result;
}

} // namespace isostat
