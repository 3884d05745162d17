#include "preparation/soft_newton.hpp"

#include "contact/near_pairs.hpp"
#include "core/dot.hpp"
#include "core/parallel.hpp"
#include "preparation/scale.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace isostat::preparation {

namespace {

/// Pairs are listed up to this gap, in the internal unit. The list is renewed when something has moved by a third of
/// the gap, in space a quarter: two grains approach by less than 2 sqrt(d) times that.
constexpr double reach = 0.1;
/// Longest step of a disk, in mean diameters, because the normals change too much beyond it.
constexpr double longest_step = 0.1;
/// The search ends where the slope is below this share of the first one.
constexpr double flat = 0.3;
constexpr int most_trials = 12;
/// Damping in units of the stiffness: its first value, the factor of its changes, the shares of a full step below and
/// above which it changes, and its range.
constexpr double first_damping = 1e-4;
constexpr double damping_factor = 3;
constexpr double short_step = 0.2;
constexpr double long_step = 0.5;
constexpr double least_damping = 1e-14;
constexpr double most_damping = 1;
/// Damping of a wall, per disk, because a wall moves the disks that it drags.
constexpr double wall_damping = 0.3;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double force_on_wall(const Packing& packing, int axis, double pressure) {
    double face = pressure;
    for (int b = 0; b < packing.dimension; ++b) {
        face *= b == axis ? 1.0 : packing.length(b);
    }
    return face;
}

} // namespace

SoftNewton::SoftNewton(Packing& packing, const std::atomic<bool>* stop)
    : packing_(packing), damping_(first_damping), stop_(stop) {
    mean_diameter_ = 2 * mean(packing.radius);
}

void SoftNewton::collect() {
    pairs_ = near_contacts(packing_, reach, reach);
    start_.assign(1, 0);
    column_.clear();
    for (const Contact& pair : pairs_) {
        const GapGradient g = gap_gradient(packing_, pair);
        column_.insert(column_.end(), g.coordinate.begin(), g.coordinate.begin() + g.count);
        start_.push_back(static_cast<int>(column_.size()));
    }
    value_.resize(column_.size());
    gap_.resize(pairs_.size());
    anchor_ = packing_.q;
    matrix_.emplace(packing_.q.size(), start_, column_);
}

bool SoftNewton::left_the_list() const {
    const double holds = reach / (packing_.dimension + 1);
    return !std::ranges::equal(packing_.q, anchor_,
                               [=](double now, double then) { return !(std::abs(now - then) > holds); });
}

void SoftNewton::evaluate() {
    const Pieces pieces{pairs_.size(), 8192};
    parallel_pieces(pieces.count(), [&](std::size_t piece) {
        for (std::size_t l = pieces.first(piece); l < pieces.last(piece); ++l) {
            const GapGradient g = gap_gradient(packing_, pairs_[l]);
            std::copy_n(g.value.begin(), g.count, value_.begin() + start_[l]);
            gap_[l] = gap(packing_, pairs_[l]);
        }
    });
}

void SoftNewton::gradient(double pressure, std::vector<double>& slope) const {
    slope.assign(packing_.q.size(), 0.0);
    for (std::size_t l = 0; l < gap_.size(); ++l) {
        if (gap_[l] < 0) {
            for (auto e = static_cast<std::size_t>(start_[l]); e < static_cast<std::size_t>(start_[l + 1]); ++e) {
                slope[static_cast<std::size_t>(column_[e])] += gap_[l] * value_[e];
            }
        }
    }
    for (int a = 0; a < packing_.dimension; ++a) {
        slope[packing_.length_at(static_cast<std::size_t>(a))] += force_on_wall(packing_, a, pressure);
    }
}

SoftMeasures SoftNewton::measure(double pressure, const std::vector<double>& slope) const {
    SoftMeasures now;
    now.residual = largest(std::span(slope).first(packing_.length_at(0))) / (pressure * mean_diameter_);
    for (int a = 0; a < packing_.dimension; ++a) {
        now.pressure_error =
            std::max(now.pressure_error, std::abs(slope[packing_.length_at(static_cast<std::size_t>(a))]) /
                                             force_on_wall(packing_, a, pressure));
    }
    for (const double h : gap_) {
        now.overlap = std::max(now.overlap, -h / mean_diameter_);
        now.contacts += h < 0 ? 1 : 0;
    }
    return now;
}

bool SoftNewton::direction(const std::vector<double>& slope, std::vector<double>& step) {
    const std::size_t disks = packing_.radius.size();
    std::vector<double> diagonal(slope.size(), damping_);
    for (std::size_t k = packing_.axes() * disks; k < diagonal.size(); ++k) {
        diagonal[k] = damping_ * wall_damping * static_cast<double>(disks);
    }
    const auto block = [&](std::size_t l, std::size_t p, std::size_t r) {
        return gap_[l] < 0 ? value_[p] * value_[r] : 0.0;
    };
    if (!matrix_->factorise(block, diagonal)) {
        return false;
    }
    step.resize(slope.size());
    std::ranges::transform(slope, step.begin(), [](double s) { return -s; });
    matrix_->solve(step);
    return true;
}

/// Moves the packing; returns the taken share of the step.
double SoftNewton::search(double pressure, const std::vector<double>& slope, const std::vector<double>& step) {
    const double first = dot(slope, step); // negative
    double share = std::min(1.0, longest_step * mean_diameter_ / largest(std::span(step).first(packing_.length_at(0))));
    double low = 0;
    double low_slope = first;
    double high = 0; // not yet known
    double high_slope = 0;
    const std::vector<double> from = packing_.q;
    std::vector<double> there;
    for (int trial = 0;; ++trial) {
        for (std::size_t k = 0; k < from.size(); ++k) {
            packing_.q[k] = from[k] + share * step[k];
        }
        evaluate();
        gradient(pressure, there);
        const double now = dot(there, step);
        if (std::abs(now) <= flat * std::abs(first) || trial + 1 == most_trials) {
            return share;
        }
        if (now < 0) {
            low = share;
            low_slope = now;
            if (high == 0) {
                return share; // the energy still falls at the end of the step
            }
        } else {
            high = share;
            high_slope = now;
        }
        // The zero of the straight line through the slopes at both ends, kept away from the ends.
        const double zero = low + (high - low) * -low_slope / (high_slope - low_slope);
        share = std::clamp(zero, low + 0.1 * (high - low), low + 0.9 * (high - low));
    }
}

SoftMeasures SoftNewton::relax(double pressure, double tolerance, long max_steps,
                               const std::function<void(double)>& progress) {
    std::vector<double> slope;
    std::vector<double> step;
    SoftMeasures now;
    double first = 0;
    for (long k = 0;; ++k) {
        if (left_the_list()) {
            collect();
        }
        evaluate();
        gradient(pressure, slope);
        now = measure(pressure, slope);
        now.steps = k;
        const double worst = std::max(now.residual, now.pressure_error);
        now.converged = worst < tolerance;
        now.interrupted = stopped();
        if (now.converged || now.interrupted || k >= max_steps) {
            return now;
        }
        first = std::max(first, worst);
        progress(std::clamp(std::log(worst / first) / std::log(tolerance / first), 0.0, 1.0));
        while (!direction(slope, step)) {
            if (damping_ >= most_damping) {
                return now;
            }
            damping_ *= damping_factor;
        }
        const double share = search(pressure, slope, step);
        if (share > long_step) {
            damping_ = std::max(damping_ / damping_factor, least_damping);
        } else if (share < short_step) {
            damping_ = std::min(damping_ * damping_factor, most_damping);
        }
    }
}

} // namespace isostat::preparation
