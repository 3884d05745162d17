#include "motion/power_watch.hpp"

#include "motion/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

constexpr int max_halvings = 40; // cost: halvings
/// Larger shares of a piece with open power are not excused as the start at a limit or the end at a turn.
constexpr double largest_open_start = 1e-2; // 1e-2: choice: largest open share (arcs.md A6)
constexpr double largest_open_end = 1e-2;

} // namespace

/// P(s) = -f_slot row . p'(s) + d/ds sum_l f_l |difference of (p - centre)|^2 / (2 d_l), up to `open(h)`, f the forces
/// that balance the load at the centre up to a residual.
struct PowerWatch::Power {
    std::vector<double> c;      ///< P(s) = sum_k c_k s^k
    std::vector<double> c_open; ///< rounding of c_k
    std::vector<double> g;      ///< (sum (f/d)^2 |difference of a_k|^2)^(1/2), k = 1 ...
    double apart = 0;           ///< 2-norm of the differences of q(s) - p(s)
    double slope_apart = 0;     ///< 2-norm of the differences of the derivatives
    double heaviest = 0;        ///< largest |f| / d
    double residual = 0;        ///< |F - H f| times the speed

    /// P lies above this for s in [from, to].
    [[nodiscard]] double low(double from, double to) const {
        const double s = 0.5 * (from + to);                           // exact: a half
        const double half = std::max(to - s, s - from) * (1 + 4 * u); // precision.md B1 (last operations)
        const double h = std::max(std::abs(from), std::abs(to));
        double value = 0;
        for (std::size_t k = c.size(); k-- > 0;) {
            value = value * s + c[k];
        }
        double change = 0;
        double rounding = 0;
        double power = 1;
        for (std::size_t k = 0; k < c.size(); ++k) {
            if (k >= 1) {
                change += static_cast<double>(k) * power * std::abs(c[k]);
                power *= h;
            }
            // 4: arcs.md A8 (Horner, 4 n u)
            rounding += power * (c_open[k] + 4 * static_cast<double>(c.size()) * u * std::abs(c[k]));
        }
        double first = 0;
        double second = 0;
        power = 1;
        for (std::size_t k = 1; k <= g.size(); ++k) {
            second += static_cast<double>(k) * power * g[k - 1];
            power *= h;
            first += power * g[k - 1];
        }
        const double open = first * slope_apart + second * apart + heaviest * apart * slope_apart + residual;
        return value - (half * change + rounding + open) * upward;
    }
};

void PowerWatch::walk(const Power& power, double from, double to, int depth) {
    if (power.low(from, to) > 0) {
        return;
    }
    const double middle = 0.5 * (from + to); // exact: a half
    if (depth >= max_halvings || !(middle > from && middle < to) ||
        // cost: halvings
        (depth > 12 && !(power.low(middle, middle) > 0) && !(power.low(to, to) > 0) && !(power.low(from, from) > 0))) {
        if (!open_.empty() && open_.back().second == from) {
            open_.back().second = to;
        } else {
            open_.emplace_back(from, to);
        }
        return;
    }
    walk(power, from, middle, depth + 1);
    walk(power, middle, to, depth + 1);
}

/// Forces that balance the load at the centre, and the residual.
PowerWatch::Balance PowerWatch::balance(const CurvePiece& piece) const {
    const IsostaticStructure& structure = piece.structure();
    const sparse::Matrix<double>& h = structure.matrix();
    const auto n = static_cast<std::size_t>(structure.size());
    const std::vector<double> load =
        power_.infinitesimal ? power_.load->infinitesimal : power_.load->external_force(*piece.curve().start);
    const std::vector<double> force = on_dofs(load, structure.dofs());
    Balance balance{force, 0};
    piece.factorisation().solve_forces(balance.f);
    std::vector<double> residual = force;
    std::vector<double> size(n);
    std::vector<double> terms(n, 7); // bounds.md V3 (c + 7)
    for (std::size_t mu = 0; mu < n; ++mu) {
        size[mu] = std::abs(force[mu]);
    }
    for (std::size_t l = 0; l < n; ++l) {
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            const auto entry = static_cast<std::size_t>(e);
            const auto mu = static_cast<std::size_t>(h.row[entry]);
            const double term = h.value[entry] * balance.f[l];
            residual[mu] -= term;
            size[mu] += std::abs(term);
            terms[mu] += 1;
        }
    }
    double square = 0;
    for (std::size_t mu = 0; mu < n; ++mu) {
        const double bound = std::abs(residual[mu]) + 1.001 * terms[mu] * u * size[mu]; // bounds.md V3 (residual)
        square += bound * bound;
    }
    balance.residual = std::sqrt(square);
    return balance;
}

/// Adds the part of the free row; returns the largest speed.
double PowerWatch::add_row(const CurvePiece& piece, double force, Power& power) {
    const auto& a = piece.coefficients();
    const auto count = static_cast<double>(piece.structure().size());
    const double granted = row_units(piece.centre().dimension) + 8; // arcs.md A8 (a row, and its factors)
    double speed = 0;
    double reach_power = 1;
    for (std::size_t k = 1; k <= a.size(); ++k, reach_power *= piece.reach()) {
        const RoundedSum sum = piece.along_row(a[k - 1]);
        const auto factor = static_cast<double>(k);
        power.c[k - 1] -= factor * force * sum.value;
        const double later = k > 1 ? count * std::abs(sum.value) : 0; // rounding of later additions
        power.c_open[k - 1] += u * factor * std::abs(force) * (granted * sum.absolute + later);
        double norm = 0;
        for (const double x : a[k - 1]) {
            norm += x * x;
        }
        speed += factor * reach_power * std::sqrt(norm);
    }
    return speed;
}

/// Adds the part of a kept contact of two disks.
void PowerWatch::add_contact(const CurvePiece& piece, std::size_t l, double force, Power& power) {
    const auto d = piece.differences(l);
    const std::size_t order = piece.coefficients().size();
    const auto count = static_cast<double>(piece.structure().size());
    const auto line = separation(piece.centre().layout(), piece.centre().q, piece.curve().contacts[l]);
    const double weight = force / std::sqrt(dot(line, line));
    power.heaviest = std::max(power.heaviest, std::abs(weight));
    for (std::size_t k = 1; k <= order; ++k) {
        power.g[k - 1] += weight * weight * dot(d[k], d[k]);
    }
    for (std::size_t k = 2; k <= 2 * order; ++k) {
        const RoundedSum sum = half_square(d, k);
        const double factor = static_cast<double>(k) * weight;
        power.c[k - 1] += factor * sum.value;
        // arcs.md A8
        power.c_open[k - 1] += (2 * static_cast<double>(k) + 24 + count) * u * std::abs(factor) * sum.absolute;
    }
}

PowerWatch::Power PowerWatch::power_along(const CurvePiece& piece) const {
    const KeptCurve& curve = piece.curve();
    const Balance forces = balance(piece);
    const std::size_t order = piece.coefficients().size();
    Power power;
    power.c.assign(2 * order, 0.0);
    power.c_open.assign(2 * order, 0.0);
    power.g.assign(order, 0.0);
    const double speed = add_row(piece, forces.f[curve.slot], power);
    for (std::size_t l = 0; l < curve.contacts.size(); ++l) {
        if (curve.bends(l)) {
            add_contact(piece, l, forces.f[l], power);
        }
    }
    for (double& x : power.g) {
        x = std::sqrt(x) * upward;
    }
    const double spread = std::sqrt(curve.spread);
    power.apart = (spread * piece.radius() + curve.rest_residual) * upward;
    power.slope_apart = spread * piece.slope_error() * upward;
    power.residual = forces.residual * (speed + piece.slope_error()) * upward;
    return power;
}

void PowerWatch::look(const CurvePiece& piece, double from, double to) {
    if (power_.load == nullptr || (!power_.infinitesimal && power_.load->kind == LoadKind::true_stress)) {
        reason_ = power_.load == nullptr ? "no load was given" : "true stresses are not dead loads";
        return;
    }
    open_.clear();
    walk(power_along(piece), from, to, 0);
    ++pieces_;
    inner_open_ = inner_open_ || last_open_ > 0; // the previous piece was not the last one
    last_open_ = 0;
    const double length = to - from;
    for (const auto& [low, high] : open_) {
        if (low == from && pieces_ == 1 && power_.starts_at_zero) {
            first_open_ = (high - low) / length;
        } else if (high == to) {
            last_open_ = (high - low) / length;
        } else {
            inner_open_ = true;
        }
    }
}

void PowerWatch::conclude(ArcCertificate& certificate, bool turns) const {
    certificate.power_reason = reason_;
    if (!reason_.empty()) {
        return;
    }
    certificate.power_open_start = first_open_;
    certificate.power_open_end = last_open_;
    if (inner_open_ || first_open_ > largest_open_start || last_open_ > (turns ? largest_open_end : 0)) {
        certificate.power_reason = "the power of the load is not proved positive all along the arc";
        return;
    }
    certificate.power = Verdict::proved;
}

} // namespace isostat
