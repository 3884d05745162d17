#pragma once
/// \file
/// `TrueVertex` in one number type. Included by one source per type only. Bounds: statements V5 to V7,
/// proofs/true_vertex.md; every constant below is counted there.

#include "certificate/arithmetic.hpp"
#include "certificate/true_vertex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace isostat {

template <int Dim, class T> class TrueVertexAt final : public TrueVertex<Dim> {
  public:
    TrueVertexAt(const Subject<Dim>& subject, const Centre<Dim>& centre)
        : subject_(subject), centre_(centre), correction_(centre.packing.q.size(), T(0.0)) {
        enclose();
        if (radius_ < infinity) {
            claim_radii();
            make_columns();
        }
    }
    [[nodiscard]] Rung rung() const override { return A::rung; }
    [[nodiscard]] bool exists() const override { return exists_; }
    [[nodiscard]] double radius() const override { return claimed_radius_; }
    [[nodiscard]] double unique_radius() const override { return claimed_unique_radius_; }
    [[nodiscard]] double distance() const override { return (shift_ + radius_) * (1 + 4 * u); }
    [[nodiscard]] double sigma_min() const override { return sigma_; }
    [[nodiscard]] Interval gap(const Contact& contact) const override;
    std::vector<Interval> forces() override;
    std::vector<Interval> infinitesimal() override;
    LoadEndAnswer load_end(int direction) override;

  private:
    using A = Arithmetic<T>;
    static constexpr double u = 0x1p-53;
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr double sums = 1 + 1e-10; // sums of up to 10^6 non-negative terms and their roots
    /// Upper bound of the 2-norm of non-negative numbers; scaled, so that tiny ones are not lost to underflow.
    static double norm_above(const std::vector<double>& x) {
        const double largest = x.empty() ? 0.0 : *std::max_element(x.begin(), x.end());
        double square = 0;
        for (const double c : x) {
            square += (c / largest) * (c / largest);
        }
        return largest == 0 ? 0.0 : largest * std::sqrt(square) * sums; // a NaN stays one and proves nothing
    }

    /// |f*_l - value_l| <= bound for every l.
    struct Solution {
        std::vector<T> value;
        double bound = infinity;
    };
    /// A column of the contact matrix divided by lengths, not distances (V5): rows and entries.
    struct Entry {
        int row;
        T value;
    };

    /// x_j - x_i along one axis, or L - x_i, at the corrected centre.
    T difference(int from, int to) const {
        const auto i = static_cast<std::size_t>(from);
        const auto j = static_cast<std::size_t>(to);
        return A::difference(centre_.packing.q[j], centre_.packing.q[i]) + (correction_[j] - correction_[i]);
    }
    T length(const Contact& contact) const {
        const auto& radius = centre_.packing.radius;
        return T(radius[static_cast<std::size_t>(contact.i)]) + T(radius[static_cast<std::size_t>(contact.j)]);
    }
    /// |x_j - x_i|^2 - D^2.
    T power(const Contact& contact) const {
        T square(0.0);
        for (int a = 0; a < Dim; ++a) {
            const T d = difference(Dim * contact.i + a, Dim * contact.j + a);
            square += d * d;
        }
        const T d = length(contact);
        return square - d * d;
    }
    /// Gap of a disk and a wall.
    T wall_gap(const Contact& contact) const {
        const auto i = static_cast<std::size_t>(contact.i);
        const int coordinate = Dim * contact.i + contact.j;
        const auto k = static_cast<std::size_t>(coordinate);
        const double r = centre_.packing.radius[i];
        return contact.kind == ContactKind::lower_wall
                   ? A::difference(centre_.packing.q[k], r) + correction_[k]
                   : difference(coordinate, Dim * centre_.packing.disk_count() + contact.j) - T(r);
    }
    /// F_l of T9.
    T gap_function(const Contact& contact) const {
        return contact.kind == ContactKind::disk_disk ? power(contact) / (T(2.0) * length(contact)) : wall_gap(contact);
    }

    void enclose();
    void claim_radii();
    void make_columns();
    Solution solve(const std::vector<T>& load, double load_error) const;
    std::vector<T> external_force(bool loaded_wall_only) const;
    const Solution& present();
    const Solution& unit();
    const Solution& infinitesimal_solution();
    static Interval around(const T& value, double bound);
    std::vector<Interval> around(const Solution& solution) const;

    const Subject<Dim>& subject_;
    const Centre<Dim>& centre_;
    std::vector<T> correction_; ///< p: the enclosure is about q + p
    double shift_ = 0;          ///< bound of |p|
    double radius_ = infinity;  ///< 2-norm, about q + p
    double derivative_ = 0;     ///< beta: bound of |DF^-1| at q + p
    double sigma_ = 0;
    bool exists_ = false;
    double claimed_radius_ = infinity;
    double claimed_unique_radius_ = 0;
    std::vector<int> start_;
    std::vector<Entry> entry_;
    std::optional<Solution> present_, unit_, infinitesimal_;
};

template <int Dim, class T> void TrueVertexAt<Dim, T>::enclose() {
    const auto& contacts = subject_.state.contacts;
    const double k = centre_.lipschitz;
    if (!(centre_.inverse_norm < infinity)) {
        return;
    }
    const double largest_correction = 0x1p-10 * centre_.packing.min_radius();
    std::vector<T> accepted;
    for (int iteration = 0; iteration <= A::corrections; ++iteration) {
        std::vector<double> f;
        std::vector<double> bound;
        for (const Contact& contact : contacts) {
            f.push_back(A::rounded(gap_function(contact)));
            bound.push_back(std::abs(f.back()) * (1 + 2 * u) + 8 * A::unit * contact_length(centre_.packing, contact));
        }
        std::vector<double> moved;
        for (const T& c : correction_) {
            moved.push_back(std::abs(A::rounded(c)) * (1 + 2 * u));
        }
        const double largest = *std::max_element(moved.begin(), moved.end());
        const double shift = norm_above(moved);
        const double lost = centre_.inverse_norm * k * shift * (1 + 4 * u);
        if (!(largest <= largest_correction && lost < 0.5)) {
            break;
        }
        const double beta = centre_.inverse_norm / (1 - lost) * (1 + 4 * u);
        const double eta = beta * norm_above(bound) * (1 + 2 * u);
        const double product = beta * k * eta * (1 + 4 * u);
        const double radius = 1.18 * eta; // (1 - sqrt(1 - 2h)) / h <= 1.172 for h <= 1/4
        const bool better = product <= 0.25 && radius < 0.5 * radius_;
        if (better) {
            accepted = correction_;
            shift_ = shift;
            radius_ = radius;
            derivative_ = beta;
        } else if (!accepted.empty()) {
            break; // at the rounding of this type
        }
        if (iteration < A::corrections) {
            centre_.factorisation.solve_velocities(f); // approach velocities equal to the gaps close them
            for (std::size_t mu = 0; mu < f.size(); ++mu) {
                correction_[static_cast<std::size_t>(subject_.dofs.coordinate_of(static_cast<int>(mu)))] += T(f[mu]);
            }
        }
    }
    if (!accepted.empty()) {
        correction_ = std::move(accepted);
        sigma_ = (1 / derivative_ - k * radius_) * (1 - 8 * u);
    }
}

template <int Dim, class T> void TrueVertexAt<Dim, T>::claim_radii() {
    const std::vector<double>& stored = subject_.state.packing.q;
    std::vector<double> moved;
    for (std::size_t c = 0; c < stored.size(); ++c) {
        moved.push_back(std::abs(centre_.packing.q[c] - stored[c]) * (1 + 2 * u) +
                        std::abs(A::rounded(correction_[c])) * (1 + 2 * u));
    }
    const double largest = *std::max_element(moved.begin(), moved.end());
    const double away = norm_above(moved);
    claimed_radius_ = (largest + radius_) * (1 + 8 * u);
    // No other root within (1 + sqrt(1 - 2h)) / (beta K) >= 1.7 / (beta K) of q + p in the 2-norm.
    const double room = centre_.lipschitz == 0 ? infinity
                                               : (1.7 / (derivative_ * centre_.lipschitz) * (1 - 8 * u) - away) /
                                                     std::sqrt(static_cast<double>(subject_.size())) * (1 - 8 * u);
    // A sixteenth of it is claimed: enough to name the vertex, and within reach of a checker that uses another norm.
    claimed_unique_radius_ = std::max(claimed_radius_, room / 16);
    exists_ = sigma_ > 0 && claimed_radius_ <= room;
}

template <int Dim, class T> Interval TrueVertexAt<Dim, T>::gap(const Contact& contact) const {
    const double size = contact_length(centre_.packing, contact);
    double value = 0;
    if (contact.kind == ContactKind::disk_disk) {
        double square = 0;
        for (int a = 0; a < Dim; ++a) {
            const double d = A::rounded(difference(Dim * contact.i + a, Dim * contact.j + a));
            square += d * d;
        }
        value = A::rounded(power(contact)) / (std::sqrt(square) + size);
    } else {
        value = A::rounded(wall_gap(contact));
    }
    constexpr double root2 = 1.4142135623731;
    return around(T(value),
                  root2 * radius_ * (1 + 4 * u) + 8 * A::unit * (std::abs(value) + size) + 16 * u * std::abs(value));
}

template <int Dim, class T> void TrueVertexAt<Dim, T>::make_columns() {
    start_.push_back(0);
    for (const Contact& contact : subject_.state.contacts) {
        const auto add = [&](int coordinate, const T& value) {
            const int dof = subject_.dofs.dof_of(static_cast<std::size_t>(coordinate));
            if (dof >= 0) {
                entry_.push_back({dof, value});
            }
        };
        if (contact.kind == ContactKind::disk_disk) {
            const T d = length(contact);
            for (int a = 0; a < Dim; ++a) {
                const T n = difference(Dim * contact.i + a, Dim * contact.j + a) / d;
                add(Dim * contact.i + a, n);
                add(Dim * contact.j + a, -n);
            }
        } else if (contact.kind == ContactKind::lower_wall) {
            add(Dim * contact.i + contact.j, T(-1.0));
        } else {
            add(Dim * contact.i + contact.j, T(1.0));
            add(Dim * centre_.packing.disk_count() + contact.j, T(-1.0));
        }
        start_.push_back(static_cast<int>(entry_.size()));
    }
}

template <int Dim, class T>
auto TrueVertexAt<Dim, T>::solve(const std::vector<T>& load, double load_error) const -> Solution {
    const auto n = static_cast<std::size_t>(subject_.size());
    Solution best;
    std::vector<T> x(n, T(0.0));
    std::vector<double> step(n);
    std::vector<double> size(n);
    std::vector<double> unknown(n); // bounds of the exact residual, row by row
    std::vector<int> terms(n);
    for (int iteration = 0; iteration <= A::refinements + 1; ++iteration) {
        std::vector<T> residual = load;
        std::vector<double> weight(centre_.packing.radius.size(), 0.0); // sum of |f_l| / D_l at each disk
        for (std::size_t i = 0; i < n; ++i) {
            size[i] = std::abs(A::rounded(load[i]));
            terms[i] = 8; // 5 of the entry, 1 of the product, 2 of the load
        }
        for (std::size_t l = 0; l < n; ++l) {
            const double f = std::abs(A::rounded(x[l]));
            for (int e = start_[l]; e < start_[l + 1]; ++e) {
                const Entry& entry = entry_[static_cast<std::size_t>(e)];
                const auto i = static_cast<std::size_t>(entry.row);
                residual[i] -= entry.value * x[l];
                size[i] += f;
                ++terms[i];
            }
            const Contact& contact = subject_.state.contacts[l];
            if (contact.kind == ContactKind::disk_disk) {
                const double w = f / contact_length(centre_.packing, contact);
                weight[static_cast<std::size_t>(contact.i)] += w;
                weight[static_cast<std::size_t>(contact.j)] += w;
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            step[i] = A::rounded(residual[i]);
            unknown[i] = std::abs(step[i]) * (1 + 2 * u) + 1.02 * A::unit * terms[i] * size[i];
        }
        const double heaviest = weight.empty() ? 0.0 : *std::max_element(weight.begin(), weight.end());
        const double turned = 2 * heaviest * radius_ * sums; // what the distance to the true vertex does to A f
        const double bound = (norm_above(unknown) + load_error + turned) / sigma_ * (1 + 8 * u);
        const bool enough = !(bound < 0.5 * best.bound);
        if (bound < best.bound) {
            best = {x, bound};
        }
        if (iteration > 0 && enough) {
            break;
        }
        centre_.factorisation.solve_forces(step);
        for (std::size_t l = 0; l < n; ++l) {
            x[l] += T(step[l]);
        }
    }
    return best;
}

template <int Dim, class T> std::vector<T> TrueVertexAt<Dim, T>::external_force(bool loaded_wall_only) const {
    const Load<Dim>& load = subject_.state.load;
    const DofMap<Dim>& dofs = subject_.dofs;
    std::vector<T> force(static_cast<std::size_t>(dofs.dof_count()), T(0.0));
    if (!loaded_wall_only) {
        for (std::size_t k = 0; k < load.disk_force.size(); ++k) {
            if (dofs.dof_of(k) >= 0) {
                force[static_cast<std::size_t>(dofs.dof_of(k))] = T(load.disk_force[k]);
            }
        }
    }
    for (const WallForce& wall : load.wall_forces(centre_.packing)) {
        if (loaded_wall_only && !wall.loaded) {
            continue;
        }
        const double stress = loaded_wall_only ? 1.0 : wall.stress;
        const auto dof = static_cast<std::size_t>(dofs.dof_of(static_cast<std::size_t>(wall.coordinate)));
        force[dof] = wall.length_at < 0
                         ? -A::product(stress, wall.length)
                         : -(T(stress) * (T(wall.length) + correction_[static_cast<std::size_t>(wall.length_at)]));
    }
    return force;
}

template <int Dim, class T> auto TrueVertexAt<Dim, T>::present() -> const Solution& {
    if (!present_) {
        const Load<Dim>& load = subject_.state.load;
        // True stresses act on the lengths of the true vertex.
        const double error =
            load.kind == LoadKind::nominal ? 0.0 : std::hypot(load.stress[0], load.stress[1]) * radius_ * (1 + 8 * u);
        present_ = solve(external_force(false), error);
        for (std::size_t l = 0; l < subject_.zero.size(); ++l) {
            if (subject_.zero[l] != 0) {
                present_->value[l] = T(0.0); // known exactly
            }
        }
    }
    return *present_;
}

template <int Dim, class T> auto TrueVertexAt<Dim, T>::unit() -> const Solution& {
    if (!unit_) {
        unit_ = solve(external_force(true), subject_.state.load.kind == LoadKind::nominal ? 0.0 : radius_);
    }
    return *unit_;
}

template <int Dim, class T> auto TrueVertexAt<Dim, T>::infinitesimal_solution() -> const Solution& {
    if (!infinitesimal_) {
        std::vector<T> force(static_cast<std::size_t>(subject_.dofs.dof_count()), T(0.0));
        const std::vector<double>& g = subject_.state.load.infinitesimal;
        for (std::size_t k = 0; k < g.size(); ++k) {
            if (subject_.dofs.dof_of(k) >= 0) {
                force[static_cast<std::size_t>(subject_.dofs.dof_of(k))] = T(g[k]);
            }
        }
        infinitesimal_ = solve(force, 0);
    }
    return *infinitesimal_;
}

template <int Dim, class T> Interval TrueVertexAt<Dim, T>::around(const T& value, double bound) {
    const double middle = A::rounded(value);
    const double half = bound + 4 * u * std::abs(middle); // dropping the low part, and the sum
    const Interval interval{std::nextafter(middle - half, -infinity), std::nextafter(middle + half, infinity)};
    return interval.lower <= interval.upper ? interval : Interval{-infinity, infinity}; // a NaN says nothing
}

template <int Dim, class T> std::vector<Interval> TrueVertexAt<Dim, T>::around(const Solution& solution) const {
    std::vector<Interval> intervals;
    for (const T& value : solution.value) {
        intervals.push_back(around(value, solution.bound));
    }
    return intervals;
}

template <int Dim, class T> std::vector<Interval> TrueVertexAt<Dim, T>::forces() {
    std::vector<Interval> intervals = around(present());
    for (std::size_t l = 0; l < intervals.size(); ++l) {
        if (subject_.zero[l] != 0) {
            intervals[l] = {0, 0};
        }
    }
    return intervals;
}

template <int Dim, class T> std::vector<Interval> TrueVertexAt<Dim, T>::infinitesimal() {
    return around(infinitesimal_solution());
}

template <int Dim, class T> LoadEndAnswer TrueVertexAt<Dim, T>::load_end(int direction) {
    const Solution& force = present();
    const Solution& slope = unit();
    const int count = subject_.size();
    const auto index = [](int l) { return static_cast<std::size_t>(l); };
    const auto name = [this, index](int l) { return to_string<Dim>(subject_.state.contacts[index(l)]); };
    const auto rate = [&](int l) { return direction * A::rounded(slope.value[index(l)]); };
    int first = -1;
    double smallest = infinity;
    for (int l = 0; l < count; ++l) {
        if (subject_.zero_slope[index(l)] == 0 && rate(l) < 0) {
            const double distance = A::rounded(force.value[index(l)]) / -rate(l);
            if (distance < smallest) {
                smallest = distance;
                first = l;
            }
        }
    }
    if (first < 0) {
        for (int l = 0; l < count; ++l) {
            if (subject_.zero_slope[index(l)] == 0 && !(rate(l) > slope.bound * (1 + 4 * u))) {
                return {{},
                        fmt::format("the force in contact {} changes with the load at a rate of {:.3g}, proved to "
                                    "{:.3g}",
                                    name(l), rate(l) * direction, slope.bound)};
            }
        }
        LoadEndClaim claim;
        claim.unbounded = true;
        return {claim, {}};
    }
    const double steepness = -rate(first) * (1 - 4 * u) - slope.bound;
    if (!(steepness > 0)) {
        return {{},
                fmt::format("the force in contact {} changes with the load at a rate of {:.3g}, proved to {:.3g}",
                            name(first), rate(first) * direction, slope.bound)};
    }
    // The load of the end is sigma - t.
    const T t = force.value[index(first)] / slope.value[index(first)];
    const double size = std::abs(A::rounded(t));
    const double error = ((force.bound + size * slope.bound) / steepness + 4 * A::unit * size) * (1 + 16 * u);
    const std::vector<int> members = subject_.vanish_with(first);
    std::vector<unsigned char> skip = subject_.zero; // 0 at every load
    skip[index(first)] = 1;
    for (const int l : members) {
        skip[index(l)] = 1;
    }
    for (int l = 0; l < count; ++l) {
        if (skip[index(l)] != 0 || subject_.zero_slope[index(l)] != 0) {
            continue;
        }
        const T product = slope.value[index(l)] * t;
        const double value = A::rounded(force.value[index(l)] - product);
        const double b = std::abs(A::rounded(slope.value[index(l)]));
        const double bound = (force.bound + size * slope.bound + (b + slope.bound) * error +
                              4 * A::unit * (std::abs(A::rounded(force.value[index(l)])) + b * size)) *
                                 (1 + 16 * u) +
                             2 * u * std::abs(value);
        if (!(value > bound)) {
            return {{},
                    fmt::format("the forces in contacts {} and {} vanish at loads that are not ordered: where the "
                                "first is 0 the second is {:.3g}, proved to {:.3g}",
                                name(first), name(l), value, bound)};
        }
    }
    // Which of a class is named decides nothing; the infinitesimal loads say which one a run would open.
    int opens = first;
    if (!members.empty() && !subject_.state.load.infinitesimal.empty()) {
        const Solution& g = infinitesimal_solution();
        const auto key = [&](int l) { return A::rounded(g.value[index(l)]) / std::abs(rate(l)); };
        for (const int l : members) {
            opens = rate(l) != 0 && key(l) < key(opens) ? l : opens;
        }
    }
    LoadEndClaim claim;
    const double sigma = subject_.state.load.stress[static_cast<std::size_t>(subject_.state.load.loaded_axis)];
    claim.stress = around(T(sigma) - t, error + 2 * A::unit * (std::abs(sigma) + size));
    claim.opens = subject_.state.contacts[index(opens)];
    return {claim, {}};
}

} // namespace isostat
