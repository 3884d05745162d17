#include "trajectory/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace isostat {

namespace {

template <int Dim> double loaded_stress(const Load<Dim>& load) {
    return load.stress[static_cast<std::size_t>(load.loaded_axis)];
}

/// |f . (G v) - F . v| / sum |F_i v_i| for a fixed pseudo-random v: both sides of the theorem of virtual power.
template <int Dim> double virtual_power_error(const Vertex<Dim>& vertex, double sigma) {
    const sparse::Matrix<double>& h = vertex.structure.matrix();
    std::mt19937_64 random(20000731);
    std::vector<double> v(static_cast<std::size_t>(h.rows));
    for (double& c : v) {
        c = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
    }
    double inner = 0;
    double size = 0;
    for (std::size_t l = 0; l < static_cast<std::size_t>(h.cols); ++l) {
        double approach = 0;
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            approach += h.value[s] * v[static_cast<std::size_t>(h.row[s])];
        }
        inner += vertex.statics.force(ContactId(l), sigma).value * approach;
    }
    const std::vector<double> force = vertex.statics.external_force(sigma);
    double outer = 0;
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        outer += force[mu] * v[mu];
        size += std::abs(force[mu] * v[mu]);
    }
    return size > 0 ? std::abs(inner - outer) / size : std::abs(inner);
}

} // namespace

template <int Dim> std::vector<int> rattlers(const Vertex<Dim>& vertex) {
    std::vector<unsigned char> carries(vertex.packing.radius.size(), 0);
    const auto& contacts = vertex.structure.contacts();
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (vertex.statics.is_structural_zero(ContactId(l)) || contacts[l].kind == ContactKind::held) {
            continue;
        }
        carries[static_cast<std::size_t>(contacts[l].i)] = 1;
        if (contacts[l].kind == ContactKind::disk_disk) {
            carries[static_cast<std::size_t>(contacts[l].j)] = 1;
        }
    }
    std::vector<int> list;
    for (std::size_t i = 0; i < carries.size(); ++i) {
        if (carries[i] == 0) {
            list.push_back(static_cast<int>(i));
        }
    }
    return list;
}

template <int Dim> std::vector<double> finite_forces(const Vertex<Dim>& vertex, const Load<Dim>& load) {
    std::vector<double> forces(static_cast<std::size_t>(vertex.structure.size()));
    for (std::size_t l = 0; l < forces.size(); ++l) {
        forces[l] = vertex.statics.force(ContactId(l), loaded_stress(load)).value;
    }
    return forces;
}

template <int Dim> Result<Description<Dim>> describe(Vertex<Dim>& vertex, const Load<Dim>& load) {
    Description<Dim> description;
    EquilibriumRecord<Dim>& record = description.record;
    record.margin = std::numeric_limits<double>::infinity();
    record.decided_by = Rung::combinatorial;
    const double sigma = loaded_stress(load);
    record.stress = sigma;
    record.sigma1 = load.stress[load.loaded_axis == 0 && Dim > 1 ? 1 : 0];
    for (int a = 0; a < Dim; ++a) {
        const double reference = load.reference_length[static_cast<std::size_t>(a)];
        record.length.push_back(vertex.packing.length(a));
        record.strain.push_back(reference > 0 ? (reference - vertex.packing.length(a)) / reference : 0.0);
    }
    record.potential = potential(vertex.packing, load);
    const auto& contacts = vertex.structure.contacts();
    record.dof_count = vertex.structure.size();
    record.contact_count = static_cast<int>(contacts.size());
    record.rank = vertex.structure.size(); // what IsostaticStructure means
    record.hyperstaticity = record.contact_count - record.rank;
    record.mechanisms = record.dof_count - record.rank;
    record.held = static_cast<int>(
        std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.kind == ContactKind::held; }));
    record.rattlers = static_cast<int>(rattlers(vertex).size());
    record.backbone = vertex.statics.backbone_count();
    record.gap_residual = vertex.enclosure.max_gap;
    record.sigma_min_bound = vertex.inverse.sigma_min;

    for (const int direction : {-1, +1}) {
        if (record.held >
            0) { // an equilibrium at this load only: the multiplier of the held coordinate vanishes just here
            (direction > 0 ? record.stress_high : record.stress_low) = sigma;
            (direction > 0 ? record.opens_high : record.opens_low) = {ContactKind::disk_disk, -1, -1};
            continue;
        }
        const auto limit =
            find_limit(vertex.statics, sigma, direction, vertex.perturbed ? &vertex.perturbed->statics : nullptr);
        if (!limit.ok()) {
            return Failure{limit.failure().kind,
                           fmt::format("{} end of the supported interval: {}", direction > 0 ? "upper" : "lower",
                                       limit.failure().message)};
        }
        const LoadLimit& end = limit.value();
        const Contact none{ContactKind::disk_disk, -1, -1};
        (direction > 0 ? record.stress_high : record.stress_low) = end.stress;
        (direction > 0 ? record.opens_high : record.opens_low) = end.unbounded ? none : contacts[end.opens.index()];
        record.margin = std::min(record.margin, end.margin);
        record.decided_by = std::max(record.decided_by, end.rung);
        description.limit[direction > 0 ? 1 : 0] = end;
    }
    // After the limits: they may have climbed, and the bounds are then those of the better solution.
    record.force_bound = vertex.statics.bound(sigma);
    record.balance = vertex.statics.residual(sigma);
    record.virtual_power = virtual_power_error(vertex, sigma);
    record.min_force = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const ContactId id(l);
        if (vertex.statics.is_structural_zero(id) || contacts[l].kind == ContactKind::held) {
            continue;
        }
        const double f = vertex.statics.force(id, sigma).value;
        if (f < record.min_force) {
            record.min_force = f;
            record.min_force_contact = contacts[l];
        }
    }
    return description;
}

template <int Dim> void record_path(ArcRecord<Dim>& record, const Arc<Dim>& path) {
    record.closed = path.closed;
    record.power_turn = path.kind == ArcEnd::power_turn;
    record.held_at = record.power_turn ? path.end.q[static_cast<std::size_t>(path.closed.i)] : 0;
    record.power = path.power;
    record.displacement = path.displacement;
    record.steps = path.steps;
}

template void record_path<2>(ArcRecord<2>&, const Arc<2>&);
template Result<Description<2>> describe<2>(Vertex<2>&, const Load<2>&);
template std::vector<int> rattlers<2>(const Vertex<2>&);
template std::vector<double> finite_forces<2>(const Vertex<2>&, const Load<2>&);

} // namespace isostat
