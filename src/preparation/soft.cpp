#include "preparation/soft.hpp"

#include "core/dot.hpp"
#include "core/parallel.hpp"
#include "core/refuse.hpp"
#include "core/work.hpp"
#include "preparation/scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>
#include <type_traits>
#include <utility>

namespace isostat::preparation {

namespace {

/// The longest stable step of the central scheme is 2/omega. Six contacts of stiffness 1 on a disk of mass 1 give
/// omega^2 <= 12 in a dense packing, twelve on a sphere 24.
constexpr double largest_step = 0.4;
constexpr long report_interval = 500;
/// Disks per block of a sum. Smaller packings are one block, in the order of the disks.
constexpr std::size_t block = 8192;
constexpr std::size_t pair_stretch = 4096;
/// The list reaches farther when it is renewed often, less far when seldom; no result depends on the reach.
constexpr double least_skin = 0.02; // mean diameters
constexpr double most_skin = 0.3;
constexpr long renewed_often = 30; // steps
constexpr long renewed_seldom = 150;
/// Side of a patch in mean diameters: some thousand disks. With 10 the
/// modes of the packing are cut to pieces, and the number of steps doubles.
constexpr double patch_width = 30;
/// Constants of the damped descent, from its paper.
constexpr double alpha_start = 0.1;
constexpr double alpha_decay = 0.99;
constexpr int delay = 5; // steps
/// Ratio of the tolerance of the pressure to that of the residual, with patches.
constexpr double pressure_share = 1e-2;

/// x and y in one register.
using Plane [[gnu::vector_size(16)]] = double;

/// x, y and z, which fit no register.
struct Space {
    PerAxis<double> along;
    [[nodiscard]] double operator[](std::size_t a) const { return along[a]; }
    Space& operator+=(const Space& other) {
        for (std::size_t a = 0; a < most_axes; ++a) {
            along[a] += other.along[a];
        }
        return *this;
    }
    Space& operator-=(const Space& other) {
        for (std::size_t a = 0; a < most_axes; ++a) {
            along[a] -= other.along[a];
        }
        return *this;
    }
};

template <std::size_t Axes> using Vector = std::conditional_t<Axes == 2, Plane, Space>;

template <class V> V load(const double* from) {
    V result;
    std::memcpy(&result, from, sizeof result);
    return result;
}

template <class V> void store(double* to, const V& value) {
    std::memcpy(to, &value, sizeof value);
}

} // namespace

SoftDynamics::SoftDynamics(Packing& packing, bool in_patches, const std::atomic<bool>* stop,
                           std::function<void(double)> progress)
    : packing_(packing), axes_(packing.axes()), n_(packing.radius.size()), velocity_(axes_ * (n_ + 1), 0.0),
      force_(axes_ * (n_ + 1), 0.0), stop_(stop), progress_(std::move(progress)) {
    mean_diameter_ = 2 * mean(packing.radius);
    max_radius_ = packing.max_radius();
    wall_mass_ = std::max(1.0, static_cast<double>(n_) / 3);
    skin_ = 0.1 * mean_diameter_;
    renumber(in_patches);
    refresh_pairs();
}

void SoftDynamics::renumber(bool in_patches) {
    order_.resize(n_);
    std::iota(order_.begin(), order_.end(), 0);
    if (in_patches) {
        const double width = patch_width * mean_diameter_;
        std::vector<PerAxis<double>> square(n_);
        for (std::size_t i = 0; i < n_; ++i) {
            for (std::size_t a = 0; a < axes_; ++a) {
                square[i][axes_ - 1 - a] = std::floor(packing_.q[axes_ * i + a] / width);
            }
        }
        std::ranges::stable_sort(order_, [&](int i, int j) {
            return square[static_cast<std::size_t>(i)] < square[static_cast<std::size_t>(j)];
        });
        for (std::size_t k = 0; k < n_; ++k) {
            if (k == 0 ||
                square[static_cast<std::size_t>(order_[k])] != square[static_cast<std::size_t>(order_[k - 1])]) {
                patches_.push_back({axes_ * k, axes_ * k});
            }
            patches_.back().last += axes_;
        }
        patches_.push_back({axes_ * n_, axes_ * (n_ + 1)});
    }
    q_.resize(axes_ * (n_ + 1));
    radius_.resize(n_);
    for (std::size_t k = 0; k < n_; ++k) {
        const auto i = static_cast<std::size_t>(order_[k]);
        radius_[k] = packing_.radius[i];
        for (std::size_t a = 0; a < axes_; ++a) {
            q_[axes_ * k + a] = packing_.q[axes_ * i + a];
        }
    }
    for (std::size_t a = 0; a < axes_; ++a) {
        q_[axes_ * n_ + a] = packing_.q[axes_ * n_ + a];
    }
}

/// Moves every disk into the cell, and lists the images that a disk in the cell may touch before the next search.
void SoftDynamics::place_images() {
    const double margin = 2 * max_radius_ + skin_;
    images_.clear();
    q_.resize(axes_ * (n_ + 1));
    const double* const length = q_.data() + axes_ * n_;
    // A pair may touch through several images; the centres of a sphere and its own image are a diameter apart.
    if (!(*std::min_element(length, length + axes_) >= (axes_ == 2 ? 2 : 1) * margin)) {
        refuse("preparation", "a periodic cell became narrower than {}: expected more",
               axes_ == 2 ? "four disks" : "its largest spheres");
    }
    int neighbours = 1; // 3 of each axis, with the cell itself
    for (std::size_t a = 0; a < axes_; ++a) {
        neighbours *= 3;
    }
    for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t a = 0; a < axes_; ++a) {
            q_[axes_ * i + a] -= length[a] * std::floor(q_[axes_ * i + a] / length[a]);
        }
        for (int cell = 0; cell < neighbours; ++cell) {
            GhostImage image{i, {}};
            bool near = 2 * cell != neighbours - 1; // the middle one is the cell itself
            for (std::size_t a = axes_, rest = static_cast<std::size_t>(cell); a-- > 0; rest /= 3) {
                image.periods[a] = static_cast<int>(rest % 3) - 1;
                const double x = q_[axes_ * i + a] + image.periods[a] * length[a];
                near = near && x > -margin && x < length[a] + margin;
            }
            if (near) {
                images_.push_back(image);
            }
        }
    }
    q_.resize(axes_ * (n_ + 1 + images_.size()));
    follow_images();
}

void SoftDynamics::follow_images() {
    double* image = q_.data() + axes_ * (n_ + 1);
    for (const GhostImage& g : images_) {
        for (std::size_t a = 0; a < axes_; ++a) {
            *image++ = q_[axes_ * g.disk + a] + g.periods[a] * q_[axes_ * n_ + a];
        }
    }
}

/// Lists each pair once: of two images the image of the disk with the lower number.
void SoftDynamics::find_pairs_in_cell() {
    place_images();
    std::vector<double> x(q_.begin(), q_.begin() + static_cast<std::ptrdiff_t>(axes_ * n_));
    x.insert(x.end(), q_.begin() + static_cast<std::ptrdiff_t>(axes_ * (n_ + 1)), q_.end());
    std::vector<double> radius = radius_;
    for (const GhostImage& g : images_) {
        radius.push_back(radius_[g.disk]);
    }
    PairList all;
    find_pairs(packing_.dimension, x, radius, skin_, all);
    pairs_.start.assign(1, 0);
    pairs_.partner.clear();
    pair_second_.clear();
    for (std::size_t i = 0; i < n_; ++i) {
        for (auto k = static_cast<std::size_t>(all.start[i]); k < static_cast<std::size_t>(all.start[i + 1]); ++k) {
            const auto j = static_cast<std::size_t>(all.partner[k]);
            const std::size_t disk = j < n_ ? j : images_[j - n_].disk;
            if (disk > i) {
                pairs_.partner.push_back(static_cast<int>(disk));
                pair_second_.push_back(static_cast<int>(j < n_ ? j : j + 1));
            }
        }
        pairs_.start.push_back(static_cast<int>(pairs_.partner.size()));
    }
}

void SoftDynamics::publish_lengths() {
    for (std::size_t a = 0; a < axes_; ++a) {
        packing_.q[axes_ * n_ + a] = q_[axes_ * n_ + a];
    }
}

SoftMeasures SoftDynamics::finish(SoftMeasures result, long steps, bool converged) {
    std::ranges::fill(velocity_, 0.0);
    result.steps = steps;
    result.converged = converged;
    publish_lengths();
    for (std::size_t k = 0; k < n_; ++k) {
        const auto i = static_cast<std::size_t>(order_[k]);
        for (std::size_t a = 0; a < axes_; ++a) {
            packing_.q[axes_ * i + a] = q_[axes_ * k + a];
        }
    }
    result.interrupted = stopped();
    count_work(Work::dynamics_steps, result.steps);
    return result;
}

void SoftDynamics::refresh_pairs() {
    const bool repeats = packing_.cell.any();
    if (repeats) {
        find_pairs_in_cell();
    } else {
        find_pairs(packing_.dimension, q_, radius_, skin_, pairs_);
    }
    allowance_ = skin_;
    age_ = 0;
    const std::size_t count = pairs_.partner.size();
    pair_first_.resize(count);
    pair_range_.resize(count);
    overlap_of_.resize(count);
    push_.resize(axes_ * count);
    virial_.resize(axes_ * count);
    pair_target_.resize(count);
    pairs_across_.clear();
    const Pieces blocks{n_, block};
    from_above_.resize(axes_ * n_);
    from_below_.resize(axes_ * (n_ + blocks.count()));
    for (std::size_t i = 0; i < n_; ++i) {
        const std::size_t piece = i / block;
        for (auto k = static_cast<std::size_t>(pairs_.start[i]); k < static_cast<std::size_t>(pairs_.start[i + 1]);
             ++k) {
            const auto j = static_cast<std::size_t>(pairs_.partner[k]);
            pair_first_[k] = static_cast<int>(i);
            pair_range_[k] = radius_[i] + radius_[j];
            const bool inside = j < blocks.last(piece);
            pair_target_[k] = static_cast<int>(inside ? j : n_ + piece);
            if (!inside) {
                pairs_across_.push_back(static_cast<int>(k));
            }
        }
    }
    wall_disks_.clear();
    for (std::size_t i = 0; i < n_ && !repeats; ++i) {
        bool near = false;
        for (std::size_t a = 0; a < axes_; ++a) {
            const double x = q_[axes_ * i + a];
            near = near || x - radius_[i] < skin_ || q_[axes_ * n_ + a] - x - radius_[i] < skin_;
        }
        if (near) {
            wall_disks_.push_back({.disk = i});
        }
    }
}

void SoftDynamics::wall_forces() {
    for (WallDisk& w : wall_disks_) {
        for (std::size_t a = 0; a < axes_; ++a) {
            const double x = q_[axes_ * w.disk + a];
            const double length = q_[axes_ * n_ + a];
            const double below = std::max(0.0, radius_[w.disk] - x);
            const double above = std::max(0.0, radius_[w.disk] - (length - x));
            w.overlap[2 * a] = below;
            w.overlap[2 * a + 1] = above;
            w.force[a] = below - above;
            w.lower_virial[a] = below * x / length;
            w.upper_virial[a] = above * (1 - x / length);
        }
    }
}

template <std::size_t Axes>
PerAxis<double> SoftDynamics::spread(std::size_t first, std::size_t last, std::size_t piece) {
    // One pass over the pairs without a branch: loops over the few partners of each disk mispredict at every end.
    const double* const push = push_.data();
    const double* const share = virial_.data();
    const int* const target = pair_target_.data();
    const int* const source = pair_first_.data();
    double* const from_below = from_below_.data();
    double* const from_above = from_above_.data();
    std::fill(from_below + Axes * first, from_below + Axes * last, 0.0);
    std::fill(from_above + Axes * first, from_above + Axes * last, 0.0);
    using V = Vector<Axes>;
    store(from_below + Axes * (n_ + piece), V{});
    auto wall = std::ranges::lower_bound(wall_disks_, first, {}, &WallDisk::disk);
    V virial{};
    auto k = static_cast<std::size_t>(pairs_.start[first]);
    const auto pairs_until = [&](std::size_t end) {
        for (; k < end; ++k) {
            const V p = load<V>(push + Axes * k);
            double* const own = from_above + Axes * static_cast<std::size_t>(source[k]);
            double* const other = from_below + Axes * static_cast<std::size_t>(target[k]);
            V above = load<V>(own);
            above -= p;
            store(own, above);
            V below = load<V>(other);
            below += p;
            store(other, below);
            virial += load<V>(share + Axes * k);
        }
    };
    for (; wall != wall_disks_.end() && wall->disk < last; ++wall) {
        pairs_until(static_cast<std::size_t>(pairs_.start[wall->disk]));
        store(from_above + Axes * wall->disk, load<V>(wall->force.data()));
        virial += load<V>(wall->lower_virial.data());
        virial += load<V>(wall->upper_virial.data());
    }
    pairs_until(static_cast<std::size_t>(pairs_.start[last]));
    PerAxis<double> result{};
    store(result.data(), virial);
    return result;
}

SoftDynamics::Sums SoftDynamics::add_up(std::size_t first, std::size_t last) {
    Sums sums;
    for (std::size_t k = axes_ * first; k < axes_ * last; ++k) {
        const double f = from_below_[k] + from_above_[k];
        const double w = velocity_[k];
        force_[k] = f;
        sums.power += f * w;
        sums.vv += w * w;
        sums.ff += f * f;
    }
    return sums;
}

void SoftDynamics::compute_forces(double pressure) {
    const Pieces stretches{pairs_.partner.size(), pair_stretch};
    parallel_pieces(stretches.count(), [&](std::size_t piece) {
        const std::size_t from = stretches.first(piece);
        const std::vector<int>& second = packing_.cell.any() ? pair_second_ : pairs_.partner;
        const PairStretch stretch{stretches.last(piece) - from, pair_first_.data() + from, second.data() + from,
                                  pair_range_.data() + from};
        pair_forces(packing_.dimension, stretch, q_.data(), q_.data() + axes_ * n_, overlap_of_.data() + from,
                    push_.data() + axes_ * from, virial_.data() + axes_ * from);
    });
    wall_forces();
    const Pieces blocks{n_, block};
    std::vector<PerAxis<double>> virials(blocks.count());
    parallel_pieces(blocks.count(), [&](std::size_t piece) {
        const std::size_t first = blocks.first(piece);
        const std::size_t last = blocks.last(piece);
        virials[piece] = axes_ == 2 ? spread<2>(first, last, piece) : spread<3>(first, last, piece);
    });
    for (const int k : pairs_across_) {
        const auto p = static_cast<std::size_t>(k);
        double* const other = from_below_.data() + axes_ * static_cast<std::size_t>(pairs_.partner[p]);
        for (std::size_t a = 0; a < axes_; ++a) {
            other[a] += push_[axes_ * p + a];
        }
    }
    std::vector<Sums> sums(blocks.count());
    parallel_pieces(blocks.count(),
                    [&](std::size_t piece) { sums[piece] = add_up(blocks.first(piece), blocks.last(piece)); });
    sums_ = sums.front();
    PerAxis<double> virial = virials.front();
    for (std::size_t b = 1; b < sums.size(); ++b) {
        for (std::size_t a = 0; a < axes_; ++a) {
            virial[a] += virials[b][a];
        }
        sums_.power += sums[b].power;
        sums_.vv += sums[b].vv;
        sums_.ff += sums[b].ff;
    }
    for (std::size_t a = 0; a < axes_; ++a) {
        double area = 1;
        for (std::size_t b = 0; b < axes_; ++b) {
            area *= b == a ? 1.0 : q_[axes_ * n_ + b];
        }
        force_[axes_ * n_ + a] = virial[a] - pressure * area;
    }
    if (packing_.cell.keeps_shape) { // the component that keeps the ratio of the periods
        const double* const length = q_.data() + axes_ * n_;
        double* const on_cell = force_.data() + axes_ * n_;
        const double share = std::inner_product(on_cell, on_cell + axes_, length, 0.0) /
                             std::inner_product(length, length + axes_, length, 0.0);
        for (std::size_t a = 0; a < axes_; ++a) {
            on_cell[a] = share * length[a];
        }
    }
}

double SoftDynamics::out_of_balance(std::size_t axis, double pressure) const {
    const double* const length = q_.data() + axes_ * n_;
    const double* const force = force_.data() + axes_ * n_;
    const bool size_only = packing_.cell.keeps_shape;
    double face = size_only ? static_cast<double>(axes_) * pressure : pressure;
    for (std::size_t b = 0; b < axes_; ++b) {
        face *= b == axis && !size_only ? 1.0 : length[b];
    }
    return (size_only ? std::inner_product(force, force + axes_, length, 0.0) : force[axis]) / face;
}

void SoftDynamics::count_contacts() {
    overlap_ = 0;
    contacts_ = 0;
    const auto count = [&](double f) {
        overlap_ = overlap_ < f ? f : overlap_;
        contacts_ += f > 0 ? 1 : 0;
    };
    for (const double f : overlap_of_) {
        count(f);
    }
    for (const WallDisk& w : wall_disks_) {
        for (const double f : w.overlap) {
            count(f);
        }
    }
}

template <std::size_t Axes>
double SoftDynamics::move(std::size_t first, std::size_t last, double dt, PerAxis<double> stretch) {
    double* const q = q_.data();
    const double* const velocity = velocity_.data();
    double fastest = 0;
    for (std::size_t i = first; i < last; ++i) {
        double square = 0;
        for (std::size_t a = 0; a < Axes; ++a) {
            const double w = velocity[Axes * i + a];
            q[Axes * i + a] = q[Axes * i + a] * stretch[a] + dt * w;
            square += w * w;
        }
        fastest = fastest < square ? square : fastest;
    }
    return fastest;
}

void SoftDynamics::advance(double dt, bool walls) {
    PerAxis<double> stretch{};
    double shrink = 0;
    for (std::size_t a = 0; a < axes_; ++a) {
        stretch[a] = walls ? 1 + dt * velocity_[axes_ * n_ + a] / q_[axes_ * n_ + a] : 1.0;
        q_[axes_ * n_ + a] *= stretch[a];
        shrink = std::max(shrink, 1 - stretch[a]);
    }
    const Pieces blocks{n_, block};
    std::vector<double> fastest(blocks.count(), 0.0);
    parallel_pieces(blocks.count(), [&](std::size_t piece) {
        const std::size_t first = blocks.first(piece);
        const std::size_t last = blocks.last(piece);
        fastest[piece] = axes_ == 2 ? move<2>(first, last, dt, stretch) : move<3>(first, last, dt, stretch);
    });
    follow_images();
    // Two disks that are not listed approach by at most twice the largest peculiar displacement plus the homogeneous
    // shortening; the same holds for a disk and a wall.
    allowance_ -= 2 * dt * std::sqrt(*std::ranges::max_element(fastest)) + shrink * (2 * max_radius_ + skin_);
    ++age_;
    if (allowance_ < 0) {
        if (age_ < renewed_often) {
            skin_ = std::min(1.5 * skin_, most_skin * mean_diameter_);
        } else if (age_ > renewed_seldom) {
            skin_ = std::max(0.6 * skin_, least_skin * mean_diameter_);
        }
        refresh_pairs();
    }
}

SoftMeasures SoftDynamics::measure(double pressure) {
    count_contacts();
    SoftMeasures result;
    const double unit = pressure > 0 ? pressure * mean_diameter_ : mean_diameter_;
    result.residual = largest(std::span(force_).first(axes_ * n_)) / unit;
    for (std::size_t a = 0; a < axes_ && pressure > 0; ++a) {
        result.pressure_error = std::max(result.pressure_error, std::abs(out_of_balance(a, pressure)));
    }
    result.overlap = overlap_ / mean_diameter_;
    result.contacts = contacts_;
    return result;
}

SoftMeasures SoftDynamics::separate(double overlap, long max_steps) {
    // Overdamped motion: velocity = force; a step moves a disk by at most a tenth of a diameter.
    long step = 0;
    const double limit = overlap * mean_diameter_;
    for (; step < max_steps && !stopped(); ++step) {
        compute_forces(0);
        count_contacts();
        if (overlap_ <= limit) {
            break;
        }
        velocity_ = force_;
        advance(0.3, false);
        if (step % report_interval == 0) {
            progress_(static_cast<double>(step) / static_cast<double>(max_steps));
        }
    }
    return finish(measure(0), step, overlap_ <= limit);
}

SoftMeasures SoftDynamics::compress(double pressure, double rate, long max_steps) {
    // Walls have viscous drag such that the unopposed pressure drives the strain rate `rate`. Disks have friction
    // against the homogeneous motion, weak over one contact time: with ten times more the walls feel the pressure
    // through drag and stop at a solid fraction of 0.77.
    constexpr double dt = 0.3;
    constexpr double friction = 0.03;
    const double keep = std::exp(-friction * dt);
    long step = 0;
    bool reached = false;
    for (; step < max_steps && !stopped(); ++step) {
        compute_forces(pressure);
        for (std::size_t k = 0; k < axes_ * n_; ++k) {
            velocity_[k] = (velocity_[k] + dt * force_[k]) * keep;
        }
        double error = 0;
        for (std::size_t a = 0; a < axes_; ++a) {
            const double length = q_[axes_ * n_ + a];
            const double excess = out_of_balance(a, pressure);
            velocity_[axes_ * n_ + a] = rate * length * std::clamp(excess, -1.0, 1.0);
            error = std::max(error, std::abs(excess));
        }
        reached = error < 0.1;
        if (reached) {
            break;
        }
        advance(dt, true);
        if (step % report_interval == 0) {
            publish_lengths();
            progress_(std::clamp(1 - error, 0.0, 1.0));
        }
    }
    return finish(measure(pressure), step, reached);
}

SoftDynamics::Sums SoftDynamics::sums_of(const Patch& patch) const {
    Sums sums;
    for (std::size_t k = patch.first; k < patch.last; ++k) {
        sums.power += force_[k] * velocity_[k];
        sums.vv += velocity_[k] * velocity_[k];
        sums.ff += force_[k] * force_[k];
    }
    return sums;
}

/// Turns the velocities towards the forces; where the power of the forces is not positive, the velocities restart at 0.
void SoftDynamics::turn(Patch& patch, Sums sums, double dt) {
    if (sums.power > 0) {
        if (++patch.downhill > delay) {
            patch.alpha *= alpha_decay;
        }
    } else {
        patch.alpha = alpha_start;
        patch.downhill = 0;
        std::fill(velocity_.begin() + static_cast<std::ptrdiff_t>(patch.first),
                  velocity_.begin() + static_cast<std::ptrdiff_t>(patch.last), 0.0);
        sums.vv = 0;
    }
    const double mix = sums.ff > 0 ? patch.alpha * std::sqrt(sums.vv / sums.ff) : 0.0;
    for (std::size_t k = patch.first; k < patch.last; ++k) {
        velocity_[k] = (1 - patch.alpha) * velocity_[k] + (mix + dt) * force_[k];
    }
}

SoftMeasures SoftDynamics::relax(double pressure, double tolerance, long max_steps) {
    constexpr double grow = 1.1;
    constexpr double shrink = 0.5;
    double dt = 0.1; // in units of sqrt(mass / stiffness)
    long step = 0;
    const std::size_t disks = axes_ * n_;
    std::ranges::fill(velocity_, 0.0);
    Patch whole{0, disks + axes_, alpha_start, 0};
    for (Patch& patch : patches_) {
        patch.alpha = alpha_start;
        patch.downhill = 0;
    }
    SoftMeasures result;
    bool converged = false;
    double first_residual = 0;
    for (;; ++step) {
        compute_forces(pressure);
        if (step % 20 == 0) {
            result = measure(pressure);
            const double worst =
                std::max(result.residual, (patches_.empty() ? 1.0 : pressure_share) * result.pressure_error);
            if (worst < tolerance || step >= max_steps || stopped()) {
                converged = worst < tolerance;
                break;
            }
            first_residual = std::max(first_residual, worst);
            if (step % report_interval == 0) {
                publish_lengths();
                progress_(
                    std::clamp(std::log(worst / first_residual) / std::log(tolerance / first_residual), 0.0, 1.0));
            }
        }
        for (std::size_t a = 0; a < axes_; ++a) {
            force_[disks + a] /= wall_mass_; // accelerations from here on
        }
        if (patches_.empty()) {
            Sums sums = sums_;
            for (std::size_t k = disks; k < disks + axes_; ++k) {
                sums.power += wall_mass_ * force_[k] * velocity_[k];
                sums.vv += wall_mass_ * velocity_[k] * velocity_[k];
                sums.ff += wall_mass_ * force_[k] * force_[k];
            }
            // The velocities are advanced with the new step.
            if (sums.power > 0) {
                dt = whole.downhill + 1 > delay ? std::min(dt * grow, largest_step) : dt;
            } else {
                dt = std::max(dt * shrink, 0.02);
            }
            turn(whole, sums, dt);
        } else {
            // All patches share one step, which is the largest stable step in the end.
            dt = std::min(dt * grow, largest_step);
            parallel_pieces(patches_.size(), [&](std::size_t p) { turn(patches_[p], sums_of(patches_[p]), dt); });
        }
        advance(dt, true);
    }
    return finish(result, step, converged);
}

} // namespace isostat::preparation
