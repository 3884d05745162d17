#include "contact/gap_sign.hpp"

#include <boost/multiprecision/gmp.hpp>
#include <qd/dd_real.h>

#include <array>
#include <cassert>
#include <cmath>

namespace isostat {

namespace {

using Rational = boost::multiprecision::number<boost::multiprecision::gmp_rational, boost::multiprecision::et_off>;

constexpr double u = 0x1p-53;
/// Error granted to double-double expressions of fewer than ten operations, relative to the sum of the magnitudes:
/// libqd's products and IEEE additions are good to 2^-102 each.
constexpr double dd_bound = 0x1p-96;
/// Absolute error that underflow may add: products below this are not trusted.
constexpr double underflow_guard = 0x1p-960;

template <class Number> int sign(const Number& x) {
    return (x > 0 ? 1 : 0) - (x < 0 ? 1 : 0);
}

/// Whether |x| exceeds its error bound. False for NaN and after overflow.
bool exceeds(double x, double bound) {
    return std::abs(x) > bound + underflow_guard;
}

/// Sign of the sum of `terms`.
template <std::size_t Size> int sum_sign(const std::array<double, Size>& terms) {
    double sum = 0;
    double magnitude = 0;
    for (const double t : terms) {
        sum += t;
        magnitude += std::abs(t);
    }
    if (exceeds(sum, 2.0 * Size * u * magnitude)) {
        return sign(sum);
    }
    Rational exact = 0;
    for (const double t : terms) {
        exact += Rational(t);
    }
    return sign(exact);
}

/// Sign of |d|^2 - s^2 where d = xj - xi and s = ri + rj - allowance > 0.
template <std::size_t Dim>
int distance_sign(const std::array<double, Dim>& xi, const std::array<double, Dim>& xj, double ri, double rj,
                  double allowance) {
    const double s = ri + rj - allowance;
    double square = -s * s;
    double magnitude = (ri + rj + allowance) * (ri + rj + allowance);
    for (std::size_t a = 0; a < Dim; ++a) {
        const double d = xj[a] - xi[a];
        square += d * d;
        magnitude += d * d;
    }
    // Every operation has relative error u; none is on a quantity larger than the magnitude.
    if (exceeds(square, 16 * u * magnitude)) {
        return sign(square);
    }
    const dd_real target = dd_real::ieee_add(dd_real::add(ri, rj), dd_real(-allowance));
    dd_real difference = -(target * target);
    for (std::size_t a = 0; a < Dim; ++a) {
        const dd_real d = dd_real::sub(xj[a], xi[a]);
        difference = dd_real::ieee_add(difference, d * d);
    }
    if (exceeds(to_double(difference), dd_bound * magnitude)) {
        return sign(to_double(difference));
    }
    const Rational exact_target = Rational(ri) + Rational(rj) - Rational(allowance);
    Rational exact = -(exact_target * exact_target);
    for (std::size_t a = 0; a < Dim; ++a) {
        const Rational d = Rational(xj[a]) - Rational(xi[a]);
        exact += d * d;
    }
    return sign(exact);
}

} // namespace

template <int Dim> int gap_sign(const Packing<Dim>& packing, const Contact& contact, double allowance) {
    assert(contact.kind != ContactKind::held);
    const auto i = static_cast<std::size_t>(contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    const double ri = packing.radius[i];
    if (contact.kind == ContactKind::lower_wall) {
        return sum_sign<3>({packing.q[Dim * i + j], -ri, allowance});
    }
    if (contact.kind == ContactKind::upper_wall) {
        return sum_sign<4>({packing.length(contact.j), -packing.q[Dim * i + j], -ri, allowance});
    }
    const double rj = packing.radius[j];
    const int target = sum_sign<3>({ri, rj, -allowance});
    std::array<double, Dim> xi{};
    std::array<double, Dim> xj{};
    bool same_place = true;
    for (std::size_t a = 0; a < Dim; ++a) {
        xi[a] = packing.q[Dim * i + a];
        xj[a] = packing.q[Dim * j + a];
        same_place = same_place && xi[a] == xj[a];
    }
    if (target <= 0) {
        return target < 0 || !same_place ? 1 : 0;
    }
    return distance_sign(xi, xj, ri, rj, allowance);
}

template int gap_sign<2>(const Packing<2>&, const Contact&, double);

} // namespace isostat
