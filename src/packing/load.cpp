#include <isostat/packing/load.hpp>

#include <random>

namespace isostat {

template <int Dim> double Load<Dim>::force_per_stress(const Packing<Dim>& packing, int axis) const {
    double product = 1;
    for (int a = 0; a < Dim; ++a) {
        if (a != axis) {
            product *= kind == LoadKind::nominal ? reference_length[static_cast<std::size_t>(a)] : packing.length(a);
        }
    }
    return product;
}

template <int Dim> std::vector<double> Load<Dim>::external_force(const Packing<Dim>& packing) const {
    std::vector<double> force = fixed_force(packing);
    const auto wall = static_cast<std::size_t>(Dim * packing.disk_count() + loaded_axis);
    force[wall] = -stress[static_cast<std::size_t>(loaded_axis)] * force_per_stress(packing, loaded_axis);
    return force;
}

template <int Dim> std::vector<double> Load<Dim>::unit_force(const Packing<Dim>& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    force[static_cast<std::size_t>(Dim * packing.disk_count() + loaded_axis)] = -force_per_stress(packing, loaded_axis);
    return force;
}

template <int Dim> std::vector<double> Load<Dim>::fixed_force(const Packing<Dim>& packing) const {
    std::vector<double> force(packing.q.size(), 0.0);
    std::copy(disk_force.begin(), disk_force.end(), force.begin());
    for (int a = 0; a < Dim; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        if (a != loaded_axis && packing.walls.upper[axis] == WallKind::movable) {
            force[static_cast<std::size_t>(Dim * packing.disk_count() + a)] =
                -stress[axis] * force_per_stress(packing, a);
        }
    }
    return force;
}

template <int Dim> double potential(const Packing<Dim>& packing, const Load<Dim>& load) {
    const std::vector<double> force = load.external_force(packing);
    double work = 0;
    for (std::size_t k = 0; k < force.size(); ++k) {
        work -= force[k] * packing.q[k];
    }
    return work;
}

template <int Dim>
std::vector<double> generic_infinitesimal(const std::vector<double>& radius, unsigned long long seed) {
    // Mostly along minus the last axis, tilted off every wall normal; the noise makes it generic.
    constexpr double tilt = 0.10;
    constexpr double amplitude = 0.25;
    std::mt19937_64 random(seed);
    const auto noise = [&random] { return 2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1; };
    std::vector<double> g(static_cast<std::size_t>(Dim) * radius.size());
    for (std::size_t i = 0; i < radius.size(); ++i) {
        for (std::size_t a = 0; a < Dim; ++a) {
            const double direction = a + 1 == Dim ? -1.0 : tilt;
            g[Dim * i + a] = radius[i] * radius[i] * (direction + amplitude * noise());
        }
    }
    return g;
}

template <int Dim> std::vector<double> on_dofs(const std::vector<double>& on_coordinates, const DofMap<Dim>& dofs) {
    std::vector<double> force(static_cast<std::size_t>(dofs.dof_count()), 0.0);
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        const auto k = static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)));
        force[mu] = k < on_coordinates.size() ? on_coordinates[k] : 0.0;
    }
    return force;
}

template struct Load<2>;
template std::vector<double> on_dofs<2>(const std::vector<double>&, const DofMap<2>&);
template double potential<2>(const Packing<2>&, const Load<2>&);
template std::vector<double> generic_infinitesimal<2>(const std::vector<double>&, unsigned long long);

} // namespace isostat
