#include "core/dot.hpp"
#include "core/refuse.hpp"
#include "packing/words.hpp"

#include <isostat/packing/load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>
#include <string>

namespace isostat {

namespace {

/// Of axis or tilt, as a load counts them.
std::size_t place_of(const Packing& packing, const WallForce& wall) {
    return static_cast<std::size_t>(wall.coordinate) - packing.length_at(0);
}

} // namespace

void Load::refer_to(const Packing& packing) {
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        reference_length[a] = packing.length(static_cast<int>(a));
    }
    for (std::size_t t = 0; t < packing.tilts(); ++t) {
        reference_tilt[t] = packing.cell.any() ? packing.q[packing.length_at(packing.axes() + t)] : 0;
    }
}

void Load::set_loaded_stress(double value) {
    if (!path) {
        (loads_tilt() ? shear[loaded_tilt()] : stress[static_cast<std::size_t>(loaded_axis)]) = value;
        return;
    }
    path->t = value;
    const auto axes = static_cast<std::size_t>(dimension);
    for (std::size_t place = 0; place < axes + Layout{dimension}.tilts(); ++place) {
        (place < axes ? stress[place] : shear[place - axes]) = exact_stress(place).nearest;
    }
}

void Load::follow(const StressRates& rate) {
    path.reset();
    const auto changing = std::ranges::find_if(rate, [](double r) { return r != 0; });
    assert(changing != rate.end());
    if (*changing == 1 && std::ranges::count(rate, 0.0) + 1 == static_cast<long>(rate.size())) {
        loaded_axis = static_cast<int>(changing - rate.begin());
        return;
    }
    loaded_axis = dimension - 1;
    StressPath along{{}, rate, 0};
    for (std::size_t place = 0; place < static_cast<std::size_t>(dimension) + Layout{dimension}.tilts(); ++place) {
        along.at[place] = stress_of(place);
    }
    path = along;
}

/// Exact sum of a product and a number (Boldo and Muller, Exact and approximated error of the FMA): no part underflows.
ExactStress Load::exact_stress(std::size_t place) const {
    if (!path) {
        return {stress_of(place), {}};
    }
    const auto two_sum = [](double a, double b) {
        const double sum = a + b;
        const double part = sum - a;
        return std::array{sum, (a - (sum - part)) + (b - part)};
    };
    const double at = path->at[place];
    const double rate = path->rate[place];
    const double nearest = std::fma(rate, path->t, at);
    const double high = rate * path->t;
    const auto [inner, low] = two_sum(at, std::fma(rate, path->t, -high));
    const auto [outer, rest] = two_sum(high, inner);
    const auto lacking = two_sum((outer - nearest) + rest, low);
    return {nearest, {lacking[0], lacking[1]}};
}

double Load::mean_stress() const {
    double sum = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        sum += stress[a];
    }
    return sum / dimension;
}

double Load::deviator() const {
    const double axial = stress[static_cast<std::size_t>(dimension) - 1];
    return axial - (dimension * mean_stress() - axial) / (dimension - 1);
}

double Load::other_stress() const {
    if (path) {
        Load start = *this;
        start.set_loaded_stress(0);
        return start.mean_stress();
    }
    return stress[static_cast<std::size_t>(other_axis())];
}

std::string Load::stress_name() const {
    if (path) {
        return "t";
    }
    if (dimension == plane) {
        return loads_tilt() ? "shear" : "sigma2";
    }
    return loads_tilt() ? std::string("shear_") + tilt_names[loaded_tilt()] : "sigma" + std::to_string(loaded_axis + 1);
}

std::string Load::ratio_name() const {
    if (path) {
        return "t/p0";
    }
    const bool first = dimension == plane && !loads_tilt(); // there the loaded axis is the second one by name
    return stress_name() + "/sigma" + std::to_string(first ? 1 : other_axis() + 1);
}

std::string Load::strain_name() const {
    if (dimension == plane) {
        return loads_tilt() ? "shear strain" : "eps2";
    }
    return loads_tilt() ? std::string("eps_") + tilt_names[loaded_tilt()] : "eps" + std::to_string(loaded_axis + 1);
}

std::vector<WallForce> Load::wall_forces(const Packing& packing) const {
    assert(dimension == packing.dimension);
    std::vector<WallForce> forces;
    forces.reserve(packing.axes() + packing.tilts());
    const std::size_t walls = packing.length_at(0);
    const bool follows = kind == LoadKind::true_stress;
    // The stress presses on the lengths of all axes but one.
    const auto add = [&](std::size_t place, std::size_t axis, std::size_t but) {
        const ExactStress pressure = exact_stress(place);
        WallForce force;
        force.coordinate = static_cast<int>(walls + place);
        force.axis = static_cast<int>(axis);
        force.stress = pressure.nearest;
        force.rest = pressure.rest;
        force.rate = rate_of(place);
        const auto times = [&](std::size_t along, double& length, int& at) {
            length = follows ? packing.q[walls + along] : reference_length[along];
            at = follows ? static_cast<int>(walls + along) : -1;
        };
        times(but == 0 ? 1 : 0, force.length, force.length_at);
        if (dimension > plane) {
            times(but == 2 ? 1 : 2, force.other, force.other_at);
        }
        forces.push_back(force);
    };
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        if (packing.cell.periodic[a] ? packing.cell.period_moves[a] : packing.walls.upper[a] == WallKind::movable) {
            add(a, a, a);
        }
    }
    assert(!loads_tilt() || (packing.cell.any() && packing.cell.tilt_moves[loaded_tilt()]));
    for (std::size_t b = 1; b < packing.axes() && packing.cell.any(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            if (const std::size_t t = Cell::tilt(a, b); packing.cell.tilt_moves[t]) {
                add(packing.axes() + t, a, b);
            }
        }
    }
    return forces;
}

std::vector<int> Load::loaded_rows(const Packing& packing, const DofMap& dofs) const {
    std::vector<int> rows;
    for (std::size_t k = 0; k < disk_force.size(); ++k) {
        if (disk_force[k] != 0 && dofs.dof_of(k) >= 0) {
            rows.push_back(dofs.dof_of(k));
        }
    }
    for (const WallForce& wall : wall_forces(packing)) {
        const bool pressed = path ? path->at[place_of(packing, wall)] != 0 : wall.rate == 0 && wall.stress != 0;
        if (pressed && wall.length * wall.other != 0) {
            rows.push_back(dofs.dof_of(static_cast<std::size_t>(wall.coordinate)));
        }
    }
    return rows;
}

std::vector<int> Load::changing_rows(const Packing& packing, const DofMap& dofs) const {
    std::vector<int> rows;
    for (const WallForce& wall : wall_forces(packing)) {
        if (wall.rate != 0 && wall.length * wall.other != 0) {
            rows.push_back(dofs.dof_of(static_cast<std::size_t>(wall.coordinate)));
        }
    }
    return rows;
}

std::vector<double> Load::external_force(const Packing& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    for_each_force(packing, [&force](std::size_t k, double f) { force[k] = f; });
    return force;
}

std::vector<double> Load::unit_force(const Packing& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    for (const WallForce& wall : wall_forces(packing)) {
        if (wall.rate != 0) {
            force[static_cast<std::size_t>(wall.coordinate)] = -(wall.rate * wall.length * wall.other);
        }
    }
    return force;
}

std::vector<double> Load::fixed_force(const Packing& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    std::ranges::copy(disk_force, force.begin());
    for (const WallForce& wall : wall_forces(packing)) {
        const double fixed = path ? path->at[place_of(packing, wall)] : wall.rate == 0 ? wall.stress : 0;
        if (fixed != 0) {
            force[static_cast<std::size_t>(wall.coordinate)] = -(fixed * wall.length * wall.other);
        }
    }
    return force;
}

std::string fault_of_path(const Packing& packing, std::span<const double> rate) {
    constexpr double largest_rate = 1e6;
    if (packing.dimension == plane) {
        return "disks: expected spheres, or loaded = \"y\" or \"tilt\"";
    }
    if (rate.size() != packing.axes() && rate.size() != packing.axes() + packing.tilts()) {
        return fmt::format("{} numbers: expected three, of the axes, or six, of the axes and of the tilts xy, xz, yz",
                           rate.size());
    }
    const DofMap dofs(packing);
    bool any = false;
    for (std::size_t place = 0; place < rate.size(); ++place) {
        const double size = std::abs(rate[place]);
        if (size == 0) {
            continue;
        }
        any = true;
        if (!(size >= 1 / largest_rate && size <= largest_rate)) {
            return fmt::format("{}: expected 0, or magnitudes from {} to {}", rate[place], 1 / largest_rate,
                               largest_rate);
        }
        const std::size_t at = packing.length_at(0) + place;
        if (at >= packing.coordinate_count() || dofs.dof_of(at) < 0) {
            return fmt::format("{} for {}, which does not move: expected 0", rate[place],
                               place < packing.axes() ? fmt::format("the length along {}", axis_names[place])
                                                      : fmt::format("the tilt {}", tilt_names[place - packing.axes()]));
        }
    }
    return any ? "" : "all numbers are 0: expected one that is not";
}

double potential(const Packing& packing, const Load& load) {
    double work = 0;
    load.for_each_force(packing, [&](std::size_t k, double f) { work -= f * packing.q[k]; });
    return work;
}

std::vector<double> generic_infinitesimal(const std::vector<double>& radius, unsigned long long seed, int dimension) {
    // Mostly along minus the last axis, tilted off every wall normal; the noise makes it generic.
    constexpr double tilt = 0.10;
    constexpr double amplitude = 0.25;
    std::mt19937_64 random(seed);
    const auto noise = [&random] { return 2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1; };
    const auto axes = static_cast<std::size_t>(dimension);
    std::vector<double> g(axes * radius.size());
    for (std::size_t i = 0; i < radius.size(); ++i) {
        for (std::size_t a = 0; a < axes; ++a) {
            const double direction = a + 1 == axes ? -1.0 : tilt;
            g[axes * i + a] = radius[i] * radius[i] * (direction + amplitude * noise());
        }
    }
    return g;
}

void balance(std::vector<double>& infinitesimal, const Cell& cell) {
    constexpr int bits = 30;
    const double size = largest(infinitesimal);
    int exponent = 0;
    std::frexp(size, &exponent);
    const auto axes = static_cast<std::size_t>(cell.dimension);
    for (std::size_t a = 0; a < axes && size > 0; ++a) {
        if (!cell.periodic[a]) {
            continue;
        }
        double others = 0; // up to 2^22 terms of 30 bits: exact
        for (std::size_t k = a; k < infinitesimal.size(); k += axes) {
            infinitesimal[k] =
                std::ldexp(std::nearbyint(std::ldexp(infinitesimal[k], bits - exponent)), exponent - bits);
            others += k == axes * static_cast<std::size_t>(cell.pin) + a ? 0 : infinitesimal[k];
        }
        infinitesimal[axes * static_cast<std::size_t>(cell.pin) + a] = -others;
    }
}

std::vector<double> on_dofs(const std::vector<double>& on_coordinates, const DofMap& dofs) {
    std::vector<double> force(static_cast<std::size_t>(dofs.dof_count()), 0.0);
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        const auto k = static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)));
        force[mu] = k < on_coordinates.size() ? on_coordinates[k] : 0.0;
    }
    return force;
}

void require_pressed_sides(const Packing& packing, const Load& load, bool stated, const std::string& source) {
    const bool present = load.kind == LoadKind::true_stress;
    for (const WallForce& wall : load.wall_forces(packing)) {
        const auto pressed = static_cast<std::size_t>(wall.axis);
        for (std::size_t side = 0; side < packing.axes(); ++side) {
            const bool open =
                packing.walls.lower[side] == WallKind::absent || packing.walls.upper[side] == WallKind::absent;
            if (side != pressed && open && !packing.cell.periodic[side] && (present || !stated)) {
                refuse(source,
                       "{}, and the stress along {} presses over the length along {}, where a wall is absent: expected "
                       "nominal stresses with reference_length in load, as the place of an absent wall means nothing",
                       present ? "load.kind is \"true\"" : "load has no reference_length", axis_names.at(pressed),
                       axis_names.at(side));
            }
        }
    }
}

} // namespace isostat
