#include "core/refuse.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/bodies.hpp"
#include "packing/cell_wrap.hpp"
#include "packing/words.hpp"

#include <isostat/packing/packing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat {

namespace {

/// -1: nothing has to be pinned.
int pinned_grain(const Packing& packing) {
    int pin = packing.cell.any() ? packing.cell.pin : -1;
    for (int i = 0; pin >= 0 && packing.is_fixed(DiskId(pin)) && i < packing.disk_count(); ++i) {
        pin = packing.is_fixed(DiskId(i)) ? pin : i;
    }
    return pin;
}

void validate_cell(const Packing& packing, const std::string& source) {
    const Cell& cell = packing.cell;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        if (!cell.periodic[a]) {
            if (cell.period_moves[a]) {
                refuse(source, "the period along {} moves, and that axis has walls: expected a periodic axis",
                       axis_names[a]);
            }
            continue;
        }
        if (packing.walls.lower[a] != WallKind::absent || packing.walls.upper[a] != WallKind::absent) {
            refuse(source, "{} is periodic and has walls: expected walls \"absent\" along it", axis_names[a]);
        }
        const double length = packing.lattice(a, a);
        if (!(length > 0 && length <= longest_length)) {
            refuse(source,
                   "the period along {} is {}: expected a positive length of at most {} (the cell is inverted or "
                   "degenerate)",
                   axis_names[a], length, longest_length);
        }
    }
    for (std::size_t b = 1; b < packing.axes(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            const double tilt = packing.lattice(a, b);
            const bool both = cell.periodic[a] && cell.periodic[b];
            if (!(std::abs(tilt) <= longest_length) || (!both && (tilt != 0 || cell.tilt_moves[cell.tilt(a, b)]))) {
                refuse(source, "the tilt {} is {}: expected {}", tilt_names[cell.tilt(a, b)], tilt,
                       both ? "a finite number" : "0, fixed, as one of its axes has walls");
            }
        }
    }
    Cell shaped = cell;
    shaped.keep_shape();
    if (cell.keeps_shape && (!cell.all() || shaped != cell)) {
        refuse(source, "the cell keeps its shape: expected periodic axes alone, and nothing else that moves");
    }
    if (cell.pin < 0 || cell.pin >= packing.disk_count()) {
        refuse(source, "{} {} is pinned: expected one from 0 to {}", grain_word(packing.dimension), cell.pin,
               packing.disk_count() - 1);
    }
    if (std::ranges::find(packing.fixed, 1) != packing.fixed.end()) {
        refuse(source, "fixed disks in a periodic cell are not supported: expected none (the pinned one says where the "
                       "origin is)");
    }
}

/// The length of the period A m.
double period_length(const Packing& packing, const std::array<int, most_axes>& m) {
    PerAxis<double> period{};
    add_periods(period, packing, m);
    return packing.dimension == plane ? std::hypot(period[0], period[1]) : std::hypot(period[0], period[1], period[2]);
}

/// Periods that a grain can meet itself through: the short ones among those of a few cells.
void validate_own_images(const Packing& packing, const std::string& source) {
    constexpr int few = 3;
    const auto largest = std::ranges::max_element(packing.radius);
    std::array<int, most_axes> most{};
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        most[a] = packing.cell.periodic[a] ? few : 0;
    }
    for (int z = 0; z <= most[2]; ++z) {
        for (int y = z == 0 ? 0 : -most[1]; y <= most[1]; ++y) {
            for (int x = y == 0 && z == 0 ? 1 : -most[0]; x <= most[0]; ++x) {
                const double period = period_length(packing, {x, y, z});
                const bool rests = packing.dimension == plane ? y == 0 : z == 0; // while the last period moves
                if (packing.cell.keeps_shape && rests &&
                    !(2 * *largest < period * (1 - 1e-9))) { // proofs/cells.md, C13
                    refuse(source,
                           "the cell keeps its shape and a {} of diameter {} touches its own image along {}, {} away: "
                           "expected a larger period there",
                           grain_word(packing.dimension), 2 * *largest, packing.dimension == plane ? "x" : "x and y",
                           period);
                }
                if (2 * *largest > period * (1 + 1e-9)) { // beyond rounding: whatever the configuration
                    refuse(source,
                           "{} {} of diameter {} overlaps its own image ({}, {}{}), {} away: expected a diameter of at "
                           "most the shortest period",
                           grain_word(packing.dimension), largest - packing.radius.begin(), 2 * *largest, x, y,
                           packing.dimension == plane ? "" : fmt::format(", {}", z), period);
                }
            }
        }
    }
}

} // namespace

Walls Walls::box(int dimension) {
    Walls walls;
    std::fill_n(walls.lower.begin(), dimension, WallKind::fixed);
    std::fill_n(walls.upper.begin(), dimension, WallKind::movable);
    return walls;
}

Walls Walls::none() {
    return {};
}

double Packing::min_radius() const {
    return *std::ranges::min_element(radius);
}
double Packing::max_radius() const {
    return *std::ranges::max_element(radius);
}

double Packing::solid_fraction() const {
    return solid_fraction_without({});
}

double Packing::solid_fraction_without(std::span<const int> left_out) const {
    double grains = 0;
    for (int i = 0; i < disk_count(); ++i) {
        const double r = radius[static_cast<std::size_t>(i)];
        const bool counts = std::ranges::find(left_out, i) == left_out.end();
        grains += !counts ? 0 : dimension == plane ? std::numbers::pi * r * r : 4 * std::numbers::pi / 3 * r * r * r;
    }
    grains -= bars.empty() ? 0 : shared_by_members(*this, left_out);
    double cell_size = 1;
    for (int a = 0; a < dimension; ++a) {
        cell_size *= length(a);
    }
    return grains / cell_size;
}

DofMap::DofMap(const Packing& packing)
    : layout_(packing.layout()), periodic_(packing.cell.periodic), dof_of_(packing.q.size(), -1) {
    coordinate_of_.reserve(packing.q.size());
    const auto add = [&](std::size_t coordinate) {
        dof_of_[coordinate] = static_cast<int>(coordinate_of_.size());
        coordinate_of_.push_back(static_cast<int>(coordinate));
    };
    const int pin = pinned_grain(packing);
    for (int i = 0; i < layout_.disks; ++i) {
        for (std::size_t a = 0; a < layout_.axes() && !packing.is_fixed(DiskId(i)); ++a) {
            if (i != pin || !periodic_[a]) {
                add(layout_.of_disk(i) + a);
            }
        }
    }
    const Cell& cell = packing.cell;
    for (std::size_t a = 0; a < layout_.axes(); ++a) {
        if (cell.periodic[a] ? cell.period_moves[a] : packing.walls.upper[a] == WallKind::movable) {
            add(packing.length_at(a));
        }
    }
    for (std::size_t t = 0; cell.any() && t < cell.tilt_moves.size(); ++t) {
        if (cell.tilt_moves[t]) {
            add(packing.length_at(layout_.axes() + t));
        }
    }
}

std::vector<double> DofMap::on_coordinates(const std::vector<double>& on_dofs) const {
    std::vector<double> all(dof_of_.size(), 0.0);
    for (std::size_t mu = 0; mu < on_dofs.size(); ++mu) {
        all[coordinate_of(mu)] = on_dofs[mu];
    }
    return all;
}

std::string DofMap::name(int dof) const {
    const auto coordinate = static_cast<std::size_t>(coordinate_of(dof));
    const std::size_t d = layout_.axes();
    if (coordinate < layout_.of_length(0)) {
        return fmt::format("{} of {} {}", axis_names[coordinate % d], grain_word(layout_.dimension), coordinate / d);
    }
    const std::size_t axis = coordinate - layout_.of_length(0);
    return axis >= d         ? fmt::format("tilt {}", tilt_names[axis - d])
           : periodic_[axis] ? fmt::format("period along {}", axis_names[axis])
                             : fmt::format("{} wall", upper_wall_names[axis]);
}

void require_box(const Packing& packing, const std::string& source, const std::string& what) {
    if (packing.cell.any()) {
        refuse(source, "a periodic cell; {} takes boxes only so far", what);
    }
}

void require_plane(const Packing& packing, const std::string& source, const std::string& what) {
    if (packing.dimension != plane) {
        refuse(source, "a packing of spheres (dimension {}); {} takes disks only", packing.dimension, what);
    }
}

void validate(const Packing& packing, const std::string& source) {
    if (packing.dimension < plane || packing.axes() > most_axes || packing.cell.dimension != packing.dimension) {
        refuse(source, "dimension {}, of the cell {}: expected 2 (disks) or 3 (spheres), the same of both",
               packing.dimension, packing.cell.dimension);
    }
    const char* const grain = grain_word(packing.dimension);
    if (packing.radius.empty()) {
        refuse(source, "no {0}s: a packing needs at least one {0}", grain);
    }
    if (packing.q.size() != packing.coordinate_count()) {
        refuse(source, "{} coordinates for {} {}s: expected {}", packing.q.size(), packing.radius.size(), grain,
               packing.coordinate_count());
    }
    if (!packing.fixed.empty() && packing.fixed.size() != packing.radius.size()) {
        refuse(source, "{} flags 'fixed' for {} {}s", packing.fixed.size(), packing.radius.size(), grain);
    }
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        const double r = packing.radius[i];
        if (!(r >= shortest_length && r <= longest_length)) {
            refuse(source, "radius of {} {} is {}: expected a positive finite number from {} to {}", grain, i, r,
                   shortest_length, longest_length);
        }
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            const double x = packing.q[packing.axes() * i + a];
            if (!(std::abs(x) <= longest_length)) {
                refuse(source, "{} of {} {} is {}: expected a finite number of size at most {}", axis_names[a], grain,
                       i, x, longest_length);
            }
        }
    }
    validate_bars(packing, source);
    validate_arcs(packing, source);
    if (packing.cell.any()) {
        validate_cell(packing, source);
        validate_own_images(packing, source);
    }
    const ArcBodies arcs(packing);
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        if (packing.walls.upper[a] == WallKind::absent) {
            continue;
        }
        const double length = packing.length(static_cast<int>(a));
        if (!(std::abs(length) <= longest_length) || (packing.walls.lower[a] != WallKind::absent && !(length > 0))) {
            refuse(source, "position of the {} wall is {}: expected a positive finite number of at most {}",
                   upper_wall_names[a], length, longest_length);
        }
        if (packing.walls.lower[a] == WallKind::absent) {
            continue;
        }
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            // 2R > L beyond one rounding of L: the disk cannot fit, whatever the configuration; an arc of it may.
            if (!arcs.angles(static_cast<int>(i)) && 2 * packing.radius[i] > length * (1 + 1e-9)) {
                refuse(source, "{} {} of diameter {} is larger than the box: its length along {} is {}", grain, i,
                       2 * packing.radius[i], axis_names[a], length);
            }
        }
    }
}

double grid_step(const Packing& packing) {
    double largest = 0;
    const std::size_t disks = packing.length_at(0);
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        if (k < disks || packing.cell.any() || packing.walls.upper[k - disks] != WallKind::absent) {
            largest = std::max(largest, std::abs(packing.q[k]));
        }
    }
    int exponent = 0;
    const double mantissa = std::frexp(largest, &exponent);
    if (mantissa == 0.5) {
        --exponent; // an exact power of two is its own bound
    }
    // |x_j - x_i| + |A m| stays below 2^53 steps for |m_a| <= 3 (proofs/cells.md, C2): 8 lengths, in space 11.
    const int coarser = packing.cell.any() ? packing.dimension : 0;
    return std::ldexp(1.0, exponent - 52 + coarser);
}

bool is_on_grid(const Packing& packing) {
    const double step = grid_step(packing);
    return std::ranges::all_of(packing.q, [step](double x) {
        const double steps = x / step; // exact but for underflow, as the step is a power of two; fmod is slow
        return x == 0 || (std::abs(steps) >= 1 && steps == std::nearbyint(steps));
    });
}

double snap_to_grid(Packing& packing) {
    // With |x| <= 2^e, x +- 2^e away from 0 lies in the binade whose spacing is the step, 2^(e-52): the sum is rounded
    // to nearest there, and the difference is exact.
    const double shift = std::ldexp(grid_step(packing), 52);
    double moved = 0;
    if (!std::isfinite(2 * shift)) {
        return moved;
    }
    const auto snap = [shift, &moved](double& x) {
        const double away = std::copysign(shift, x);
        const double shifted = x + away;
        const double snapped = shifted - away;
        moved = std::max(moved, std::abs(snapped - x));
        x = snapped;
    };
    if (packing.cell.any()) {
        std::ranges::for_each(packing.q, snap);
        return moved;
    }
    const std::size_t disks = packing.radius.size();
    for (std::size_t i = 0; i < disks; ++i) {
        for (std::size_t a = 0; a < packing.axes() && !packing.is_fixed(DiskId(i)); ++a) {
            snap(packing.q[packing.axes() * i + a]);
        }
    }
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        if (packing.walls.upper[a] == WallKind::movable) {
            snap(packing.q[packing.length_at(a)]);
        }
    }
    return moved;
}

} // namespace isostat
