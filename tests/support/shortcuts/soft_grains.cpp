#include "support/shortcuts/soft_grains.hpp"

#include "contact/separation.hpp"

#include <isostat/core/error.hpp>
#include <isostat/core/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

constexpr double contact_damping = 0.2; // of critical, for two disks
constexpr double default_drag = 1;      // x sqrt(P / m): the frequency of motions that only the load drives
constexpr double reach_fraction = 0.4;  // of the smallest radius: candidates

void require_positive(const char* field, double value) {
    if (!(value > 0) || !std::isfinite(value)) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("soft grains: {} is {}: expected a positive finite number", field, value));
    }
}

} // namespace

// Units inside: mass of a disk m = K, so that sqrt(m / K) = 1 and accelerations are overlaps.
SoftGrains::SoftGrains(const Packing& packing, const Load& load, const SoftGrainOptions& options)
    : packing_(packing), origin_(packing.q), velocity_(packing.q.size(), 0.0), force_(packing.q.size(), 0.0),
      options_(options) {
    require_floating_point();
    static_assert(plane == 2, "stress x length is a force");
    require_positive("stiffness ratio", options.stiffness_ratio);
    require_positive("step fraction", options.step_fraction);
    for (const double s : load.stress) {
        pressure_ += std::abs(s) / plane;
    }
    require_positive("mean stress", pressure_);
    stiffness_ = options.stiffness_ratio * pressure_;
    if (options_.tolerance == 0) {
        options_.tolerance = std::max(1e-9, 1e-2 / options.stiffness_ratio);
    }
    require_positive("tolerance", options_.tolerance);
    drag_ = options.drag > 0 ? options.drag : default_drag / std::sqrt(options.stiffness_ratio);
    dashpot_ = 2 * contact_damping;
    const std::size_t n = packing.radius.size();
    for (const double r : packing.radius) {
        mean_diameter_ += 2 * r / static_cast<double>(n);
    }
    const DofMap dofs(packing);
    const double wall_mass = std::max(1.0, std::sqrt(static_cast<double>(n)));
    inverse_mass_.assign(packing.q.size(), 0.0);
    for (int mu = 0; mu < dofs.dof_count(); ++mu) {
        const auto c = static_cast<std::size_t>(dofs.coordinate_of(mu));
        inverse_mass_[c] = c < plane * n ? 1.0 : 1 / wall_mass;
    }
    set_load(load);
    find_pairs();
    compute_forces(true);
}

void SoftGrains::set_load(const Load& load) {
    Load dead = load;
    if (load.kind == LoadKind::true_stress) {
        throw Error(ErrorKind::bad_input, "soft grains: true stresses have no potential: expected nominal ones");
    }
    dead.infinitesimal.clear();
    external_ = dead.external_force(packing_);
    compute_forces(true);
}

void SoftGrains::find_pairs() {
    candidates_ = find_candidates(packing_, reach_fraction);
    pairs_.clear();
    walls_.clear();
    const auto wall_at = [&](int axis) { return plane * packing_.disk_count() + axis; };
    std::vector<int> degree(packing_.q.size(), 0); // of disks (at their first coordinate) and walls
    const auto first = [](int disk) { return static_cast<std::size_t>(plane * disk); };
    for (const Contact& c : candidates_.contacts) {
        ++degree[first(c.i)];
        if (c.kind == ContactKind::disk_disk) {
            pairs_.push_back({c.i, c.j, touching_distance(packing_.radius, c)});
            ++degree[first(c.j)];
        } else {
            const bool upper = c.kind == ContactKind::upper_wall;
            walls_.push_back(
                {plane * c.i + c.j, upper ? wall_at(c.j) : -1, packing_.radius[static_cast<std::size_t>(c.i)]});
            degree[static_cast<std::size_t>(wall_at(c.j))] += upper ? 1 : 0;
        }
    }
    const auto stiff = [&](std::size_t c) { return degree[c] * inverse_mass_[c]; };
    double square = 1;
    for (const Pair& p : pairs_) {
        square = std::max(square, stiff(first(p.i)) + stiff(first(p.j)));
    }
    for (const Wall& w : walls_) {
        const double wall = w.wall < 0 ? 0.0 : stiff(static_cast<std::size_t>(w.wall));
        square = std::max(square, stiff(first(w.coordinate / plane)) + wall);
    }
    time_step_ = std::min(options_.step_fraction / std::sqrt(square), 1.4 / (dashpot_ * square));
    moved_ = 0;
}

void SoftGrains::look_around(double displacement) {
    moved_ += displacement;
    if (2 * moved_ >= candidates_.reach) {
        find_pairs();
    }
}

void SoftGrains::compute_forces(bool damped) {
    const double* const q = packing_.q.data();
    const double* const v = velocity_.data();
    double* const f = force_.data();
    const double dashpot = damped ? dashpot_ : 0.0;
    for (std::size_t c = 0; c < force_.size(); ++c) {
        f[c] = external_[c] / stiffness_ - (damped && inverse_mass_[c] > 0 ? drag_ * v[c] / inverse_mass_[c] : 0.0);
    }
    for (const Pair& p : pairs_) {
        const auto i = static_cast<std::size_t>(plane * p.i);
        const auto j = static_cast<std::size_t>(plane * p.j);
        const Contact pair{ContactKind::disk_disk, p.i, p.j};
        const auto [dx, dy, dz] = separation(packing_.layout(), packing_.q, pair);
        const double square = dx * dx + dy * dy;
        if (square >= p.range * p.range || square == 0) {
            continue;
        }
        const double distance = std::sqrt(square);
        const double nx = dx / distance;
        const double ny = dy / distance;
        const auto [ux, uy, uz] = separation(packing_.layout(), velocity_, pair);
        const double push = p.range - distance - dashpot * (ux * nx + uy * ny);
        f[i] -= push * nx;
        f[i + 1] -= push * ny;
        f[j] += push * nx;
        f[j + 1] += push * ny;
    }
    for (const Wall& w : walls_) {
        const auto c = static_cast<std::size_t>(w.coordinate);
        if (w.wall < 0) {
            const double overlap = w.radius - q[c];
            if (overlap > 0) {
                f[c] += overlap - dashpot * v[c];
            }
            continue;
        }
        const auto k = static_cast<std::size_t>(w.wall);
        const double overlap = w.radius - (q[k] - q[c]);
        if (overlap > 0) {
            const double push = overlap + dashpot * (v[c] - v[k]);
            f[c] -= push;
            f[k] += push;
        }
    }
}

void SoftGrains::advance(long count) {
    for (long step = 0; step < count; ++step, ++steps_) {
        const double dt = time_step_;
        double fastest = 0;
        for (std::size_t c = 0; c < force_.size(); ++c) {
            velocity_[c] += 0.5 * dt * inverse_mass_[c] * force_[c];
            packing_.q[c] += dt * velocity_[c];
            fastest = std::max(fastest, std::abs(velocity_[c]));
        }
        look_around(dt * fastest * std::sqrt(static_cast<double>(plane)));
        compute_forces(true);
        for (std::size_t c = 0; c < force_.size(); ++c) {
            velocity_[c] += 0.5 * dt * inverse_mass_[c] * force_[c];
        }
    }
}

double SoftGrains::residual() const {
    SoftGrains still = *this;
    std::fill(still.velocity_.begin(), still.velocity_.end(), 0.0);
    still.compute_forces(false);
    double worst = 0;
    const std::size_t disks = plane * packing_.radius.size();
    for (std::size_t c = 0; c < force_.size(); ++c) {
        if (inverse_mass_[c] > 0) {
            const double unit =
                pressure_ * (c < disks ? mean_diameter_ : packing_.length(1 - static_cast<int>(c - disks)));
            worst = std::max(worst, std::abs(still.force_[c]) * stiffness_ / unit);
        }
    }
    return worst;
}

bool SoftGrains::at_rest() const {
    if (!(residual() < options_.tolerance)) {
        return false;
    }
    // A typical overlap is d / kappa. A motion against drag alone has the velocity (force / mass) / drag: this asks of
    // its force that it be `drag` times smaller than the residual.
    const double limit = options_.tolerance * mean_diameter_ / options_.stiffness_ratio;
    return std::all_of(velocity_.begin(), velocity_.end(), [&](double v) { return std::abs(v) < limit; });
}

bool SoftGrains::relax() {
    constexpr long between = 100;
    for (const long last = steps_ + options_.max_steps; steps_ < last;) {
        advance(between);
        if (at_rest()) {
            return true;
        }
    }
    return false;
}

double SoftGrains::energy() const {
    double sum = 0;
    for (const SoftContact& c : contacts()) {
        sum += c.force * c.force / (2 * stiffness_);
    }
    for (std::size_t c = 0; c < external_.size(); ++c) {
        sum -= external_[c] * (packing_.q[c] - origin_[c]);
        sum += inverse_mass_[c] > 0 ? 0.5 * stiffness_ * velocity_[c] * velocity_[c] / inverse_mass_[c] : 0.0;
    }
    return sum;
}

std::vector<SoftContact> SoftGrains::contacts() const {
    std::vector<SoftContact> list;
    for (const Contact& c : candidates_.contacts) {
        const double overlap = -gap(packing_, c);
        if (overlap > 0) {
            list.push_back({c, stiffness_ * overlap});
        }
    }
    return list;
}

} // namespace isostat
