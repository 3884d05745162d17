#pragma once
/// \file
/// `TrueVertex` in one number type: what `EnclosedVertex` and `ContactSystem` know, as claims. Included by one source
/// per type only. Bounds: statements V5 to V7, proofs/true_vertex.md; every constant below is counted there.

#include "certificate/true_vertex.hpp"
#include "core/roundoff.hpp"
#include "statics/quotient.hpp"
#include "verified/contact_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat {

template <class T> class TrueVertexAt final : public TrueVertex {
  public:
    TrueVertexAt(const Subject& subject, const ProvedStructure& centre, const Arithmetic<T>& arithmetic)
        : subject_(subject), centre_(centre),
          vertex_(arithmetic, centre.packing, centre.structure, centre.factorisation,
                  Neighbourhood::of(centre.packing, centre.structure.contacts(), centre.inverse)) {
        if (vertex_.exists()) {
            claim_radii();
            system_.emplace(vertex_, centre.structure, centre.factorisation);
        }
    }
    [[nodiscard]] Rung rung() const override { return A::rung; }
    [[nodiscard]] bool exists() const override { return exists_; }
    [[nodiscard]] double radius() const override { return claimed_radius_; }
    [[nodiscard]] double unique_radius() const override { return claimed_unique_radius_; }
    [[nodiscard]] double distance() const override { return above(vertex_.distance()); }
    [[nodiscard]] double sigma_min() const override { return vertex_.sigma(); }
    [[nodiscard]] Interval gap(const Contact& contact) const override;
    std::vector<Interval> forces() override;
    std::vector<Interval> infinitesimal() override;
    LoadEndAnswer load_end(int direction) override;

  private:
    using A = Arithmetic<T>;
    static constexpr double u = roundoff::u;
    static constexpr double infinity = roundoff::infinity;

    /// |f*_l - value_l| <= bound for every l.
    struct Solution {
        std::vector<T> value;
        double bound = infinity;
    };

    [[nodiscard]] const A& arithmetic() const { return vertex_.at().arithmetic(); }
    [[nodiscard]] T number(double x) const { return arithmetic().number(x); }
    [[nodiscard]] double unit() const { return above(arithmetic().unit()); }
    void claim_radii();
    /// A length under a load: where it is a coordinate, that of the corrected configuration.
    [[nodiscard]] T now(double length, int at) const {
        return at < 0 ? number(length) : number(length) + vertex_.at().correction()[static_cast<std::size_t>(at)];
    }
    /// How far the pinned grain of a cell is from where it is stored: it was put on the grid.
    [[nodiscard]] double pin_moved(const std::vector<double>& stored) const {
        const Cell& cell = centre_.packing.cell;
        double most = 0;
        for (std::size_t a = 0; a < static_cast<std::size_t>(cell.dimension) && cell.any(); ++a) {
            const std::size_t k = static_cast<std::size_t>(cell.dimension) * static_cast<std::size_t>(cell.pin) + a;
            most = cell.periodic[a] ? std::max(most, std::abs(centre_.packing.q[k] - stored[k]) * (1 + 2 * u)) : most;
        }
        return most;
    }
    /// |F* - F| over the radius: what true stresses, or the loaded one alone at 1, change as their lengths do (V6).
    [[nodiscard]] double load_turn(bool by_the_loaded_stress) const;
    Solution solve(const std::vector<T>& load, double load_error) const;
    std::vector<T> external_force(bool by_the_loaded_stress) const;
    const Solution& present();
    const Solution& unit_load();
    const Solution& infinitesimal_solution();
    [[nodiscard]] static std::size_t index(int l) { return static_cast<std::size_t>(l); }
    [[nodiscard]] std::string name(int l) const {
        return to_string(subject_.state.contacts[index(l)], subject_.state.packing.dimension);
    }
    /// The supported interval ends where a contact opens; a bar bears forces of either sign.
    [[nodiscard]] bool limits(int l) const { return subject_.state.contacts[index(l)].is_unilateral(); }
    /// Of the force in contact l when the load goes in the direction.
    double rate(int l, int direction) { return direction * A::rounded(unit_load().value[index(l)]); }
    /// That rate is exactly 0.
    bool steady(int l);
    std::string open_rate(int l);
    LoadEndAnswer without_end(int direction);
    LoadEndAnswer vanishes_before(int first, const std::vector<int>& members, const T& t, double error);
    int opens(int first, const std::vector<int>& members, int direction);
    Interval around(const T& value, double bound) const;
    std::vector<Interval> around(const Solution& solution) const;

    const Subject& subject_;
    const ProvedStructure& centre_;
    EnclosedVertex<T> vertex_;
    std::optional<ContactSystem<T>> system_;
    bool exists_ = false;
    double claimed_radius_ = infinity;
    double claimed_unique_radius_ = 0;
    std::optional<Solution> present_, unit_, infinitesimal_;
    std::vector<unsigned char> sloped_; ///< of contacts, on first use: by the pattern, the force depends on the load
};

template <class T> void TrueVertexAt<T>::claim_radii() {
    const std::vector<double>& stored = subject_.state.packing.q;
    std::vector<double> moved;
    for (std::size_t c = 0; c < stored.size(); ++c) {
        moved.push_back(std::abs(centre_.packing.q[c] - stored[c]) * (1 + 2 * u) +
                        std::abs(A::rounded(vertex_.at().correction()[c])) * (1 + 2 * u));
    }
    if (const double shift = pin_moved(stored); shift > 0) { // the vertex is shifted back as a whole
        for (double& m : moved) {
            m += shift;
        }
    }
    const double largest = *std::ranges::max_element(moved);
    const double away = norm_of_bounds(moved);
    const double radius = above(vertex_.radius());
    claimed_radius_ = (largest + radius) * (1 + 8 * u); // precision.md B1 (last operations)
    // No other root within (1 + sqrt(1 - 2h)) / (beta K) >= 1.7 / (beta K) of q + p in the 2-norm.
    const double room = vertex_.lipschitz() == 0
                            ? infinity
                            // 1.7: true_vertex.md V5 (by bounds.md T9); 8: precision.md B1 (last operations)
                            : (1.7 / (vertex_.derivative() * vertex_.lipschitz()) * (1 - 8 * u) - away) /
                                  std::sqrt(static_cast<double>(subject_.size())) * (1 - 8 * u);
    // A sixteenth of it is claimed: enough to name the vertex, and within reach of a checker that uses another norm.
    // true_vertex.md V5 (a sixteenth is claimed)
    claimed_unique_radius_ = std::max(claimed_radius_, room / 16);
    exists_ = vertex_.sigma() > 0 && claimed_radius_ <= room;
}

template <class T> Interval TrueVertexAt<T>::gap(const Contact& contact) const {
    const CorrectedConfiguration<T>& at = vertex_.at();
    const double size = target(centre_.packing, contact);
    double value = 0;
    if (contact.of_disks()) {
        double square = 0;
        for (const T& r : at.separation(contact)) {
            const double d = A::rounded(r);
            square += d * d;
        }
        value = A::rounded(at.power(contact)) / (std::sqrt(square) + size);
    } else {
        value = A::rounded(at.wall_gap(contact));
    }
    const double radius = above(vertex_.radius());
    // precision.md B1 (last operations)
    return around(number(value), separation_weight(contact) * radius * (1 + 4 * u) +
                                     // 8: true_vertex.md V5 (other gaps, 8 e); 16: true_vertex.md V5 (other gaps, 16 u)
                                     8 * unit() * (std::abs(value) + size) + 16 * u * std::abs(value));
}

template <class T> auto TrueVertexAt<T>::solve(const std::vector<T>& load, double load_error) const -> Solution {
    auto solved = system_->forces(load, load_error, std::vector<T>(load.size(), number(0)));
    return {std::move(solved.value), above(solved.bound)};
}

template <class T> std::vector<T> TrueVertexAt<T>::external_force(bool by_the_loaded_stress) const {
    const Load& load = subject_.state.load;
    const DofMap& dofs = subject_.dofs;
    std::vector<T> force(static_cast<std::size_t>(dofs.dof_count()), number(0));
    if (!by_the_loaded_stress) {
        for (std::size_t k = 0; k < load.disk_force.size(); ++k) {
            if (dofs.dof_of(k) >= 0) {
                force[static_cast<std::size_t>(dofs.dof_of(k))] = number(load.disk_force[k]);
            }
        }
    }
    for (const WallForce& wall : load.wall_forces(centre_.packing)) {
        if (by_the_loaded_stress && wall.rate == 0) {
            continue;
        }
        const auto pressed = [&](double stress) {
            return wall.length_at < 0 ? arithmetic().product(stress, wall.length)
                                      : number(stress) * now(wall.length, wall.length_at);
        };
        const auto dof = static_cast<std::size_t>(dofs.dof_of(static_cast<std::size_t>(wall.coordinate)));
        force[dof] = -pressed(by_the_loaded_stress ? wall.rate : wall.stress);
        for (const double rest : wall.rest) {
            force[dof] = by_the_loaded_stress || rest == 0 ? force[dof] : force[dof] - pressed(rest);
        }
        if (subject_.state.packing.dimension > plane) {
            force[dof] = force[dof] * now(wall.other, wall.other_at);
        }
    }
    return force;
}

template <class T> double TrueVertexAt<T>::load_turn(bool by_the_loaded_stress) const {
    double sum = 0;
    for (const WallForce& wall : subject_.state.load.wall_forces(centre_.packing)) {
        if (wall.length_at < 0 || (by_the_loaded_stress && wall.rate == 0)) {
            continue; // dead
        }
        const double stress = by_the_loaded_stress ? wall.rate : wall.stress * (wall.rest[0] == 0 ? 1 : 1 + 2 * u);
        const double weight =
            wall.other_at < 0
                ? wall.other
                // precision.md B1 (last operations)
                : (std::abs(wall.length) + std::abs(wall.other) + 2 * above(vertex_.distance())) * (1 + 8 * u);
        sum = std::hypot(sum, stress * weight);
    }
    return sum;
}

template <class T> auto TrueVertexAt<T>::present() -> const Solution& {
    if (!present_) {
        // True stresses act on the lengths of the true vertex.
        // precision.md B1 (last operations)
        present_ = solve(external_force(false), load_turn(false) * above(vertex_.radius()) * (1 + 8 * u));
        for (std::size_t l = 0; l < subject_.zero.size(); ++l) {
            if (subject_.zero[l] != 0) {
                present_->value[l] = number(0); // known exactly
            }
        }
    }
    return *present_;
}

template <class T> auto TrueVertexAt<T>::unit_load() -> const Solution& {
    if (!unit_) {
        unit_ = solve(external_force(true), load_turn(true) * above(vertex_.radius()));
    }
    return *unit_;
}

template <class T> auto TrueVertexAt<T>::infinitesimal_solution() -> const Solution& {
    if (!infinitesimal_) {
        std::vector<T> force(static_cast<std::size_t>(subject_.dofs.dof_count()), number(0));
        const std::vector<double>& g = subject_.state.load.infinitesimal;
        for (std::size_t k = 0; k < g.size(); ++k) {
            if (subject_.dofs.dof_of(k) >= 0) {
                force[static_cast<std::size_t>(subject_.dofs.dof_of(k))] = number(g[k]);
            }
        }
        infinitesimal_ = solve(force, 0);
    }
    return *infinitesimal_;
}

template <class T> Interval TrueVertexAt<T>::around(const T& value, double bound) const {
    const double middle = A::rounded(value);
    // true_vertex.md V5 (intervals)
    const double half = bound + 4 * u * std::abs(middle); // dropping the low part, and the sum
    const Interval interval{std::nextafter(middle - half, -infinity), std::nextafter(middle + half, infinity)};
    return interval.lower <= interval.upper ? interval : Interval{-infinity, infinity}; // a NaN says nothing
}

template <class T> std::vector<Interval> TrueVertexAt<T>::around(const Solution& solution) const {
    std::vector<Interval> intervals;
    for (const T& value : solution.value) {
        intervals.push_back(around(value, solution.bound));
    }
    return intervals;
}

template <class T> std::vector<Interval> TrueVertexAt<T>::forces() {
    std::vector<Interval> intervals = around(present());
    for (std::size_t l = 0; l < intervals.size(); ++l) {
        if (subject_.zero[l] != 0) {
            intervals[l] = {0, 0};
        }
    }
    return intervals;
}

template <class T> std::vector<Interval> TrueVertexAt<T>::infinitesimal() {
    return around(infinitesimal_solution());
}

template <class T> bool TrueVertexAt<T>::steady(int l) {
    if (sloped_.empty()) {
        std::vector<double> slopes;
        for (const T& slope : unit_load().value) {
            slopes.push_back(A::rounded(slope));
        }
        sloped_ = subject_.pattern.carrying_by_sums(subject_.dofs, subject_.changing_rows, slopes);
    }
    return sloped_[index(l)] == 0;
}

template <class T> std::string TrueVertexAt<T>::open_rate(int l) {
    return fmt::format("the force in contact {} changes with the load at a rate of {:.3g}, proved to {:.3g}", name(l),
                       rate(l, +1), unit_load().bound);
}

template <class T> LoadEndAnswer TrueVertexAt<T>::without_end(int direction) {
    const double bound = unit_load().bound;
    for (int l = 0; l < subject_.size(); ++l) {
        // precision.md B1 (last operations)
        if (limits(l) && !steady(l) && !(rate(l, direction) > bound * (1 + 4 * u))) {
            return {{}, open_rate(l)};
        }
    }
    LoadEndClaim claim;
    claim.unbounded = true;
    return {claim, {}};
}

/// No ties when every force but that of `first` and those of `members` is positive at sigma - t, t known to `error`;
/// else the question names the first one that is not.
template <class T>
LoadEndAnswer TrueVertexAt<T>::vanishes_before(int first, const std::vector<int>& members, const T& t, double error) {
    LoadEndAnswer answer;
    const Solution& force = present();
    const Solution& slope = unit_load();
    const double size = std::abs(A::rounded(t));
    std::vector<unsigned char> skip = subject_.zero; // 0 at every load
    skip[index(first)] = 1;
    for (const int l : members) {
        skip[index(l)] = 1;
    }
    for (int l = 0; l < subject_.size(); ++l) {
        if (skip[index(l)] != 0 || steady(l) || !limits(l)) {
            continue;
        }
        const T product = slope.value[index(l)] * t;
        const double value = A::rounded(force.value[index(l)] - product);
        const double b = std::abs(A::rounded(slope.value[index(l)]));
        const double bound = (force.bound + size * slope.bound + (b + slope.bound) * error +
                              // true_vertex.md V7 (4e)
                              4 * unit() * (std::abs(A::rounded(force.value[index(l)])) + b * size)) *
                                 (1 + 16 * u) + // true_vertex.md V7 (rounding)
                             2 * u * std::abs(value);
        if (!(value > bound) && answer.ties++ == 0) {
            answer.open_question =
                fmt::format("the forces in contacts {} and {} vanish at loads that are not ordered: where the "
                            "first is 0 the second is {:.3g}, proved to {:.3g}",
                            name(first), name(l), value, bound);
        }
    }
    return answer;
}

/// Which of a class is named decides nothing; the infinitesimal loads say which one a run would open.
template <class T> int TrueVertexAt<T>::opens(int first, const std::vector<int>& members, int direction) {
    if (members.empty() || subject_.state.load.infinitesimal.empty()) {
        return first;
    }
    const Solution& g = infinitesimal_solution();
    const auto key = [&](int l) { return A::rounded(g.value[index(l)]) / std::abs(rate(l, direction)); };
    int best = first;
    for (const int l : members) {
        best = limits(l) && rate(l, direction) != 0 && key(l) < key(best) ? l : best;
    }
    return best;
}

template <class T> LoadEndAnswer TrueVertexAt<T>::load_end(int direction) {
    const Solution& force = present();
    const Solution& slope = unit_load();
    const auto vanishing = first_to_vanish(
        force.value.size(), [&](std::size_t l) { return A::rounded(force.value[l]); },
        [&](std::size_t l) {
            const int of = static_cast<int>(l);
            return limits(of) && !steady(of) ? rate(of, direction) : 0.0;
        });
    if (!vanishing) {
        return without_end(direction);
    }
    const int first = static_cast<int>(vanishing->index);
    // 4: precision.md B1 (last operations)
    const double steepness = -rate(first, direction) * (1 - 4 * u) - slope.bound;
    if (!(steepness > 0)) {
        return {{}, open_rate(first)};
    }
    // The load of the end is sigma - t.
    const T t = force.value[index(first)] / slope.value[index(first)];
    const double size = std::abs(A::rounded(t));
    // true_vertex.md V7 (rounding)
    const double error = ((force.bound + size * slope.bound) / steepness + 4 * unit() * size) * (1 + 16 * u);
    const std::vector<int> members = subject_.vanish_with(first);
    if (LoadEndAnswer open = vanishes_before(first, members, t, error); open.ties > 0) {
        return open;
    }
    LoadEndClaim claim;
    const double sigma = subject_.state.load.loaded_stress();
    claim.stress = around(number(sigma) - t, error + 2 * unit() * (std::abs(sigma) + size));
    claim.opens = subject_.state.contacts[index(opens(first, members, direction))];
    return {claim, {}};
}

} // namespace isostat
