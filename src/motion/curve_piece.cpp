#include "motion/curve_piece.hpp"

#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "motion/geometry.hpp"
#include "motion/shifted_gap.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace isostat {

namespace {

using roundoff::infinity;

double norm(const std::vector<double>& x) {
    double sum = 0;
    for (const double c : x) {
        sum += c * c;
    }
    return std::sqrt(sum);
}

} // namespace

CurvePiece::CurvePiece(const KeptCurve& kept, const ArcCentre& at, double forward)
    : Polynomial(kept, at, forward), reach_(Polynomial::natural_reach()) {
    if (!coefficients().empty()) {
        shift_norm_ = norm(this->shift()) * upward;
        bound_coefficients();
        shorten_reach();
    }
}

void CurvePiece::bound_coefficients() {
    const std::size_t n = curve().contacts.size();
    relative_.assign(n * coefficients().size(), 0.0);
    shifted_.assign(n, 0.0);
    rounded_ = 0;
    residual_.assign(n * (2 * coefficients().size() + 1), 0.0);
    for (std::size_t l = 0; l < n; ++l) {
        if (l != curve().slot) {
            bound_coefficients_of(l);
            const double centre_misses = residual_[l * (2 * coefficients().size() + 1)];
            rounded_ += centre_misses * centre_misses;
            shift_residual_of(l);
        }
    }
}

/// Around p + a_0 instead of p: the constant term is that of F(m + a_0), the others gain D_l a_0 . D_l a_k.
void CurvePiece::shift_residual_of(std::size_t l) {
    const std::vector<double>& shift = this->shift();
    if (shift.empty()) {
        return;
    }
    const Contact& c = curve().contacts[l];
    const std::size_t order = coefficients().size();
    double* bound = &residual_[l * (2 * order + 1)];
    const Enclosure misses = shifted_equation(*curve().start, centre(), c, shift);
    bound[0] = (std::abs(misses.value) + misses.radius) * upward;
    if (!curve().bends(l)) {
        return;
    }
    const auto d = separation_over(centre().layout(), shift, c);
    shifted_[l] = std::sqrt(dot(d, d)) * upward;
    for (std::size_t k = 1; k <= order; ++k) {
        bound[k] += shifted_[l] * relative_[l * order + k - 1] / curve().target[l] * upward;
    }
}

void CurvePiece::bound_coefficients_of(std::size_t l) {
    const Contact& c = curve().contacts[l];
    const std::size_t order = coefficients().size();
    double* size = &relative_[l * order];
    double* bound = &residual_[l * (2 * order + 1)];
    const auto d = differences(l);
    for (std::size_t k = 1; k <= order; ++k) {
        size[k - 1] = std::sqrt(dot(d[k], d[k])) * upward;
    }
    if (c.kind == ContactKind::held) {
        const auto k = static_cast<std::size_t>(c.i);
        bound[0] = std::abs(centre().q[k] - curve().start->q[k]) * (1 + 2 * u);
        std::copy(size, size + order, bound + 1);
        return;
    }
    // |F| <= |gap| (1 + |gap| / 2D), |gap| < 1e-3 D; the computed gap is off by less than 8u D.
    const double length = curve().target[l];
    bound[0] = 1.001 * std::abs(gap(centre(), c)) + 8 * u * length; // bounds.md V4 (rounding, double)
    if (!c.of_disks()) {
        std::copy(size, size + order, bound + 1);
        return;
    }
    const PerAxis<double> line = separation(centre().layout(), centre().q, c);
    for (std::size_t k = 1; k <= 2 * order; ++k) {
        RoundedSum sum = half_square(d, k);
        if (k <= order) {
            sum.add(line, d[k]);
        }
        // 16: arcs.md A8; 8: precision.md B1 (last operations)
        bound[k] = (std::abs(sum.value) + (static_cast<double>(k) + 16) * u * sum.absolute) / length * (1 + 8 * u);
    }
}

/// Shortens the reach until the misfit of the polynomial is at most that of the centre, or for a shifted one a small
/// part of that, which costs a fifth of the reach (the misfit grows as its 15th power).
void CurvePiece::shorten_reach() {
    const std::size_t order = coefficients().size();
    const std::size_t stride = 2 * order + 1;
    for (int attempt = 0; attempt < 60; ++attempt, reach_ *= 0.85) { // cost: shorter pieces tried
        double beyond = 0;
        for (std::size_t l = 0; l < curve().contacts.size(); ++l) {
            const double* c = &residual_[l * stride];
            double value = 0;
            for (std::size_t k = stride - 1; k >= 1; --k) {
                value = (value + c[k]) * reach_;
            }
            beyond += value * value;
        }
        // 4: cost: reach of a piece; 0x1p-8: cost: reach of a shifted piece
        if (beyond <= (this->shift().empty() ? 4 : 0x1p-8) * rounded_) {
            return;
        }
    }
}

std::vector<double> CurvePiece::stretch(double h) const {
    const std::size_t order = coefficients().size();
    std::vector<double> e(curve().contacts.size(), 0.0);
    for (std::size_t l = 0; l < e.size(); ++l) {
        if (!curve().bends(l)) {
            continue;
        }
        double power = h;
        e[l] = shifted_[l];
        for (std::size_t k = 0; k < order; ++k, power *= h) {
            e[l] += power * relative_[l * order + k];
        }
        e[l] /= curve().target[l];
    }
    return e;
}

CurvePiece::Misfit CurvePiece::misfit(double h) const {
    const std::size_t order = coefficients().size();
    Misfit sum;
    for (std::size_t l = 0; l < curve().contacts.size(); ++l) {
        if (l == curve().slot) {
            continue;
        }
        const double* c = &residual_[l * (2 * order + 1)];
        double value = c[0];
        double rate = 0;
        double power = 1;
        for (std::size_t k = 1; k <= 2 * order; ++k) {
            rate += static_cast<double>(k) * power * c[k];
            power *= h;
            value += power * c[k];
        }
        sum.value += value * value;
        sum.rate += rate * rate;
        if (curve().bends(l)) {
            double speed = 0;
            power = 1;
            for (std::size_t k = 1; k <= order; ++k, power *= h) {
                speed += static_cast<double>(k) * power * relative_[l * order + k - 1];
            }
            sum.turn = std::max(sum.turn, speed / curve().target[l]);
        }
    }
    sum.value = (std::sqrt(sum.value) + curve().rest_residual) * upward;
    sum.rate = (std::sqrt(sum.rate) + sum.turn * curve().rest_residual) * upward;
    return sum;
}

CurvePiece::Motion CurvePiece::motion(double h) const {
    const double granted = row_units(centre().dimension) * u;
    Motion least;
    double loss = 0;
    double power = 1;
    for (std::size_t k = 1; k <= coefficients().size(); ++k, power *= h) {
        const RoundedSum sum = this->along_row(coefficients()[k - 1]);
        if (k == 1) {
            least.row_rate = sum.value * this->forward() - granted * sum.absolute;
        } else {
            loss += static_cast<double>(k) * power * (std::abs(sum.value) + granted * sum.absolute);
        }
        least.speed += static_cast<double>(k) * power * norm(coefficients()[k - 1]);
    }
    least.row_rate = (least.row_rate - loss * upward) * (1 - 1e-9); // arcs.md A8
    return least;
}

bool CurvePiece::prove(double h) {
    proved_ = 0;
    if (coefficients().empty() || !(h > 0)) {
        return false;
    }
    const double lost = inverse_norm() * (curve().norm_of(stretch(h)) + curve().rest_derivative) * upward;
    if (!(lost <= 0.8)) { // cost: reach of a piece (arcs.md A2)
        return false;
    }
    const double inverse = inverse_norm() / (1 - lost) * upward; // at every p(s)
    const Misfit residual = misfit(h);
    const double lipschitz = curve().lipschitz;
    const double product = inverse * inverse * lipschitz * residual.value * upward;
    if (!(product <= 0.25)) { // 0.25: arcs.md A1
        return false;
    }
    const double radius = 2 * inverse * residual.value * upward;
    const double at_curve = inverse / (1 - inverse * lipschitz * radius) * upward;
    const Motion along = motion(h);
    if (!(along.row_rate > 0) || !std::isfinite(along.speed)) {
        return false;
    }
    radius_ = shift_norm_ > 0 ? (radius + shift_norm_) * upward : radius;
    unique_ = lipschitz > 0 ? (1 - 1e-9) / (inverse * lipschitz) : infinity; // arcs.md A8
    slope_error_ = at_curve * (residual.rate + residual.turn * std::sqrt(curve().spread) * radius) * upward;
    margin_ = product > 0 ? 0.25 / product : infinity;
    row_rate_ = along.row_rate;
    speed_ = along.speed * upward;
    proved_ = h;
    return true;
}

std::vector<double> CurvePiece::away(const std::vector<double>& x, double s) const {
    std::vector<double> off = this->point(s);
    std::transform(x.begin(), x.end(), off.begin(), off.begin(), std::minus<>());
    return off;
}

/// The s where row . (x - p(s)) = 0, by Newton's method. Any s is allowed, because `locate` bounds its error.
std::optional<double> CurvePiece::nearest(const std::vector<double>& x) const {
    double s = 0;
    for (int k = 0; k < 8; ++k) { // guess: passes
        const double change = this->ahead_along_row(x, s);
        if (!std::isfinite(change) || std::abs(s + change) > 1.5 * proved_) { // guess: place on the piece
            return std::nullopt;
        }
        s += change;
        if (std::abs(change) <= 1e-14 * proved_) { // guess: place on the piece
            break;
        }
    }
    return s;
}

std::optional<CurvePiece::Place> CurvePiece::locate(const std::vector<double>& x, double uncertainty) const {
    const auto s = proved_ > 0 ? nearest(x) : std::nullopt;
    if (!s) {
        return std::nullopt;
    }
    const std::vector<double> off = away(x, *s);
    double square = 0;
    double coordinate = proved_;
    for (std::size_t mu = 0; mu < static_cast<std::size_t>(structure().size()); ++mu) {
        const std::size_t k = structure().dofs().coordinate_of(mu);
        square += off[k] * off[k];
        coordinate = std::max({coordinate, std::abs(x[k]), std::abs(centre().q[k])});
    }
    double terms = 0; // of Horner's scheme, times the operations on each (A8)
    double power = 1;
    for (std::size_t k = 0; k < coefficients().size(); ++k) {
        power *= std::abs(*s);
        terms += static_cast<double>(2 * k + 5) * power * largest(coefficients()[k]); // arcs.md A8 (2k + 3, k from 1)
    }
    // 16: arcs.md A8
    const double rounding = std::sqrt(static_cast<double>(structure().size())) * u * (16 * coordinate + terms);
    const double open = uncertainty + shift_norm_; // the tube is around p + a_0
    const double distance = (std::sqrt(square) + rounding) * upward + open;
    Place place;
    place.s = *s;
    // arcs.md A8
    place.slack = (std::abs(this->along_row(off).value) + 4 * this->row_terms() * u * (16 * coordinate + terms) +
                   this->row_norm() * open) /
                  row_rate_ * upward;
    // arcs.md A8
    if (!(std::abs(*s) + place.slack <= proved_ * (1 - 1e-9)) ||
        !(distance + speed_ * place.slack * upward < unique_)) {
        return std::nullopt;
    }
    return place;
}

int CurvePiece::direction_along(const CurvePiece& other, double s) const {
    const RoundedSum sum = other.along_row(this->slope(s));
    double size = 0; // of the terms of Horner's scheme
    double power = 1;
    for (std::size_t k = 0; k < coefficients().size(); ++k, power *= std::abs(s)) {
        size += static_cast<double>(k + 1) * power * largest(coefficients()[k]);
    }
    const double error =
        // 4: arcs.md A8; 64: arcs.md A8 (slopes along a row)
        (other.row_norm() * slope_error_ + 64 * u * (sum.absolute + 4 * other.row_terms() * size)) * upward;
    return sum.value > error ? 1 : -sum.value > error ? -1 : 0;
}

} // namespace isostat
