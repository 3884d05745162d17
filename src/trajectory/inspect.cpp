#include "contact/separation.hpp"
#include "core/roundoff.hpp"
#include "motion/arc.hpp"
#include "trajectory/record.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

using roundoff::u;

double norm_of(const std::vector<double>& x) {
    double sum = 0;
    for (const double c : x) {
        sum += c * c;
    }
    return std::sqrt(sum);
}

/// d2W/ds2 = -sum f_l |u_t|^2 / d_l along the mechanism that moves the held coordinate in column `slot` at unit rate:
/// with the kept gaps at rest, grad W = sum f_l grad h_l and grad h_l . q'' = -|u_t|^2 / d_l. At the true vertex.
Enclosure curvature_of_potential(const Vertex& vertex, const std::vector<double>& forces, std::size_t slot,
                                 double sigma) {
    const auto& contacts = vertex.structure.contacts();
    std::vector<double> on_dofs(contacts.size(), 0.0);
    on_dofs[slot] = 1;
    vertex.factorisation.solve_velocities(on_dofs);
    std::vector<double> v(vertex.packing.q.size(), 0.0);
    double largest = 0;
    for (std::size_t mu = 0; mu < on_dofs.size(); ++mu) {
        v[static_cast<std::size_t>(vertex.structure.dofs().coordinate_of(static_cast<int>(mu)))] = on_dofs[mu];
        largest = std::max(largest, std::abs(on_dofs[mu]));
    }
    const double away = vertex.enclosure.distance();
    const double turned = vertex.statics.normal_uncertainty(); // of the matrix, at the true vertex
    // |v - v~| <= |G v~ - e| / sigma_min: bounded here through the residual, row by row.
    double residual = 0;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const GapGradient g = gap_gradient(vertex.packing, contacts[l]);
        double rate = l == slot ? 1.0 : 0.0;
        double size = rate;
        for (int k = 0; k < g.count; ++k) {
            const auto e = static_cast<std::size_t>(k);
            const double term = g.value[e] * v[static_cast<std::size_t>(g.coordinate[e])];
            rate += term;
            size += std::abs(term);
        }
        const double bound = std::abs(rate) + 16 * u * size;
        residual += bound * bound;
    }
    const double sigma_min = vertex.inverse.sigma_min - turned;
    const double velocity_error = sigma_min > 0
                                      ? (std::sqrt(residual) + turned * norm_of(on_dofs)) * (1 + 1e-10) / sigma_min
                                      : std::numeric_limits<double>::infinity();
    double value = 0;
    double error = 0;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (contacts[l].kind != ContactKind::disk_disk) {
            continue;
        }
        const double bend = gap_curvature(vertex.packing, contacts[l], v.data());
        const double d = touching_distance(vertex.packing.radius, contacts[l]);
        // |u_t|^2 changes by at most (2 |u_t| + e) e: the velocities change, and the normal turns by 4 away / d at
        // most.
        const double e = 2 * velocity_error + 8 * largest * 4 * away / d;
        const double bend_error = (2 * std::sqrt(bend * d) + e) * e / d + bend * (16 * u + 4 * away / d);
        value -= forces[l] * bend;
        error += vertex.statics.force(ContactId(l), sigma).radius * bend + std::abs(forces[l]) * bend_error;
    }
    const double scale = largest * largest;
    return {value / scale, (error + 8 * u * std::abs(value)) / scale * 1.001};
}

/// Largest number of disk contacts of one disk.
int most_contacts(int disks, const std::vector<Contact>& contacts) {
    std::vector<int> count(static_cast<std::size_t>(disks), 0);
    int most = 1;
    for (const Contact& c : contacts) {
        if (c.kind == ContactKind::disk_disk) {
            most = std::max({most, ++count[static_cast<std::size_t>(c.i)], ++count[static_cast<std::size_t>(c.j)]});
        }
    }
    return most;
}

/// 2-norm of the forces: what a change of the matrix acts on.
double force_norm(const Vertex& vertex, double sigma) {
    double sum = 0;
    for (int l = 0; l < vertex.structure.size(); ++l) {
        const double f = vertex.statics.force(ContactId(l), sigma).value;
        sum += f * f;
    }
    return std::sqrt(sum);
}

/// The potential of the load falls where W does: dead loads; true stresses >= 0 without forces on disks (S2, S5).
bool falls_with_work(const Load& load) {
    const auto not_zero = [](double f) { return f != 0; };
    return load.kind == LoadKind::nominal ||
           (std::none_of(load.disk_force.begin(), load.disk_force.end(), not_zero) &&
            std::all_of(load.stress.begin(), load.stress.end(), [](double stress) { return stress >= 0; }));
}

/// Signs of the forces, multipliers of what is held, and what the potential does along one mechanism.
void judge_forces(MechanismInspection& inspection, Vertex& vertex, const State& state) {
    const double sigma = state.load.loaded_stress();
    EquilibriumRecord& record = inspection.record;
    record.verdict = Verdict::refuted; // not isostatic
    vertex.statics.climb();
    bool positive = true;
    bool at_rest = true;
    for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
        const Enclosure f = vertex.statics.force(ContactId(l), sigma);
        if (inspection.contacts[l].kind != ContactKind::held) {
            positive = positive && (f.positive() || (vertex.statics.is_structural_zero(ContactId(l)) &&
                                                     vertex.statics.infinitesimal(ContactId(l)).positive()));
        } else {
            ++record.held;
            // Known only as well as the stored configuration: a displacement of 2-norm r changes the matrix by at
            // most 2 sqrt(z) r / D_min in the 2-norm (V4), the forces by |H^-1| times that times |f|.
            const double uncertain =
                1.01 * std::sqrt(static_cast<double>(most_contacts(state.packing.disk_count(), inspection.contacts))) *
                vertex.enclosure.distance() / state.packing.min_radius() * force_norm(vertex, sigma) /
                vertex.inverse.sigma_min;
            at_rest = at_rest && std::abs(f.value) <= f.radius + uncertain;
            if (std::abs(f.value) > f.radius + uncertain && inspection.remark.empty()) {
                inspection.remark = fmt::format("not an equilibrium: the mechanism moves, force {:.6g} on the {}",
                                                f.value, to_string(inspection.contacts[l], state.packing.dimension));
            }
        }
    }
    if (positive && at_rest && record.held == 1 && inspection.remark.empty()) {
        const auto held = std::find_if(inspection.contacts.begin(), inspection.contacts.end(),
                                       [](const Contact& c) { return c.kind == ContactKind::held; });
        const Enclosure second = curvature_of_potential(
            vertex, inspection.forces, static_cast<std::size_t>(held - inspection.contacts.begin()), sigma);
        if (state.load.kind == LoadKind::nominal) {
            inspection.second_order = second;
        }
        const bool maximum = second.negative() && falls_with_work(state.load);
        if (maximum) {
            inspection.stable = Verdict::refuted;
        }
        inspection.remark = fmt::format("equilibrium with one mechanism (k = 1){}",
                                        maximum ? ", not stable: the potential has a maximum along it" : "");
    }
}

} // namespace

Result<MechanismInspection> inspect_mechanism(const State& state, const Counting& counting) {
    require_floating_point();
    require_box(state.packing, "state", "what a mechanism does");
    MechanismInspection inspection;
    inspection.contacts = state.contacts;
    const DofMap dofs(state.packing);
    for (const int dof : counting.free_dofs) {
        inspection.contacts.push_back({ContactKind::held, dofs.coordinate_of(dof), 0});
    }
    InverseBoundCache cache;
    auto made = Vertex::make(state.packing, inspection.contacts, state.load, cache);
    if (!made.ok()) {
        return made.failure();
    }
    Vertex& vertex = *made.value();
    const double sigma = state.load.loaded_stress();
    inspection.rattlers = rattlers(vertex);
    CandidateList candidates = find_candidates(state.packing, candidate_fraction);
    KeptCandidates kept;
    auto gaps = vertex.check_gaps(candidates, kept);
    if (!gaps.ok()) {
        inspection.remark = gaps.failure().message(state.packing.dimension);
    } else if (gaps.value().negative) {
        inspection.remark = fmt::format("{} overlap", to_string(*gaps.value().negative, state.packing.dimension));
    } else if (const auto pair = fixed_overlap(state.packing)) {
        inspection.remark = fmt::format("{} overlap, and cannot move", to_string(*pair, state.packing.dimension));
    }
    inspection.forces = finite_forces(vertex, state.load);
    for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
        inspection.structural_zero.push_back(vertex.statics.is_structural_zero(ContactId(l)) ? 1 : 0);
    }
    judge_forces(inspection, vertex, state);
    EquilibriumRecord& record = inspection.record;
    record.number = state.equilibrium;
    record.stress = sigma;
    record.dof_count = counting.dof_count;
    record.contact_count = counting.contact_count;
    record.rank = counting.rank;
    record.hyperstaticity = counting.hyperstaticity;
    record.mechanisms = counting.mechanisms;
    record.rattlers = static_cast<int>(inspection.rattlers.size());
    record.backbone = vertex.statics.backbone_count();
    record.gap_residual = vertex.enclosure.max_gap;
    record.sigma_min_bound = vertex.inverse.sigma_min;
    if (gaps.ok() && !gaps.value().negative) {
        if (auto failure = record_smallest_gap(record, vertex, vertex.enclosure, candidates)) {
            return *failure;
        }
    }
    return inspection;
}

} // namespace isostat
