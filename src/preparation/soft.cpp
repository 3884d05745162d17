#include "preparation/soft.hpp"

#include <isostat/core/work.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isostat::preparation {

namespace {

/// Longest stable step of the central scheme is 2/omega; six contacts of stiffness 1 on a disk of mass 1 give omega^2
/// <= 12 in a dense packing.
constexpr double largest_step = 0.4;
constexpr long report_interval = 500;

} // namespace

template <int Dim>
SoftDynamics<Dim>::SoftDynamics(Packing<Dim>& packing, const std::atomic<bool>* stop,
                                std::function<void(double)> progress)
    : packing_(packing), n_(packing.radius.size()), velocity_(packing.q.size(), 0.0), force_(packing.q.size(), 0.0),
      stop_(stop), progress_(std::move(progress)) {
    double sum = 0;
    for (const double r : packing.radius) {
        sum += 2 * r;
    }
    mean_diameter_ = sum / static_cast<double>(n_);
    wall_mass_ = std::max(1.0, static_cast<double>(n_) / 3);
    skin_ = 0.2 * mean_diameter_;
    refresh_pairs();
}

template <int Dim> void SoftDynamics<Dim>::refresh_pairs() {
    find_pairs<Dim>(packing_.q, packing_.radius, skin_, pairs_);
    allowance_ = skin_;
}

template <int Dim> void SoftDynamics<Dim>::compute_forces(double pressure) {
    const double* const q = packing_.q.data();
    const double* const radius = packing_.radius.data();
    double* const force = force_.data();
    std::fill(force_.begin(), force_.end(), 0.0);
    std::array<double, Dim> length{};
    std::array<double, Dim> virial{};
    for (std::size_t a = 0; a < Dim; ++a) {
        length[a] = q[Dim * n_ + a];
    }
    double overlap = 0;
    double sum = 0;
    int contacts = 0;
    const auto count = [&](double f) {
        overlap = std::max(overlap, f);
        sum += f;
        ++contacts;
    };
    for (std::size_t i = 0; i < n_; ++i) {
        std::array<double, Dim> x{};
        std::array<double, Dim> fi{};
        const double ri = radius[i];
        for (std::size_t a = 0; a < Dim; ++a) {
            x[a] = q[Dim * i + a];
            const double below = ri - x[a];
            if (below > 0) {
                fi[a] += below;
                virial[a] += below * x[a] / length[a];
                count(below);
            }
            const double above = ri - (length[a] - x[a]);
            if (above > 0) {
                fi[a] -= above;
                virial[a] += above * (1 - x[a] / length[a]);
                count(above);
            }
        }
        for (int k = pairs_.start[i]; k < pairs_.start[i + 1]; ++k) {
            const auto j = static_cast<std::size_t>(pairs_.partner[static_cast<std::size_t>(k)]);
            std::array<double, Dim> d{};
            double square = 0;
            for (std::size_t a = 0; a < Dim; ++a) {
                d[a] = q[Dim * j + a] - x[a];
                square += d[a] * d[a];
            }
            const double range = ri + radius[j];
            if (square < range * range && square > 0) {
                const double distance = std::sqrt(square);
                const double f = range - distance;
                const double scale = f / distance;
                for (std::size_t a = 0; a < Dim; ++a) {
                    const double component = scale * d[a];
                    fi[a] -= component;
                    force[Dim * j + a] += component;
                    virial[a] += component * d[a] / length[a];
                }
                count(f);
            }
        }
        for (std::size_t a = 0; a < Dim; ++a) {
            force[Dim * i + a] += fi[a];
        }
    }
    for (std::size_t a = 0; a < Dim; ++a) {
        double area = 1;
        for (std::size_t b = 0; b < Dim; ++b) {
            area *= b == a ? 1.0 : length[b];
        }
        force[Dim * n_ + a] = virial[a] - pressure * area;
    }
    overlap_ = overlap;
    force_sum_ = sum;
    contacts_ = contacts;
}

template <int Dim> void SoftDynamics<Dim>::advance(double dt, bool walls) {
    double* const q = packing_.q.data();
    std::array<double, Dim> stretch{};
    double shrink = 0;
    for (std::size_t a = 0; a < Dim; ++a) {
        stretch[a] = walls ? 1 + dt * velocity_[Dim * n_ + a] / q[Dim * n_ + a] : 1.0;
        q[Dim * n_ + a] *= stretch[a];
        shrink = std::max(shrink, 1 - stretch[a]);
    }
    double fastest = 0;
    for (std::size_t i = 0; i < n_; ++i) {
        double square = 0;
        for (std::size_t a = 0; a < Dim; ++a) {
            const double w = velocity_[Dim * i + a];
            q[Dim * i + a] = q[Dim * i + a] * stretch[a] + dt * w;
            square += w * w;
        }
        fastest = std::max(fastest, square);
    }
    // Two disks that are not listed approach by at most twice the largest peculiar displacement plus the homogeneous
    // shortening.
    allowance_ -= 2 * dt * std::sqrt(fastest) + shrink * (2 * packing_.max_radius() + skin_);
    if (allowance_ < 0) {
        refresh_pairs();
    }
}

template <int Dim> SoftMeasures SoftDynamics<Dim>::measure(double pressure) const {
    SoftMeasures result;
    double square = 0;
    for (std::size_t k = 0; k < Dim * n_; ++k) {
        square = std::max(square, std::abs(force_[k]));
    }
    const double unit = pressure > 0 ? pressure * mean_diameter_ : mean_diameter_;
    result.residual = square / unit;
    for (std::size_t a = 0; a < Dim && pressure > 0; ++a) {
        double area = pressure;
        for (std::size_t b = 0; b < Dim; ++b) {
            area *= b == a ? 1.0 : packing_.q[Dim * n_ + b];
        }
        result.pressure_error = std::max(result.pressure_error, std::abs(force_[Dim * n_ + a]) / area);
    }
    result.overlap = overlap_ / mean_diameter_;
    result.contacts = contacts_;
    return result;
}

template <int Dim> SoftMeasures SoftDynamics<Dim>::separate(double overlap, long max_steps) {
    // Overdamped: velocity = force; at most a tenth of a diameter per step.
    long step = 0;
    const double limit = overlap * mean_diameter_;
    for (; step < max_steps && !stopped(); ++step) {
        compute_forces(0);
        if (overlap_ <= limit) {
            break;
        }
        velocity_ = force_;
        advance(0.3, false);
        if (step % report_interval == 0) {
            progress_(static_cast<double>(step) / static_cast<double>(max_steps));
        }
    }
    std::fill(velocity_.begin(), velocity_.end(), 0.0);
    SoftMeasures result = measure(0);
    result.converged = overlap_ <= limit;
    result.interrupted = stopped();
    result.steps = step;
    count_work(Work::dynamics_steps, step);
    return result;
}

template <int Dim> SoftMeasures SoftDynamics<Dim>::compress(double pressure, double rate, long max_steps) {
    // Walls: viscous drag such that the unopposed pressure drives the strain rate `rate`. Disks: friction against the
    // homogeneous motion, weak over one contact time. With ten times more the walls feel the pressure through drag and
    // stop at a solid fraction of 0.77.
    constexpr double dt = 0.3;
    constexpr double friction = 0.03;
    const double keep = std::exp(-friction * dt);
    long step = 0;
    bool reached = false;
    for (; step < max_steps && !stopped(); ++step) {
        compute_forces(pressure);
        for (std::size_t k = 0; k < Dim * n_; ++k) {
            velocity_[k] = (velocity_[k] + dt * force_[k]) * keep;
        }
        double error = 0;
        for (std::size_t a = 0; a < Dim; ++a) {
            double area = pressure;
            for (std::size_t b = 0; b < Dim; ++b) {
                area *= b == a ? 1.0 : packing_.q[Dim * n_ + b];
            }
            const double length = packing_.q[Dim * n_ + a];
            const double out_of_balance = force_[Dim * n_ + a] / area;
            velocity_[Dim * n_ + a] = rate * length * std::clamp(out_of_balance, -1.0, 1.0);
            error = std::max(error, std::abs(out_of_balance));
        }
        reached = error < 0.1;
        if (reached) {
            break;
        }
        advance(dt, true);
        if (step % report_interval == 0) {
            progress_(std::clamp(1 - error, 0.0, 1.0));
        }
    }
    std::fill(velocity_.begin(), velocity_.end(), 0.0);
    SoftMeasures result = measure(pressure);
    result.converged = reached;
    result.interrupted = stopped();
    result.steps = step;
    count_work(Work::dynamics_steps, step);
    return result;
}

template <int Dim> SoftMeasures SoftDynamics<Dim>::relax(double pressure, double tolerance, long max_steps) {
    // Constants of the original paper; the step is in units of 1/sqrt(stiffness/mass).
    constexpr double alpha_start = 0.1;
    constexpr double alpha_decay = 0.99;
    constexpr double grow = 1.1;
    constexpr double shrink = 0.5;
    constexpr int delay = 5;
    double dt = 0.1;
    double alpha = alpha_start;
    int downhill = 0;
    long step = 0;
    const std::size_t disks = Dim * n_;
    std::fill(velocity_.begin(), velocity_.end(), 0.0);
    SoftMeasures result;
    double first_residual = 0;
    for (;; ++step) {
        compute_forces(pressure);
        if (step % 20 == 0) {
            result = measure(pressure);
            const double worst = std::max(result.residual, result.pressure_error);
            if (worst < tolerance || step >= max_steps || stopped()) {
                result.converged = worst < tolerance;
                break;
            }
            first_residual = std::max(first_residual, worst);
            if (step % report_interval == 0) {
                progress_(
                    std::clamp(std::log(worst / first_residual) / std::log(tolerance / first_residual), 0.0, 1.0));
            }
        }
        for (std::size_t a = 0; a < Dim; ++a) {
            force_[disks + a] /= wall_mass_; // from here on: accelerations
        }
        double power = 0;
        double vv = 0;
        double ff = 0;
        for (std::size_t k = 0; k < disks; ++k) {
            power += force_[k] * velocity_[k];
            vv += velocity_[k] * velocity_[k];
            ff += force_[k] * force_[k];
        }
        for (std::size_t k = disks; k < disks + Dim; ++k) {
            power += wall_mass_ * force_[k] * velocity_[k];
            vv += wall_mass_ * velocity_[k] * velocity_[k];
            ff += wall_mass_ * force_[k] * force_[k];
        }
        if (power > 0) {
            if (++downhill > delay) {
                dt = std::min(dt * grow, largest_step);
                alpha *= alpha_decay;
            }
        } else {
            dt *= shrink;
            dt = std::max(dt, 0.02);
            alpha = alpha_start;
            downhill = 0;
            std::fill(velocity_.begin(), velocity_.end(), 0.0);
            vv = 0;
        }
        const double mix = ff > 0 ? alpha * std::sqrt(vv / ff) : 0.0;
        for (std::size_t k = 0; k < disks + Dim; ++k) {
            velocity_[k] = (1 - alpha) * velocity_[k] + (mix + dt) * force_[k];
        }
        advance(dt, true);
    }
    result.interrupted = stopped();
    result.steps = step;
    count_work(Work::dynamics_steps, step);
    return result;
}

template class SoftDynamics<2>;

} // namespace isostat::preparation
