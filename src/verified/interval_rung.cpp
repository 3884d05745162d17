#include "verified/interval_rung.hpp"

#include "verified/refined_vertex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;

PreciseInterval unknown_interval(mpfr_prec_t bits) {
    PreciseInterval interval(bits);
    mpfr_set_nan(interval.low.get());
    mpfr_set_nan(interval.high.get());
    return interval;
}

/// 2-norm of the vectors within the bound.
PreciseInterval norm_of(const RefinedVector& v, mpfr_prec_t bits) {
    PreciseInterval norm(bits);
    for (const Real& c : v.value) {
        PreciseInterval point(bits);
        mpfr_set(point.low.get(), c.get(), MPFR_RNDD);
        mpfr_set(point.high.get(), c.get(), MPFR_RNDU);
        norm = norm + point * point;
    }
    mpfr_sqrt(norm.low.get(), norm.low.get(), MPFR_RNDD);
    mpfr_sqrt(norm.high.get(), norm.high.get(), MPFR_RNDU);
    mpfr_sub(norm.low.get(), norm.low.get(), v.bound.get(), MPFR_RNDD);
    mpfr_add(norm.high.get(), norm.high.get(), v.bound.get(), MPFR_RNDU);
    return norm;
}

} // namespace

template <int Dim> void ForceRung<Dim>::bring(RightHandSide& part) {
    ForceSolution& s = part.solution;
    if (!s.value.empty() && s.rung == rung_ && s.bits == bits_ && is_enough(part)) {
        return;
    }
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

template <int Dim> double IntervalRung<Dim>::normal_uncertainty() {
    return this->problem_.vertex == nullptr ? 0 : this->problem_.normal_rate() * where().away;
}

template <int Dim> PreciseInterval IntervalRung<Dim>::enclosed(const RightHandSide& part, std::size_t l) const {
    Real value(low_bits);
    mpfr_set_d(value.get(), part.solution.value[l], MPFR_RNDN);
    PreciseInterval result(value, Real(part.solution.bound, 53), low_bits);
    if (!part.solution.low.empty()) {
        mpfr_add_d(result.low.get(), result.low.get(), part.solution.low[l], MPFR_RNDD);
        mpfr_add_d(result.high.get(), result.high.get(), part.solution.low[l], MPFR_RNDU);
    }
    return result;
}

template <int Dim> PreciseInterval IntervalRung<Dim>::component(int part, std::size_t l) {
    RightHandSide& p = this->problem_.part(part);
    this->bring(p);
    return p.zero ? PreciseInterval(low_bits) : enclosed(p, l);
}

/// On the rungs below MPFR the system of the first MPFR rung is used: it contains them.
template <int Dim> PreciseInterval IntervalRung<Dim>::norm_of_mechanism(std::size_t l) {
    LadderProblem<Dim>& problem = this->problem_;
    if (problem.inverse.verdict != Verdict::proved) {
        return unknown_interval(low_bits);
    }
    std::optional<RefinedSystem<Dim>> own;
    if (system() == nullptr) {
        const double sigma =
            problem.inverse.sigma_min - where().uncertainty * (1 + 8 * u) - problem.normal_rate() * where().shift;
        if (!(sigma > problem.inverse.sigma_min / 2)) {
            return unknown_interval(low_bits);
        }
        // Normals of the stored configuration: as far from the true ones as on the rung double.
        own.emplace(problem.structure, exact_coordinates(problem.packing.q, {}), problem.factorisation,
                    sigma * (1 - 8 * u), Real(normal_uncertainty(), 53), low_bits);
    }
    const RefinedSystem<Dim>& use = own ? *own : *system();
    const auto n = static_cast<std::size_t>(problem.structure.size());
    std::vector<Real> unit(n, Real(53));
    mpfr_set_ui(unit[l].get(), 1, MPFR_RNDN);
    const RefinedVector v = use.solve(unit, std::vector<Real>(n, Real(53)), true);
    return v.value.size() == n ? norm_of(v, use.bits() + 32) : unknown_interval(low_bits);
}

template <int Dim> const PreciseInterval& IntervalRung<Dim>::mechanism_norm(std::size_t l) {
    auto known = mechanism_.find(l);
    if (known == mechanism_.end()) {
        known = mechanism_.emplace(l, norm_of_mechanism(l)).first;
    }
    return known->second;
}

template <int Dim> PreciseInterval IntervalRung<Dim>::evaluate(const ForceExpression& e) {
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
    if (e.divisor != ForceExpression::Divisor::none) {
        const PreciseInterval by =
            e.divisor == ForceExpression::Divisor::part ? magnitude(component(e.divisor_part, l)) : mechanism_norm(l);
        return by.positive() ? value / by : unknown_interval(value.bits());
    }
    return value;
}

template <int Dim> Order IntervalRung<Dim>::order_of(const PreciseInterval& value) const {
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
        Real size(64);
        const PreciseInterval absolute = magnitude(value);
        mpfr_log2(size.get(), absolute.high.get(), MPFR_RNDU);
        order.exponent = mpfr_nan_p(size.get()) != 0 ? std::numeric_limits<double>::infinity() : size.above();
    }
    return order;
}

template <int Dim> Order IntervalRung<Dim>::sign(const ForceExpression& a) {
    return order_of(evaluate(a));
}

template <int Dim> Order IntervalRung<Dim>::compare(const ForceExpression& a, const ForceExpression& b) {
    return order_of(evaluate(a) - evaluate(b));
}

template <int Dim> PreciseInterval IntervalRung<Dim>::zero_of(const ForceExpression& force, int) {
    const PreciseInterval slope = component(force.slope_part, force.contact.index());
    const PreciseInterval quotient = evaluate(force) / magnitude(slope);
    return slope.positive() ? -quotient : quotient;
}

template <int Dim> Real IntervalRung<Dim>::digits(const RightHandSide& part, ContactId contact, int bits) const {
    const std::size_t l = contact.index();
    Real sum(2200); // exact for any two doubles
    mpfr_set_d(sum.get(), part.solution.value[l], MPFR_RNDN);
    mpfr_add_d(sum.get(), sum.get(), part.solution.low.empty() ? 0.0 : part.solution.low[l], MPFR_RNDN);
    Real value(bits);
    mpfr_set(value.get(), sum.get(), MPFR_RNDN);
    return value;
}

template <int Dim> double IntervalRung<Dim>::bound_exponent(const RightHandSide& part) const {
    return std::log2(part.solution.bound) + 1e-12;
}

template class ForceRung<2>;
template class IntervalRung<2>;

} // namespace isostat
