#include <isostat/packing/packing.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>

namespace isostat {

void Load::refer_to(const Packing& packing) {
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        reference_length[a] = packing.length(static_cast<int>(a));
    }
    for (std::size_t t = 0; t < packing.tilts(); ++t) {
        reference_tilt[t] = packing.cell.any() ? packing.q[packing.length_at(packing.axes() + t)] : 0;
    }
}

std::vector<WallForce> Load::wall_forces(const Packing& packing) const {
    assert(dimension == plane && packing.dimension == plane); // the area that a wall is pressed on is one length
    std::vector<WallForce> forces;
    forces.reserve(packing.axes() + packing.tilts());
    for (int a = 0; a < dimension; ++a) {
        const int other = 1 - a;
        const bool follows = kind == LoadKind::true_stress;
        const int walls = dimension * packing.disk_count();
        const auto axis = static_cast<std::size_t>(a);
        if (packing.cell.periodic[axis] ? packing.cell.period_moves[axis]
                                        : packing.walls.upper[axis] == WallKind::movable) {
            forces.push_back({walls + a, a, stress[static_cast<std::size_t>(a)],
                              follows ? packing.length(other) : reference_length[static_cast<std::size_t>(other)],
                              follows ? walls + other : -1, a == loaded_axis});
        }
    }
    assert(!loads_tilt() || (packing.cell.any() && packing.cell.tilt_moves[0]));
    if (packing.cell.any() && packing.cell.tilt_moves[0]) {
        forces.push_back({dimension * (packing.disk_count() + 1), 0, shear[0], reference_length[0], -1, loads_tilt()});
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
        if (!wall.loaded && wall.stress != 0 && wall.length != 0) {
            rows.push_back(dofs.dof_of(static_cast<std::size_t>(wall.coordinate)));
        }
    }
    return rows;
}

int Load::loaded_wall_row(const Packing& packing, const DofMap& dofs) const {
    for (const WallForce& wall : wall_forces(packing)) {
        if (wall.loaded && wall.length != 0) {
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
            force[static_cast<std::size_t>(wall.coordinate)] = -wall.length;
        }
    }
    return force;
}

std::vector<double> Load::fixed_force(const Packing& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    std::copy(disk_force.begin(), disk_force.end(), force.begin());
    for (const WallForce& wall : wall_forces(packing)) {
        if (!wall.loaded) {
            force[static_cast<std::size_t>(wall.coordinate)] = -(wall.stress * wall.length);
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
