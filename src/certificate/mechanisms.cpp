#include "certificate/held_minimum.hpp"
#include "certificate/sectors.hpp"
#include "contact/other_pairs.hpp"
#include "contact/separation.hpp"
#include "core/decimal.hpp"
#include "core/roundoff.hpp"
#include "motion/arc.hpp"
#include "trajectory/record.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/core/machine.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

using roundoff::u;

/// d2W/ds2 = -sum f_l |u_t|^2 / d_l along a mechanism, s its fastest coordinate: with the kept gaps at rest, grad W =
/// sum f_l grad h_l and grad h_l . q'' = -|u_t|^2 / d_l. At the true vertex.
Enclosure curvature_of_potential(const Vertex& vertex, const std::vector<double>& forces, const HeldMotion& motion,
                                 double sigma) {
    const auto& contacts = vertex.structure.contacts();
    double largest = 0;
    for (const double x : motion.v) {
        largest = std::max(largest, std::abs(x));
    }
    const double away = vertex.enclosure.distance();
    const double turned = vertex.statics.normal_uncertainty(); // of the matrix, at the true vertex
    const double sigma_min = vertex.inverse.sigma_min - turned;
    const double velocity_error = sigma_min > 0 ? (motion.residual + turned * motion.size) * (1 + 1e-10) / sigma_min
                                                : std::numeric_limits<double>::infinity();
    double value = 0;
    double error = 0;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (!contacts[l].of_disks()) {
            continue;
        }
        const double bend = gap_curvature(vertex.packing, contacts[l], motion.v.data());
        const double d = zero_distance(vertex.packing, contacts[l]);
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
        if (c.of_disks()) {
            most = std::max({most, ++count[static_cast<std::size_t>(c.i)], ++count[static_cast<std::size_t>(c.j)]});
        }
    }
    return most;
}

/// Half of the shortest bar, or the smallest radius.
double shortest_distance(const Packing& packing) {
    double shortest = packing.min_radius();
    for (const Bar& bar : packing.bars) {
        shortest = std::min(shortest, bar.length / 2);
    }
    return shortest;
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

/// Signs of the forces, multipliers of what is held, and what the potential does along one mechanism. Rows that are
/// held and no free motions, where all forces are positive and the potential has no maximum.
std::vector<std::size_t> judge_forces(MechanismInspection& inspection, Vertex& vertex, const State& state) {
    const double sigma = state.load.loaded_stress();
    EquilibriumRecord& record = inspection.record;
    record.verdict = Verdict::refuted; // not isostatic
    vertex.statics.climb();
    const bool apart = inspection.remark.empty(); // nothing overlaps
    bool positive = true;
    bool at_rest = true;
    std::vector<std::size_t> acting; // held coordinates that are no free motions
    for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
        const Enclosure f = vertex.statics.force(ContactId(l), sigma);
        const ContactKind kind = inspection.contacts[l].kind;
        const bool neutral = !state.packing.bars.empty() && vertex.statics.is_structural_zero(ContactId(l));
        if (kind == ContactKind::bar || (kind == ContactKind::held && neutral)) {
            continue; // of either sign; a free motion
        }
        if (kind != ContactKind::held) {
            positive = positive && (f.positive() || (vertex.statics.is_structural_zero(ContactId(l)) &&
                                                     vertex.statics.infinitesimal(ContactId(l)).positive()));
        } else {
            ++record.held;
            acting.push_back(l);
            // Known only as well as the stored configuration: a displacement of 2-norm r changes the matrix by at
            // most 2 sqrt(z) r / D_min in the 2-norm (V4), the forces by |H^-1| times that times |f|.
            const double uncertain =
                1.01 * std::sqrt(static_cast<double>(most_contacts(state.packing.disk_count(), inspection.contacts))) *
                vertex.enclosure.distance() / shortest_distance(state.packing) * force_norm(vertex, sigma) /
                vertex.inverse.sigma_min;
            at_rest = at_rest && std::abs(f.value) <= f.radius + uncertain;
            if (std::abs(f.value) > f.radius + uncertain && inspection.remark.empty()) {
                inspection.remark = fmt::format("not an equilibrium: the mechanism moves, force {:.6g} on the {}",
                                                f.value, to_string(inspection.contacts[l], state.packing.dimension));
            }
        }
    }
    const std::size_t most = state.packing.bars.empty() ? 1 : acting.size(); // of clumps any one of several
    if (positive && at_rest && !acting.empty() && acting.size() <= most && inspection.remark.empty()) {
        const HeldMotion least = least_curved(vertex, inspection.forces, acting);
        const Enclosure second = curvature_of_potential(vertex, inspection.forces, least, sigma);
        if (state.load.kind == LoadKind::nominal) {
            inspection.second_order = second;
        }
        const bool maximum = second.negative() && falls_with_work(state.load);
        if (maximum) {
            inspection.stable = Verdict::refuted;
        }
        inspection.remark =
            fmt::format("equilibrium with {} (k = {}){}", acting.size() == 1 ? "one mechanism" : "mechanisms",
                        acting.size(), maximum ? ", not stable: the potential has a maximum along it" : "");
    }
    return positive && apart && inspection.stable != Verdict::refuted ? acting : std::vector<std::size_t>();
}

/// The potential has a minimum along what is held (U8). \pre the nearest gap is recorded
void judge_minimum(MechanismInspection& inspection, const Vertex& vertex, const Load& load,
                   const std::vector<std::size_t>& acting, const std::vector<Contact>& candidates) {
    const EquilibriumRecord& record = inspection.record;
    const bool dead = load.kind == LoadKind::nominal && load.infinitesimal.empty();
    const auto minimum = acting.empty() || !dead ? std::nullopt
                                                 : minimum_near(vertex, load.loaded_stress(), acting,
                                                                record.min_gap - record.min_gap_bound);
    if (minimum) {
        inspection.stable = Verdict::proved;
        inspection.away = minimum->away;
        inspection.curvature = minimum->curvature;
        inspection.yielding =
            yielding_at(vertex, load.loaded_stress(), acting, *minimum,
                        without(candidates, vertex.structure.contacts(), vertex.packing.disk_count()));
        inspection.remark =
            fmt::format("equilibrium with {} mechanism(s), a strict local minimum within {} of the "
                        "stored place: W'' >= {} along every one",
                        acting.size(), rounded_up(minimum->away, 2), rounded_down(minimum->curvature, 6));
    }
}

/// Which pair overlaps, or why the gaps are not known; empty: none does.
std::string overlap_of(const Packing& packing, const Result<Vertex::Gaps>& gaps) {
    if (!gaps.ok()) {
        return gaps.failure().message(packing.dimension);
    }
    if (gaps.value().negative) {
        return fmt::format("{} overlap", to_string(*gaps.value().negative, packing.dimension));
    }
    const auto pair = fixed_overlap(packing);
    return pair ? fmt::format("{} overlap, and cannot move", to_string(*pair, packing.dimension)) : "";
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
    const auto joint = beyond_sectors(ArcBodies(state.packing), state.contacts, vertex.enclosure.distance());
    inspection.remark = joint ? *joint : overlap_of(state.packing, gaps);
    inspection.forces = finite_forces(vertex, state.load);
    for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
        inspection.structural_zero.push_back(vertex.statics.is_structural_zero(ContactId(l)) ? 1 : 0);
    }
    const std::vector<std::size_t> acting = judge_forces(inspection, vertex, state);
    EquilibriumRecord& record = inspection.record;
    record.number = state.equilibrium;
    record.stress = sigma;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    record.stress_low = record.stress_high = unknown; // not asked
    record.opens_low = record.opens_high = record.min_gap_contact = {ContactKind::disk_disk, -1, -1};
    record.min_gap = unknown;
    record.force_bound = vertex.statics.bound(sigma);
    record.dof_count = counting.dof_count;
    record.contact_count = counting.contact_count;
    record.rank = counting.rank;
    record.hyperstaticity = counting.hyperstaticity;
    record.mechanisms = counting.mechanisms;
    record.rattlers = static_cast<int>(inspection.rattlers.size());
    record.backbone = carrying_contacts(vertex);
    record.gap_residual = vertex.enclosure.max_gap;
    record.sigma_min_bound = vertex.inverse.sigma_min;
    if (gaps.ok() && !gaps.value().negative && !joint) {
        if (auto failure = record_smallest_gap(record, vertex, vertex.enclosure, candidates)) {
            return *failure;
        }
        judge_minimum(inspection, vertex, state.load, acting, candidates.contacts);
        const double least = std::max(0.0, (record.min_gap - record.min_gap_bound) * (1 - 2 * u)); // it is no overlap
        record.min_gap = ArcBodies(state.packing).below(least);
        record.min_gap_bound = 0;
    }
    return inspection;
}

} // namespace isostat
