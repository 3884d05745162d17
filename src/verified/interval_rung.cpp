#include "verified/force_rung.hpp"

#include <cmath>
#include <limits>

namespace isostat {

namespace {

PreciseInterval unknown_interval(mpfr_prec_t bits) {
    PreciseInterval interval(bits);
    mpfr_set_nan(interval.low.get());
    mpfr_set_nan(interval.high.get());
    return interval;
}

} // namespace

void ForceRung::solve_anew(RightHandSide& part) {
    ForceSolution& s = part.solution;
    if (part.zero) {
        const std::size_t n = part.force.size();
        s.value.assign(n, 0.0);
        s.low.assign(rung_ == Rung::double_bound ? 0 : n, 0.0);
    } else {
        solve(part);
    }
    s.rung = rung_;
    s.bits = bits_;
}

PreciseInterval IntervalRung::enclosed(const RightHandSide& part, std::size_t l) const {
    Real value(low_bits);
    mpfr_set_d(value.get(), part.solution.value[l], MPFR_RNDN);
    PreciseInterval result(value, Real(part.solution.bound, 53), low_bits); // exact: bits of a double
    if (!part.solution.low.empty()) {
        mpfr_add_d(result.low.get(), result.low.get(), part.solution.low[l], MPFR_RNDD);
        mpfr_add_d(result.high.get(), result.high.get(), part.solution.low[l], MPFR_RNDU);
    }
    return result;
}

PreciseInterval IntervalRung::component(int part, std::size_t l) {
    RightHandSide& p = this->problem_.part(part);
    this->bring(p);
    return p.zero ? PreciseInterval(low_bits) : enclosed(p, l);
}

PreciseInterval IntervalRung::evaluate(const ForceExpression& e) {
    const std::size_t l = e.contact.index();
    PreciseInterval value = component(e.part, l);
    if (e.slope_part >= 0 && (e.at != e.from || e.shift != nullptr)) {
        PreciseInterval way = difference(e.at, e.from, value.bits());
        if (e.shift != nullptr) {
            way = way + e.shift->value(this->bits());
        }
        value = value + way * component(e.slope_part, l);
    }
    if (e.minus_magnitude) {
        value = -magnitude(value);
    }
    if (e.divisor_part >= 0) {
        const PreciseInterval by = magnitude(component(e.divisor_part, l));
        return by.positive() ? value / by : unknown_interval(value.bits());
    }
    return value;
}

Order IntervalRung::order_of(const PreciseInterval& value) const {
    Order order{false, 0, 0, this->rung(), this->bits()};
    if (value.positive() || value.negative()) {
        order.decided = true;
        order.sign = value.positive() ? 1 : -1;
        order.margin = value.margin();
    } else if (value.zero()) {
        order.decided = true;
        order.margin = std::numeric_limits<double>::infinity();
        order.exponent = -std::numeric_limits<double>::infinity();
    } else {
        Real size(64); // exact: bits of a bound
        const PreciseInterval absolute = magnitude(value);
        mpfr_log2(size.get(), absolute.high.get(), MPFR_RNDU);
        order.exponent = mpfr_nan_p(size.get()) != 0 ? std::numeric_limits<double>::infinity() : size.above();
    }
    return order;
}

Order IntervalRung::sign(const ForceExpression& a) {
    return order_of(evaluate(a));
}

Order IntervalRung::compare(const ForceExpression& a, const ForceExpression& b) {
    return order_of(evaluate(a) - evaluate(b));
}

PreciseInterval IntervalRung::zero_of(const ForceExpression& force, int) {
    const PreciseInterval slope = component(force.slope_part, force.contact.index());
    const PreciseInterval quotient = evaluate(force) / magnitude(slope);
    return slope.positive() ? -quotient : quotient;
}

Real IntervalRung::digits(const RightHandSide& part, ContactId contact, int bits) const {
    const std::size_t l = contact.index();
    Real sum(2200); // exact: bits for the sum of any two doubles
    mpfr_set_d(sum.get(), part.solution.value[l], MPFR_RNDN);
    mpfr_add_d(sum.get(), sum.get(), part.solution.low.empty() ? 0.0 : part.solution.low[l], MPFR_RNDN);
    Real value(bits);
    mpfr_set(value.get(), sum.get(), MPFR_RNDN);
    return value;
}

double IntervalRung::bound_exponent(const RightHandSide& part) const {
    return std::log2(part.solution.bound) + 1e-12; // precision.md B6 (a logarithm, rounded up)
}

} // namespace isostat
