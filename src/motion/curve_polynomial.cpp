#include "motion/curve_polynomial.hpp"

#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "motion/common_grid.hpp"
#include "motion/geometry.hpp"
#include "motion/shifted_gap.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using roundoff::infinity;
/// Share of sigma_min that the change of the derivative over a piece may use. Affects cost only.
constexpr double share = 0.7;         // cost: reach of a piece (arcs.md A2)
constexpr double longest_reach = 0.2; ///< in units of the smallest radius; choice: longest piece (arcs.md A5)

/// Rounds to the multiples of a power of two for which C2 holds (proofs/cells.md). Any coefficients are allowed, and
/// the separations of these are exact.
void put_on_grid(std::vector<double>& a, int dimension) {
    int exponent = 0;
    std::frexp(largest(a), &exponent);                            // largest < 2^exponent
    const double step = std::ldexp(1, exponent - 52 + dimension); // cells.md C2
    for (double& x : a) {
        x = step > 0 ? std::nearbyint(x / step) * step : 0.0;
    }
}

} // namespace

CurvePolynomial::CurvePolynomial(const KeptCurve& curve, const ArcCentre& centre, double forward)
    : curve_(&curve), at_(&centre), forward_(forward) {
    row_ = gap_gradient(centre.packing(), centre.structure().contacts()[curve.slot]);
    double ratio = 0; // |gap| / D of the kept contacts and of the one in the free row
    for (std::size_t l = 0; l < curve.contacts.size(); ++l) {
        const Contact& c = centre.structure().contacts()[l];
        if (c.of_disks() && l != curve.slot) {
            ratio = std::max(ratio, std::abs(gap(centre.packing(), c)) / curve.target[l]);
        }
    }
    if (!(centre.sigma_min() > 0) || !(ratio < 1e-3)) { // arcs.md A2 (test of the gaps)
        return;
    }
    inverse_ = (1 + 2 * ratio + 8 * u) / centre.sigma_min() * upward; // bounds.md V4 (rounding, double)
    expand();
}

std::vector<double> CurvePolynomial::solved(std::vector<double> rhs) const {
    factorisation().solve_velocities(rhs);
    return structure().dofs().on_coordinates(rhs);
}

/// Tangent at the centre, 1 in its fastest coordinate. False: the tangent is not finite.
bool CurvePolynomial::first_coefficient() {
    std::vector<double> rhs(curve_->contacts.size(), 0.0);
    rhs[curve_->slot] = -forward_; // approach velocity: minus the rate of the row
    std::vector<double> a = solved(rhs);
    const double scale = 1 / largest(a);
    if (!std::isfinite(scale) || !(scale > 0)) {
        return false;
    }
    for (double& x : a) {
        x *= scale;
    }
    if (centre().cell.any()) {
        put_on_grid(a, centre().dimension);
    }
    append(std::move(a));
    return true;
}

void CurvePolynomial::append(std::vector<double> coefficient) {
    a_.push_back(std::move(coefficient));
    for (std::size_t l = 0; l < curve_->contacts.size(); ++l) {
        differences_[l * (max_order + 1) + a_.size()] =
            separation_over(centre().layout(), a_.back(), curve_->contacts[l]);
    }
}

/// Chooses the reach from the first coefficient over the contacts: how far the derivative of the equations may turn.
void CurvePolynomial::choose_reach() {
    std::vector<double> e(curve_->contacts.size(), 0.0);
    for (std::size_t l = 0; l < e.size(); ++l) {
        if (curve_->bends(l)) {
            const PerAxis<double>& first = differences(l)[1];
            e[l] = std::sqrt(dot(first, first)) / curve_->target[l];
        }
    }
    const double turning = curve_->norm_of(e);
    // No longer than what a candidate list allows.
    const double longest = longest_reach * centre().min_radius();
    reach_ = turning > 0 ? std::min(share / (inverse_ * turning), longest) : longest;
}

/// One step of Newton's method from the centre, with gaps in double-double.
void CurvePolynomial::find_shift() {
    std::vector<double> rhs(curve_->contacts.size(), 0.0);
    for (std::size_t l = 0; l < rhs.size(); ++l) {
        if (l != curve_->slot) {
            rhs[l] = shifted_equation(*curve_->start, centre(), curve_->contacts[l], {}).value;
        }
    }
    shift_ = solved(std::move(rhs));
    if (largest(shift_) < infinity) {
        put_on_grid(shift_, centre().dimension);
    } else {
        shift_.clear();
    }
}

/// Coefficient k of |d|^2 = D^2 along p: 2 line . a_k + sum of a_i . a_(k-i) = 0 over every kept disk contact.
void CurvePolynomial::expand() {
    const std::size_t n = curve_->contacts.size();
    differences_.assign(n * (max_order + 1), {});
    if (!first_coefficient()) {
        return;
    }
    if (centre().cell.any()) {
        find_shift();
    }
    std::vector<double> length(n, 1.0);
    for (std::size_t l = 0; l < n; ++l) {
        if (curve_->bends(l)) {
            const auto line = separation(centre().layout(), centre().q, curve_->contacts[l]);
            length[l] = std::sqrt(dot(line, line));
        }
    }
    choose_reach();
    const double negligible = 0x1p-60 * centre().min_radius(); // guess: coefficients that are left out
    std::vector<double> rhs(n, 0.0);
    for (std::size_t k = 2; k <= max_order; ++k) {
        for (std::size_t l = 0; l < n; ++l) {
            rhs[l] = curve_->bends(l) ? half_square(differences(l), k).value / length[l] : 0.0;
        }
        std::vector<double> a = solved(rhs);
        if (centre().cell.any() && largest(a) < infinity) {
            put_on_grid(a, centre().dimension);
        }
        const double size = largest(a) * std::pow(reach_, static_cast<int>(k));
        if (!std::isfinite(size)) {
            break;
        }
        append(std::move(a));
        if (size < negligible) {
            break;
        }
    }
}

double CurvePolynomial::coordinate(std::size_t k, double s) const {
    double sum = 0;
    for (std::size_t order = a_.size(); order > 0; --order) {
        sum = (sum + a_[order - 1][k]) * s;
    }
    return centre().q[k] + sum;
}

double CurvePolynomial::rate(std::size_t k, double s) const {
    double v = 0;
    for (std::size_t order = a_.size(); order > 0; --order) {
        v = v * s + static_cast<double>(order) * a_[order - 1][k];
    }
    return v;
}

std::vector<double> CurvePolynomial::point(double s) const {
    std::vector<double> x = centre().q;
    for (std::size_t mu = 0; mu < static_cast<std::size_t>(structure().size()); ++mu) {
        const std::size_t k = structure().dofs().coordinate_of(mu);
        x[k] = coordinate(k, s);
    }
    return x;
}

std::vector<double> CurvePolynomial::slope(double s) const {
    std::vector<double> v(centre().q.size(), 0.0);
    for (std::size_t mu = 0; mu < static_cast<std::size_t>(structure().size()); ++mu) {
        const std::size_t k = structure().dofs().coordinate_of(mu);
        v[k] = rate(k, s);
    }
    return v;
}

std::optional<Packing> CurvePolynomial::corrected(double s) const {
    Packing at = centre();
    at.q = point(s);
    const std::vector<double> guess = at.q;
    const double rounding = 2 * grid_step(at);
    std::vector<double> rhs(curve_->contacts.size());
    double previous = infinity;
    for (int k = 0; k < 40; ++k) { // guess: Newton steps
        for (std::size_t l = 0; l < rhs.size(); ++l) {
            const Contact& c = curve_->contacts[l];
            const auto i = static_cast<std::size_t>(c.i);
            rhs[l] = l == curve_->slot ? 0.0 : c.kind == ContactKind::held ? at.q[i] - curve_->start->q[i] : gap(at, c);
        }
        const std::vector<double> y = solved(rhs);
        const double size = largest(y);
        // guess: when Newton stops
        if (!(size < infinity) || (k > 2 && size > 0.9 * previous && size > 1e-9 * at.min_radius())) {
            return std::nullopt;
        }
        for (std::size_t c = 0; c < y.size(); ++c) {
            at.q[c] += y[c];
        }
        if (size <= rounding || (k > 2 && size > 0.5 * previous)) { // guess: when Newton stops
            break;
        }
        previous = size;
    }
    for (std::size_t c = 0; c < guess.size(); ++c) {
        if (!(std::abs(at.q[c] - guess[c]) <= 0.2 * std::abs(s))) { // guess: another branch
            return std::nullopt;                                    // perhaps another branch
        }
    }
    for (std::size_t l = 0; l < rhs.size(); ++l) {
        const Contact& c = curve_->contacts[l];
        if (c.kind == ContactKind::held && l != curve_->slot) {
            at.q[static_cast<std::size_t>(c.i)] = curve_->start->q[static_cast<std::size_t>(c.i)];
        }
    }
    if (at.cell.any()) {
        return put_on_grid_of(*curve_->start, structure().dofs(), at) ? std::optional(std::move(at)) : std::nullopt;
    }
    snap_to_grid(at);
    return at;
}

double CurvePolynomial::row_norm() const {
    return separation_weight(structure().contacts()[curve_->slot]);
}

double CurvePolynomial::row_terms() const {
    return 1 + cell_weight(structure().contacts()[curve_->slot]);
}

double CurvePolynomial::ahead_along_row(const std::vector<double>& x, double s) const {
    RoundedSum way;
    RoundedSum speed;
    row_.for_each([&](std::size_t k, double value) {
        way.add(value * (x[k] - coordinate(k, s)));
        speed.add(value * rate(k, s));
    });
    return way.value / speed.value;
}

RoundedSum CurvePolynomial::along_row(const std::vector<double>& v) const {
    RoundedSum sum;
    row_.for_each([&](std::size_t k, double value) { sum.add(value * v[k]); });
    return sum;
}

} // namespace isostat
