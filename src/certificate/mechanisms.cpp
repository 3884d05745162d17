#include "certificate/held_minimum.hpp"
#include "certificate/parts.hpp"
#include "contact/other_pairs.hpp"
#include "core/decimal.hpp"
#include "core/roundoff.hpp"
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

/// Of U8: dead loads; true stresses without forces on disks and without a tilt that moves (S5).
bool has_potential(const State& state) {
    const std::vector<double>& forces = state.load.disk_force;
    const Cell& cell = state.packing.cell;
    return !cell.keeps_shape &&
           (state.load.kind == LoadKind::nominal ||
            (!cell.shears() && std::ranges::all_of(forces, [](double force) { return force == 0; })));
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
            // Known only as well as the stored configuration: the forces change by |H^-1| times what the matrix does.
            const double uncertain =
                // clumps.md U4, what a multiplier that is 0 at the stored place may be
                1.01 * vertex.statics.normal_uncertainty() * force_norm(vertex, sigma) / vertex.inverse.sigma_min;
            at_rest = at_rest && std::abs(f.value) <= f.radius + uncertain;
            if (std::abs(f.value) > f.radius + uncertain && inspection.remark.empty()) {
                inspection.remark = fmt::format("not an equilibrium: the mechanism moves, force {:.6g} on the {}",
                                                f.value, to_string(inspection.contacts[l], state.packing.dimension));
            }
        }
    }
    const std::size_t most = state.packing.bars.empty() ? 1 : acting.size(); // of clumps any one of several
    if (positive && at_rest && !acting.empty() && acting.size() <= most && inspection.remark.empty()) {
        const Enclosure second =
            has_potential(state) ? least_curvature(vertex, state.load, acting) : Enclosure{0, roundoff::infinity};
        inspection.second_order = second;
        const bool maximum = second.negative();
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
void judge_minimum(MechanismInspection& inspection, const Vertex& vertex, const State& state,
                   const std::vector<std::size_t>& acting, const std::vector<Contact>& candidates, double moved) {
    const EquilibriumRecord& record = inspection.record;
    const bool asked = !acting.empty() && has_potential(state) && state.load.infinitesimal.empty();
    // clumps.md U8, what the grid moves and the pin moves back, with roundings
    const double off = 3 * moved * std::sqrt(static_cast<double>(vertex.packing.q.size())); // what is stored
    const auto minimum =
        asked ? minimum_near(vertex, state.load, acting, record.min_gap - record.min_gap_bound, off) : std::nullopt;
    if (minimum) {
        inspection.stable = Verdict::proved;
        inspection.away = minimum->away + off;
        inspection.curvature = minimum->curvature;
        inspection.form = minimum->form;
        for (const std::size_t slot : acting) {
            inspection.held.push_back(inspection.contacts[slot]);
        }
        inspection.yielding =
            yielding_at(vertex, state.load, acting, *minimum,
                        without(candidates, vertex.structure.contacts(), vertex.packing.disk_count()));
        inspection.remark =
            fmt::format("equilibrium with {} mechanism(s), a strict local minimum within {} of the "
                        "stored place: W'' >= {} in the coordinates that are held",
                        // message: digits
                        acting.size(), rounded_up(inspection.away, 2), rounded_down(minimum->curvature, 6));
    }
}

void record_counts(EquilibriumRecord& record, const Counting& counting) {
    record.dof_count = counting.dof_count;
    record.contact_count = counting.contact_count;
    record.rank = counting.rank;
    record.hyperstaticity = counting.hyperstaticity;
    record.mechanisms = counting.mechanisms;
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

Result<MechanismInspection> inspect_mechanism(const State& stored, const Counting& counting) {
    require_floating_point();
    State state = stored;
    double moved = 0; // of a coordinate; the pinned grain is moved back afterwards, and all others with it
    if (state.packing.cell.any()) {
        auto snapped = on_grid(state.packing, state.contacts, moved);
        if (!snapped) {
            return Failure{FailureKind::undecided, "the cell cannot be put on the grid of the packing"};
        }
        state.packing = std::move(*snapped);
    }
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
    record_counts(record, counting);
    record.rattlers = static_cast<int>(inspection.rattlers.size());
    record.backbone = carrying_contacts(vertex);
    record.gap_residual = vertex.enclosure.max_gap;
    record.sigma_min_bound = vertex.inverse.sigma_min;
    if (gaps.ok() && !gaps.value().negative && !joint) {
        if (auto failure = record_smallest_gap(record, vertex, vertex.enclosure, candidates)) {
            return *failure;
        }
        judge_minimum(inspection, vertex, state, acting, candidates.contacts, moved);
        const double least =
            std::max(0.0, (record.min_gap - record.min_gap_bound) * (1 - 2 * roundoff::u)); // it is no overlap
        record.min_gap = ArcBodies(state.packing).below(least);
        record.min_gap_bound = 0;
    }
    return inspection;
}

} // namespace isostat
