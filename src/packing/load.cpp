#include "packing/words.hpp"

#include <isostat/packing/packing.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>
#include <string>

namespace isostat {

void Load::refer_to(const Packing& packing) {
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        reference_length[a] = packing.length(static_cast<int>(a));
    }
    for (std::size_t t = 0; t < packing.tilts(); ++t) {
        reference_tilt[t] = packing.cell.any() ? packing.q[packing.length_at(packing.axes() + t)] : 0;
    }
}

std::string Load::stress_name() const {
    if (dimension == plane) {
        return loads_tilt() ? "shear" : "sigma2";
    }
    return loads_tilt() ? std::string("shear_") + tilt_names[loaded_tilt()] : "sigma" + std::to_string(loaded_axis + 1);
}

std::string Load::ratio_name() const {
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
    const auto add = [&](std::size_t place, std::size_t axis, double pressure, std::size_t but) {
        WallForce force;
        force.coordinate = static_cast<int>(walls + place);
        force.axis = static_cast<int>(axis);
        force.stress = pressure;
        force.loaded = static_cast<int>(place) == loaded_axis;
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
            add(a, a, stress[a], a);
        }
    }
    assert(!loads_tilt() || (packing.cell.any() && packing.cell.tilt_moves[loaded_tilt()]));
    for (std::size_t b = 1; b < packing.axes() && packing.cell.any(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            if (const std::size_t t = Cell::tilt(a, b); packing.cell.tilt_moves[t]) {
                add(packing.axes() + t, a, shear[t], b);
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
        if (!wall.loaded && wall.stress != 0 && wall.length * wall.other != 0) {
            rows.push_back(dofs.dof_of(static_cast<std::size_t>(wall.coordinate)));
        }
    }
    return rows;
}

int Load::loaded_wall_row(const Packing& packing, const DofMap& dofs) const {
    for (const WallForce& wall : wall_forces(packing)) {
        if (wall.loaded && wall.length * wall.other != 0) {
            return dofs.dof_of(static_cast<std::size_t>(wall.coordinate));
        }
    }
    return -1;
}

std::vector<double> Load::external_force(const Packing& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    for_each_force(packing, [&force](std::size_t k, double f) { force[k] = f; });
    return force;
}

std::vector<double> Load::unit_force(const Packing& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    for (const WallForce& wall : wall_forces(packing)) {
        if (wall.loaded) {
            force[static_cast<std::size_t>(wall.coordinate)] = -(wall.length * wall.other);
        }
    }
    return force;
}

std::vector<double> Load::fixed_force(const Packing& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    std::copy(disk_force.begin(), disk_force.end(), force.begin());
    for (const WallForce& wall : wall_forces(packing)) {
        if (!wall.loaded) {
            force[static_cast<std::size_t>(wall.coordinate)] = -(wall.stress * wall.length * wall.other);
        }
    }
    return force;
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
    double largest = 0;
    for (const double g : infinitesimal) {
        largest = std::max(largest, std::abs(g));
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    const auto axes = static_cast<std::size_t>(cell.dimension);
    for (std::size_t a = 0; a < axes && largest > 0; ++a) {
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

} // namespace isostat
