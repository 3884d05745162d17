#include "motion/curve_piece.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;
constexpr double infinity = std::numeric_limits<double>::infinity();
/// Sums of up to 10^6 terms, their roots and a few products: relative rounding below 1e-9 (proofs/bounds.md).
constexpr double up = 1 + 1e-9;
constexpr double root2 = 1.4142135623731;
/// Share of sigma_min that the change of the derivative over a piece may take. Cost only.
constexpr double share = 0.7;
constexpr int max_order = 14;
constexpr double longest_reach = 0.2; ///< in units of the smallest radius

double norm(const std::vector<double>& x) {
    double sum = 0;
    for (const double c : x) {
        sum += c * c;
    }
    return std::sqrt(sum);
}

double largest(const std::vector<double>& x) {
    double value = 0;
    for (const double c : x) {
        value = std::max(value, std::abs(c));
    }
    return value;
}

/// Difference of a vector over the two grains of a contact: Dim components for disks, one for walls.
template <int Dim>
std::array<double, Dim> difference(const std::vector<double>& a, const Contact& contact, std::size_t disks) {
    std::array<double, Dim> d{};
    const auto i = static_cast<std::size_t>(Dim * contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    switch (contact.kind) {
    case ContactKind::disk_disk:
        for (std::size_t c = 0; c < Dim; ++c) {
            d[c] = a[Dim * j + c] - a[i + c];
        }
        break;
    case ContactKind::lower_wall: d[0] = a[i + j]; break;
    case ContactKind::upper_wall: d[0] = a[Dim * disks + j] - a[i + j]; break;
    case ContactKind::held: d[0] = a[static_cast<std::size_t>(contact.i)]; break;
    }
    return d;
}

template <int Dim> double dot(const std::array<double, Dim>& x, const std::array<double, Dim>& y) {
    double sum = 0;
    for (std::size_t c = 0; c < Dim; ++c) {
        sum += x[c] * y[c];
    }
    return sum;
}

template <int Dim> double absolute_dot(const std::array<double, Dim>& x, const std::array<double, Dim>& y) {
    double sum = 0;
    for (std::size_t c = 0; c < Dim; ++c) {
        sum += std::abs(x[c] * y[c]);
    }
    return sum;
}

} // namespace

template <int Dim>
KeptCurve<Dim>::KeptCurve(const Packing<Dim>& start_packing, std::vector<Contact> list, std::size_t slot_index,
                          double rest)
    : start(&start_packing), contacts(std::move(list)), slot(slot_index), dofs(start_packing), smallest(infinity),
      rest_radius(rest) {
    const std::size_t disks = start->radius.size();
    std::vector<int> count(disks, 0);
    std::vector<int> at_rest(disks + Dim, 0);
    double most_at_rest = 0;
    target.resize(contacts.size());
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        const auto i = static_cast<std::size_t>(c.i);
        const auto j = static_cast<std::size_t>(c.j);
        target[l] = c.kind == ContactKind::held        ? 0
                    : c.kind == ContactKind::disk_disk ? start->radius[i] + start->radius[j]
                                                       : start->radius[i];
        if (l == slot) {
            continue;
        }
        if (c.kind == ContactKind::disk_disk) {
            smallest = std::min(smallest, target[l]);
            for (const std::size_t k : {i, j}) {
                (start->is_fixed(DiskId(k)) ? at_rest : count)[k]++;
            }
        } else if (c.kind == ContactKind::upper_wall) {
            at_rest[disks + j] += start->walls.upper[j] == WallKind::movable ? 0 : 1;
        }
    }
    degree = count.empty() ? 0 : *std::max_element(count.begin(), count.end());
    most_at_rest = *std::max_element(at_rest.begin(), at_rest.end());
    if (smallest < infinity) {
        lipschitz = 2 * std::sqrt(std::max(degree, 1.0)) / smallest * up;
    }
    const double weight = std::sqrt(most_at_rest) * rest_radius;
    rest_residual = 1.01 * weight * up;
    rest_derivative = smallest < infinity ? weight / smallest * up : 0;
}

template <int Dim>
CurvePiece<Dim>::CurvePiece(const KeptCurve<Dim>& curve, Packing<Dim> centre, const IsostaticStructure<Dim>& structure,
                            const Factorisation& factorisation, double sigma_min, double forward)
    : curve_(&curve), centre_(std::move(centre)), structure_(&structure), factorisation_(&factorisation),
      forward_(forward) {
    row_ = gap_gradient(centre_, structure.contacts()[curve.slot]);
    double ratio = 0; // |gap| / D of the kept contacts and of the one in the free row
    for (std::size_t l = 0; l < curve.contacts.size(); ++l) {
        const Contact& c = structure.contacts()[l];
        if (c.kind == ContactKind::disk_disk && l != curve.slot) {
            ratio = std::max(ratio, std::abs(gap(centre_, c)) / curve.target[l]);
        }
    }
    if (!(sigma_min > 0) || !(ratio < 1e-3)) {
        return;
    }
    inverse_ = (1 + 2 * ratio + 8 * u) / sigma_min * up;
    expand();
    if (!a_.empty()) {
        bound_coefficients();
        shorten_reach();
    }
}

template <int Dim> std::vector<double> CurvePiece<Dim>::solved(std::vector<double> rhs) const {
    factorisation_->solve_velocities(rhs);
    std::vector<double> y(centre_.q.size(), 0.0);
    const DofMap<Dim>& dofs = structure_->dofs();
    for (std::size_t mu = 0; mu < rhs.size(); ++mu) {
        y[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)))] = rhs[mu];
    }
    return y;
}

template <int Dim> void CurvePiece<Dim>::expand() {
    const auto& contacts = curve_->contacts;
    const std::size_t n = contacts.size();
    const std::size_t disks = centre_.radius.size();
    std::vector<double> rhs(n, 0.0);
    rhs[curve_->slot] = -forward_; // approach velocity: minus the rate of the row
    std::vector<double> a = solved(rhs);
    const double scale = 1 / largest(a);
    if (!std::isfinite(scale) || !(scale > 0)) {
        return;
    }
    for (double& x : a) {
        x *= scale;
    }
    a_.push_back(std::move(a));
    std::vector<double> e(n, 0.0);
    std::vector<std::vector<std::array<double, Dim>>> d; // differences of a_k per contact
    std::vector<double> length(n, 1.0);
    const auto differences = [&](const std::vector<double>& vector) {
        std::vector<std::array<double, Dim>> list(n);
        for (std::size_t l = 0; l < n; ++l) {
            list[l] = difference<Dim>(vector, contacts[l], disks);
        }
        d.push_back(std::move(list));
    };
    differences(a_[0]);
    for (std::size_t l = 0; l < n; ++l) {
        if (l != curve_->slot && contacts[l].kind == ContactKind::disk_disk) {
            const auto line = difference<Dim>(centre_.q, contacts[l], disks);
            length[l] = std::sqrt(dot<Dim>(line, line));
            e[l] = std::sqrt(dot<Dim>(d[0][l], d[0][l])) / curve_->target[l];
        }
    }
    const double turning = norm_of(e);
    // No longer than what a candidate list allows.
    const double longest = longest_reach * centre_.min_radius();
    reach_ = turning > 0 ? std::min(share / (inverse_ * turning), longest) : longest;
    const double negligible = 0x1p-60 * centre_.min_radius();
    for (int k = 2; k <= max_order; ++k) {
        for (std::size_t l = 0; l < n; ++l) {
            double sum = 0;
            if (l != curve_->slot && contacts[l].kind == ContactKind::disk_disk) {
                for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(k) + 1; ++i) {
                    sum += dot<Dim>(d[i - 1][l], d[static_cast<std::size_t>(k) - i - 1][l]);
                }
            }
            rhs[l] = 0.5 * sum / length[l];
        }
        a_.push_back(solved(rhs));
        const double size = largest(a_.back()) * std::pow(reach_, k);
        if (!std::isfinite(size)) {
            a_.pop_back();
            break;
        }
        if (size < negligible) {
            break;
        }
        differences(a_.back());
    }
}

template <int Dim> void CurvePiece<Dim>::bound_coefficients() {
    const auto& contacts = curve_->contacts;
    const std::size_t n = contacts.size();
    const std::size_t disks = centre_.radius.size();
    const std::size_t order = a_.size();
    relative_.assign(n * order, 0.0);
    residual_.assign(n * (2 * order + 1), 0.0);
    std::vector<std::array<double, Dim>> d(order + 1);
    for (std::size_t l = 0; l < n; ++l) {
        if (l == curve_->slot) {
            continue;
        }
        const Contact& c = contacts[l];
        double* size = &relative_[l * order];
        double* bound = &residual_[l * (2 * order + 1)];
        for (std::size_t k = 1; k <= order; ++k) {
            d[k] = difference<Dim>(a_[k - 1], c, disks);
            size[k - 1] = std::sqrt(dot<Dim>(d[k], d[k])) * up;
        }
        if (c.kind == ContactKind::held) {
            const auto k = static_cast<std::size_t>(c.i);
            bound[0] = std::abs(centre_.q[k] - curve_->start->q[k]) * (1 + 2 * u);
            std::copy(size, size + order, bound + 1);
            continue;
        }
        // |F| <= |gap| (1 + |gap| / 2D), |gap| < 1e-3 D; the computed gap is off by less than 8u D.
        const double length = curve_->target[l];
        bound[0] = 1.001 * std::abs(gap(centre_, c)) + 8 * u * length;
        if (c.kind != ContactKind::disk_disk) {
            std::copy(size, size + order, bound + 1);
            continue;
        }
        const std::array<double, Dim> line = difference<Dim>(centre_.q, c, disks);
        for (std::size_t k = 1; k <= 2 * order; ++k) {
            double sum = 0;
            double absolute = 0;
            for (std::size_t i = k > order ? k - order : 1; i <= std::min(order, k - 1); ++i) {
                sum += dot<Dim>(d[i], d[k - i]);
                absolute += absolute_dot<Dim>(d[i], d[k - i]);
            }
            sum *= 0.5;
            absolute *= 0.5;
            if (k <= order) {
                sum += dot<Dim>(line, d[k]);
                absolute += absolute_dot<Dim>(line, d[k]);
            }
            bound[k] = (std::abs(sum) + (static_cast<double>(k) + 16) * u * absolute) / length * (1 + 8 * u);
        }
    }
}

/// Shortens the reach until the polynomial misses the equations by no more than the centre itself does.
template <int Dim> void CurvePiece<Dim>::shorten_reach() {
    const std::size_t order = a_.size();
    const std::size_t stride = 2 * order + 1;
    for (int attempt = 0; attempt < 60; ++attempt, reach_ *= 0.85) {
        double at_centre = 0;
        double beyond = 0;
        for (std::size_t l = 0; l < curve_->contacts.size(); ++l) {
            const double* c = &residual_[l * stride];
            double value = 0;
            for (std::size_t k = stride - 1; k >= 1; --k) {
                value = (value + c[k]) * reach_;
            }
            at_centre += c[0] * c[0];
            beyond += value * value;
        }
        if (beyond <= 4 * at_centre) {
            return;
        }
    }
}

template <int Dim> double CurvePiece<Dim>::norm_of(const std::vector<double>& e) const {
    // |B|^2 = largest eigenvalue of B^T B <= max_i (B^T B x)_i / x_i for every positive x (Collatz, Wielandt).
    const auto& contacts = curve_->contacts;
    std::vector<double> x(centre_.radius.size(), 1.0);
    std::vector<double> z(x.size());
    double best = infinity;
    for (int round = 0; round < 6; ++round) {
        std::fill(z.begin(), z.end(), 0.0);
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (e[l] == 0) {
                continue;
            }
            const auto i = static_cast<std::size_t>(contacts[l].i);
            const auto j = static_cast<std::size_t>(contacts[l].j);
            const bool i_moves = !curve_->start->is_fixed(DiskId(i));
            const bool j_moves = !curve_->start->is_fixed(DiskId(j));
            const double y = e[l] * e[l] * ((i_moves ? x[i] : 0) + (j_moves ? x[j] : 0));
            z[i] += i_moves ? y : 0;
            z[j] += j_moves ? y : 0;
        }
        double ratio = 0;
        double most = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            ratio = std::max(ratio, z[i] / x[i]);
            most = std::max(most, z[i]);
        }
        best = std::min(best, ratio);
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] = z[i] + 1e-3 * most + 1e-300;
        }
    }
    return std::sqrt(best) * up;
}

/// |sum_k s^k (difference of a_k)| / D of every kept disk contact, for all |s| <= h.
template <int Dim> std::vector<double> CurvePiece<Dim>::stretch(double h) const {
    const std::size_t order = a_.size();
    std::vector<double> e(curve_->contacts.size(), 0.0);
    for (std::size_t l = 0; l < e.size(); ++l) {
        if (l == curve_->slot || curve_->contacts[l].kind != ContactKind::disk_disk) {
            continue;
        }
        double power = h;
        for (std::size_t k = 0; k < order; ++k, power *= h) {
            e[l] += power * relative_[l * order + k];
        }
        e[l] /= curve_->target[l];
    }
    return e;
}

template <int Dim> bool CurvePiece<Dim>::prove(double h) {
    proved_ = 0;
    if (a_.empty() || !(h > 0)) {
        return false;
    }
    const KeptCurve<Dim>& curve = *curve_;
    const std::size_t order = a_.size();
    const double lost = inverse_ * (norm_of(stretch(h)) + curve.rest_derivative) * up;
    if (!(lost <= 0.8)) {
        return false;
    }
    const double inverse = inverse_ / (1 - lost) * up; // at every p(s)
    double residual = 0;
    double residual_rate = 0;
    double turn = 0; // largest |difference of p'| / D
    for (std::size_t l = 0; l < curve.contacts.size(); ++l) {
        if (l == curve.slot) {
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
        residual += value * value;
        residual_rate += rate * rate;
        if (curve.contacts[l].kind == ContactKind::disk_disk) {
            double speed = 0;
            power = 1;
            for (std::size_t k = 1; k <= order; ++k, power *= h) {
                speed += static_cast<double>(k) * power * relative_[l * order + k - 1];
            }
            turn = std::max(turn, speed / curve.target[l]);
        }
    }
    residual = (std::sqrt(residual) + curve.rest_residual) * up;
    residual_rate = (std::sqrt(residual_rate) + turn * curve.rest_residual) * up;
    const double product = inverse * inverse * curve.lipschitz * residual * up;
    if (!(product <= 0.25)) {
        return false;
    }
    const double radius = 2 * inverse * residual * up;
    const double at_curve = inverse / (1 - inverse * curve.lipschitz * radius) * up;
    // The rate of the row along p, and the speed of p.
    double row_rate = 0;
    double row_loss = 0;
    double power = 1;
    double speed = 0;
    for (std::size_t k = 1; k <= order; ++k, power *= h) {
        double sum = 0;
        double absolute = 0;
        for (int g = 0; g < row_.count; ++g) {
            const auto e = static_cast<std::size_t>(g);
            const double term = row_.value[e] * a_[k - 1][static_cast<std::size_t>(row_.coordinate[e])];
            sum += term;
            absolute += std::abs(term);
        }
        if (k == 1) {
            row_rate = sum * forward_ - 16 * u * absolute;
        } else {
            row_loss += static_cast<double>(k) * power * (std::abs(sum) + 16 * u * absolute);
        }
        speed += static_cast<double>(k) * power * norm(a_[k - 1]);
    }
    row_rate = (row_rate - row_loss * up) * (1 - 1e-9);
    if (!(row_rate > 0) || !std::isfinite(speed)) {
        return false;
    }
    radius_ = radius;
    unique_ = curve.lipschitz > 0 ? (1 - 1e-9) / (inverse * curve.lipschitz) : infinity;
    slope_error_ = at_curve * (residual_rate + turn * std::sqrt(2 * std::max(curve.degree, 1.0)) * radius) * up;
    margin_ = product > 0 ? 0.25 / product : infinity;
    row_rate_ = row_rate;
    speed_ = speed * up;
    proved_ = h;
    return true;
}

template <int Dim> std::vector<double> CurvePiece<Dim>::point(double s) const {
    std::vector<double> x = centre_.q;
    for (std::size_t mu = 0; mu < static_cast<std::size_t>(structure_->size()); ++mu) {
        const auto k = static_cast<std::size_t>(structure_->dofs().coordinate_of(static_cast<int>(mu)));
        double sum = 0;
        for (std::size_t order = a_.size(); order > 0; --order) {
            sum = (sum + a_[order - 1][k]) * s;
        }
        x[k] += sum;
    }
    return x;
}

template <int Dim> std::vector<double> CurvePiece<Dim>::slope(double s) const {
    std::vector<double> v(centre_.q.size(), 0.0);
    for (std::size_t mu = 0; mu < static_cast<std::size_t>(structure_->size()); ++mu) {
        const auto k = static_cast<std::size_t>(structure_->dofs().coordinate_of(static_cast<int>(mu)));
        for (std::size_t order = a_.size(); order > 0; --order) {
            v[k] = v[k] * s + static_cast<double>(order) * a_[order - 1][k];
        }
    }
    return v;
}

template <int Dim>
std::optional<typename CurvePiece<Dim>::Place> CurvePiece<Dim>::locate(const std::vector<double>& x,
                                                                       double uncertainty) const {
    if (!(proved_ > 0)) {
        return std::nullopt;
    }
    // Newton on row . (x - p(s)) = 0: any s will do, the bound below is what counts.
    const auto along = [&](const std::vector<double>& v) {
        double sum = 0;
        for (int g = 0; g < row_.count; ++g) {
            const auto e = static_cast<std::size_t>(g);
            sum += row_.value[e] * v[static_cast<std::size_t>(row_.coordinate[e])];
        }
        return sum;
    };
    std::vector<double> off(x.size());
    const auto difference_at = [&](double s) {
        const std::vector<double> p = point(s);
        for (std::size_t c = 0; c < x.size(); ++c) {
            off[c] = x[c] - p[c];
        }
        return along(off);
    };
    double s = 0;
    for (int k = 0; k < 8; ++k) {
        const double change = difference_at(s) / along(slope(s));
        if (!std::isfinite(change) || std::abs(s + change) > 1.5 * proved_) {
            return std::nullopt;
        }
        s += change;
        if (std::abs(change) <= 1e-14 * proved_) {
            break;
        }
    }
    const double remaining = difference_at(s);
    double square = 0;
    double coordinate = proved_;
    for (std::size_t mu = 0; mu < static_cast<std::size_t>(structure_->size()); ++mu) {
        const auto k = static_cast<std::size_t>(structure_->dofs().coordinate_of(static_cast<int>(mu)));
        square += off[k] * off[k];
        coordinate = std::max({coordinate, std::abs(x[k]), std::abs(centre_.q[k])});
    }
    double terms = 0; // of Horner's scheme, with the operations that each goes through (A8)
    double power = 1;
    for (std::size_t k = 0; k < a_.size(); ++k) {
        power *= std::abs(s);
        terms += static_cast<double>(2 * k + 5) * power * largest(a_[k]);
    }
    const double rounding = std::sqrt(static_cast<double>(structure_->size())) * u * (16 * coordinate + terms);
    const double distance = (std::sqrt(square) + rounding) * up + uncertainty;
    Place place;
    place.s = s;
    place.slack = (std::abs(remaining) + 4 * u * (16 * coordinate + terms) + root2 * uncertainty) / row_rate_ * up;
    if (!(std::abs(s) + place.slack <= proved_ * (1 - 1e-9)) || !(distance + speed_ * place.slack * up < unique_)) {
        return std::nullopt;
    }
    return place;
}

template <int Dim> int CurvePiece<Dim>::direction_along(const CurvePiece& other, double s) const {
    const std::vector<double> v = slope(s);
    double sum = 0;
    double absolute = 0;
    for (int g = 0; g < other.row_.count; ++g) {
        const auto e = static_cast<std::size_t>(g);
        const double term = other.row_.value[e] * v[static_cast<std::size_t>(other.row_.coordinate[e])];
        sum += term;
        absolute += std::abs(term);
    }
    double size = 0; // of the terms of Horner's scheme
    double power = 1;
    for (std::size_t k = 0; k < a_.size(); ++k, power *= std::abs(s)) {
        size += static_cast<double>(k + 1) * power * largest(a_[k]);
    }
    const double error = (root2 * slope_error_ + 64 * u * (absolute + 4 * size)) * up;
    return sum > error ? 1 : -sum > error ? -1 : 0;
}

template <int Dim> std::optional<Packing<Dim>> CurvePiece<Dim>::corrected(double s) const {
    Packing<Dim> at = centre_;
    at.q = point(s);
    const std::vector<double> guess = at.q;
    const double rounding = 2 * grid_step(at);
    std::vector<double> rhs(curve_->contacts.size());
    double previous = infinity;
    for (int k = 0; k < 40; ++k) {
        for (std::size_t l = 0; l < rhs.size(); ++l) {
            const Contact& c = curve_->contacts[l];
            const auto i = static_cast<std::size_t>(c.i);
            rhs[l] = l == curve_->slot ? 0.0 : c.kind == ContactKind::held ? at.q[i] - curve_->start->q[i] : gap(at, c);
        }
        const std::vector<double> y = solved(rhs);
        const double size = largest(y);
        if (!(size < infinity) || (k > 2 && size > 0.9 * previous && size > 1e-9 * at.min_radius())) {
            return std::nullopt;
        }
        for (std::size_t c = 0; c < y.size(); ++c) {
            at.q[c] += y[c];
        }
        if (size <= rounding || (k > 2 && size > 0.5 * previous)) {
            break;
        }
        previous = size;
    }
    for (std::size_t c = 0; c < guess.size(); ++c) {
        if (!(std::abs(at.q[c] - guess[c]) <= 0.2 * std::abs(s))) {
            return std::nullopt; // perhaps another branch
        }
    }
    for (std::size_t l = 0; l < rhs.size(); ++l) {
        const Contact& c = curve_->contacts[l];
        if (c.kind == ContactKind::held && l != curve_->slot) {
            at.q[static_cast<std::size_t>(c.i)] = curve_->start->q[static_cast<std::size_t>(c.i)];
        }
    }
    snap_to_grid(at);
    return at;
}

template struct KeptCurve<2>;
template class CurvePiece<2>;

} // namespace isostat
