#include "contact/words.hpp"
#include "core/refuse.hpp"
#include "preparation/random.hpp"
#include "preparation/scale.hpp"
#include "preparation/soft.hpp"
#include "preparation/soft_newton.hpp"
#include "preparation/stage.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace isostat {

namespace preparation {

namespace {

/// Pressure / stiffness of the compression and of the first relaxation; later relaxations divide it by ten. Large
/// packings are pressed harder first, since they settle in fewer steps then and less rearranges as the pressure falls
/// (n = 10 000, one sample: 14 000 steps at 1e-3 instead of 38 000; solid fraction at the end 0.841 instead of 0.839).
constexpr double first_pressure = 1e-3;
constexpr double first_pressure_large = 1e-2;
constexpr double pressure_divisor = 10;
/// The last relaxation of large packings ends at this many times `relaxation`, by trial: compared with 3, a factor of
/// 10 doubles the number of linear programmes that follow, and a factor of 1 doubles the steps. In a large packing some
/// small part moves at any time, and the residual is the largest of all parts. Therefore the earlier relaxations end at
/// `relaxation_between` times, or after `steps_between`, and the last one after `steps_large`.
constexpr double relaxation_large = 3;
constexpr double relaxation_between = 10;
constexpr long steps_between = 15000;
constexpr long steps_large = 60000;
/// In very large packings the dynamics leave large residuals, and Newton steps follow at `softness` divided by these.
/// In one sample of 100 000 disks without them the products of the descent stay near 1e-3 for 500 steps and more.
constexpr std::array<double, 4> newton_divisors{1, 5, 25, 100};
constexpr double newton_tolerance = 3e-3;
/// Steps at each pressure; in 100 000 disks they do not converge then. With 2500, in one sample, the descent takes 436
/// steps instead of 552, and the whole preparation three times the CPU time.
constexpr long most_newton_steps = 500;
/// Strain rate of the compression per sqrt(mass / stiffness), slow
/// compared with the time that forces need to spread over a diameter.
constexpr double compression_rate = 1e-4;
/// Least period of the loose cell, in largest radii: the dense cell keeps more than four diameters, in space two.
constexpr double narrowest_cell = 12;
constexpr double narrowest_cell_in_space = 5;
/// Overlap left by the random start, in diameters.
constexpr double start_overlap = 1e-2;

void require_positive(const char* field, double value) {
    if (!(value > 0) || !std::isfinite(value)) {
        refuse("preparation", "{} is {}: expected a positive finite number", field, value);
    }
}

/// Lengths of the loose box, equal but for the last, which is `aspect` times as long; none is below `narrowest`.
PerAxis<double> loose_lengths(const std::vector<double>& radius, const PreparationOptions& options, double narrowest) {
    const bool in_plane = options.dimension == plane;
    double grains = 0;
    for (const double r : radius) {
        grains += in_plane ? std::numbers::pi * r * r : 4 * std::numbers::pi / 3 * r * r * r;
    }
    const double size = grains / (options.start_fraction() * options.aspect);
    const double side = std::max(narrowest, in_plane ? std::sqrt(size) : std::cbrt(size));
    PerAxis<double> length{};
    std::fill_n(length.begin(), options.dimension - 1, side);
    length[static_cast<std::size_t>(options.dimension) - 1] = std::max(narrowest, side * options.aspect);
    return length;
}

/// Random positions in a box of the wanted solid fraction and aspect, never narrower than the largest disk.
Packing scatter(std::vector<double> radius, // NOLINT(performance-unnecessary-value-param): it is moved
                const PreparationOptions& options, std::uint64_t seed) {
    const bool periodic = options.cell != PreparedCell::none;
    Packing packing;
    packing.dimension = options.dimension;
    packing.cell.dimension = options.dimension;
    packing.walls = Walls::box(options.dimension);
    packing.radius = std::move(radius);
    const double cell = options.dimension == plane ? narrowest_cell : narrowest_cell_in_space;
    const PerAxis<double> length =
        loose_lengths(packing.radius, options, (periodic ? cell : 2.2) * packing.max_radius());
    Uniform uniform(seed);
    for (const double r : packing.radius) {
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            packing.q.push_back(periodic ? uniform() * length[a] : r + uniform() * (length[a] - 2 * r));
        }
    }
    packing.q.insert(packing.q.end(), length.begin(), length.begin() + options.dimension);
    if (periodic) {
        packing.walls = Walls::none();
        packing.cell.repeat();
        packing.cell.move(true, options.cell == PreparedCell::tilted);
        if (options.cell == PreparedCell::isotropic) {
            packing.cell.keep_shape();
        }
        packing.q.resize(packing.coordinate_count(), 0.0);
    }
    return packing;
}

void check(const PreparationOptions& options) {
    require_positive("stress", options.stress);
    require_positive("aspect", options.aspect);
    require_positive("loose fraction", options.start_fraction());
    if (options.dimension < plane || options.dimension > static_cast<int>(most_axes)) {
        refuse("preparation", "dimension is {}: expected 2 or 3", options.dimension);
    }
    require_positive("softness", options.softness);
    require_positive("relaxation", options.relaxation);
    require_positive("weight of the infinitesimal loads", options.infinitesimal_weight);
    if (options.start_fraction() > 0.8 || options.softness > first_pressure) {
        refuse("preparation", "loose fraction {} and softness {}: expected at most 0.8 and {}",
               options.start_fraction(), options.softness, first_pressure);
    }
    for (std::size_t i = 0; i < options.radii.size(); ++i) {
        require_positive(fmt::format("radius of disk {}", i).c_str(), options.radii[i]);
    }
    if (options.ratio != 1) {
        refuse("preparation", "ratio of the stresses is {}: expected 1, the packing is compressed isotropically",
               options.ratio);
    }
    const std::size_t disks =
        options.radii.empty() ? static_cast<std::size_t>(std::max(options.disks, 0)) : options.radii.size();
    const bool periodic = options.cell != PreparedCell::none;
    if (periodic && disks > static_cast<std::size_t>(options.large_above)) {
        refuse("preparation", "{} disks in a periodic cell: expected at most {}", disks, options.large_above);
    }
    if (options.cell == PreparedCell::tilted && options.load != LoadKind::nominal) {
        refuse("preparation", "true stresses where the tilt moves have no potential: expected nominal ones");
    }
    if (options.loaded_axis.value_or(0) >= options.dimension && options.cell != PreparedCell::tilted) {
        refuse("preparation", "the shear stress is to be changed and no tilt moves: expected a tilted cell");
    }
    if (!(options.jitter >= 0 && options.jitter < 1)) {
        refuse("preparation", "jitter is {}: expected a number from 0 to below 1", options.jitter);
    }
}

std::vector<double> radii_of(const PreparationOptions& options) {
    return with_jitter(options.radii.empty() ? draw_radii(options.diameters, options.disks, options.seed)
                                             : options.radii,
                       options.jitter, options.seed);
}

/// Brings soft disks from a random start to a packing under a small pressure, in recorded stages.
class SoftStages {
  public:
    SoftStages(Packing& packing, const PreparationOptions& options, PreparationReport& report)
        : packing_(packing), options_(options), report_(report), large_(packing.disk_count() > options.large_above) {}

    /// False when interrupted, in the last stage of the report.
    bool run() {
        const double pressed = large_ ? first_pressure_large : first_pressure;
        return soft("separation", [&](auto& d) { return d.separate(start_overlap, options_.max_steps); }) &&
               soft("compression",
                    [&](auto& d) { return d.compress(pressed, compression_rate, options_.max_steps); }) &&
               relax(pressed) && newton();
    }

  private:
    /// Relaxes while the pressure falls in steps.
    bool relax(double pressed) {
        for (double pressure = pressed;; pressure = std::max(pressure / pressure_divisor, options_.softness)) {
            double relaxation = options_.relaxation;
            long steps = options_.max_steps;
            const bool last = pressure <= options_.softness;
            if (large_) {
                relaxation *= last ? relaxation_large : relaxation_between;
                steps = std::min(steps, last ? steps_large : steps_between);
            }
            if (!soft(fmt::format("relaxation at {:.0e}", pressure),
                      [&](auto& d) { return d.relax(pressure, relaxation, steps); })) {
                return false;
            }
            if (last) {
                return true;
            }
        }
    }
    /// Takes Newton steps in very large packings.
    bool newton() {
        if (!large_ || packing_.disk_count() <= options_.newton_above) {
            return true;
        }
        SoftNewton steps(packing_, options_.stop);
        return std::ranges::all_of(newton_divisors, [&](double divisor) {
            const double pressure = options_.softness / divisor;
            return record(fmt::format("newton steps at {:.0e}", pressure), [&](const auto& progress) {
                return steps.relax(pressure, newton_tolerance, most_newton_steps, progress);
            });
        });
    }
    template <class Work> bool soft(const std::string& name, const Work& work) {
        return record(name, [&](const std::function<void(double)>& progress) {
            SoftDynamics dynamics(packing_, large_, options_.stop, progress);
            return work(dynamics);
        });
    }
    template <class Work> bool record(const std::string& name, const Work& work) {
        const Stage stage(name, options_);
        const SoftMeasures measures = work([&](double fraction) {
            stage.progress(fraction, fmt::format("solid fraction {:.4f}", packing_.solid_fraction()));
        });
        PreparationStage entry =
            stage.finish(measures.converged, measures.steps, measures.contacts, packing_.solid_fraction());
        entry.residual = measures.residual;
        entry.pressure_error = measures.pressure_error;
        entry.overlap = measures.overlap;
        report_.stages.push_back(entry);
        return !measures.interrupted;
    }

    Packing& packing_;
    const PreparationOptions& options_;
    PreparationReport& report_;
    bool large_;
};

} // namespace

} // namespace preparation

Result<State> prepare(const PreparationOptions& options, PreparationReport& report) {
    require_floating_point();
    using namespace preparation;
    check(options);
    const std::vector<double> radius = radii_of(options);
    const Scale scale(radius);
    std::vector<double> internal = radius;
    scale.to_internal(internal);
    Packing packing = scatter(std::move(internal), options, derived_seed(options.seed, Stream::positions));
    if (!SoftStages(packing, options, report).run()) {
        report.last = scale.to_user(packing, radius);
        report.solid_fraction = packing.solid_fraction();
        const PreparationStage& stage = report.stages.back();
        return failed(FailureKind::interrupted, "stopped during {} after {} steps", stage.name, stage.iterations);
    }
    auto state = find_vertex(scale.to_user(packing, radius), options, report);
    if (state.ok() && options.loaded_axis) {
        state.value().load.loaded_axis = *options.loaded_axis;
    }
    if (state.ok() && options.path) {
        state.value().load.follow(*options.path);
    }
    return state;
}

} // namespace isostat
