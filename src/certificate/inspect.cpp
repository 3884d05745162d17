#include "contact/contact_set.hpp"
#include "core/roundoff.hpp"
#include "packing/bodies.hpp"

#include <isostat/certificate/certify.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

using roundoff::infinity;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double middle(const Interval& interval) {
    return 0.5 * interval.lower + 0.5 * interval.upper; // exact: middle of an interval, rounded
}

/// Bound of the distance to the middle.
double half_width(const Interval& interval) {
    const double m = middle(interval);
    // definition.md Numbers (the rounding of two subtractions, one product)
    return std::max(interval.upper - m, m - interval.lower) * (1 + 0x1p-50);
}

bool has_held(const State& state) {
    return std::ranges::any_of(state.contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
}

void describe_forces(Inspection& inspection) {
    EquilibriumRecord& record = inspection.record;
    record.margin = infinity;
    record.min_force = infinity;
    for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
        const Interval& f = inspection.truth.finite[l];
        inspection.forces.push_back(middle(f));
        if (inspection.structural_zero[l] != 0) {
            continue;
        }
        record.force_bound = std::max(record.force_bound, half_width(f));
        if (!inspection.contacts[l].is_unilateral()) {
            continue;
        }
        ++record.backbone;
        record.margin = std::min(record.margin, std::abs(middle(f)) / half_width(f));
        if (middle(f) < record.min_force) {
            record.min_force = middle(f);
            record.min_force_contact = inspection.contacts[l];
        }
    }
}

void describe_interval(EquilibriumRecord& record, const CertificateClaims& claims) {
    const auto end = [&](int direction, double& stress, Contact& opens) {
        opens = {ContactKind::disk_disk, -1, -1};
        stress = unknown;
        if (claims.load_interval) {
            const LoadEndClaim& claim = direction < 0 ? claims.load_interval->low : claims.load_interval->high;
            stress = claim.unbounded ? direction * infinity : middle(claim.stress);
            opens = claim.unbounded ? opens : claim.opens;
        }
    };
    end(-1, record.stress_low, record.opens_low);
    end(+1, record.stress_high, record.opens_high);
}

/// By body: without a force, or with all of them, loads among them, at one member, about whose centre the body turns.
void find_rattlers(const State& state, Inspection& inspection) {
    const Packing& packing = state.packing;
    const std::vector<Contact> bearing = unmarked(state.contacts, inspection.structural_zero);
    const std::vector<int> idle = untouched(packing.disk_count(), unilateral(bearing));
    for (const std::vector<int>& body : Bodies(packing).members(1)) {
        const auto held = std::ranges::count_if(body, [&](int member) {
            const auto k = packing.axes() * static_cast<std::size_t>(member);
            const std::vector<double>& force = state.load.disk_force;
            const bool loaded = !force.empty() && std::any_of(&force[k], &force[k] + packing.axes(),
                                                              [](double component) { return component != 0; });
            return loaded || !std::ranges::binary_search(idle, member) ||
                   (body.size() > 1 && packing.is_fixed(DiskId(member))); // a fixed member holds its body
        });
        if (held == 0) {
            inspection.rattlers.insert(inspection.rattlers.end(), body.begin(), body.end());
        } else if (held == 1 && body.size() > 1) {
            inspection.rotational_rattlers.push_back(body.front());
        }
    }
    std::ranges::sort(inspection.rattlers);
}

/// Of a state whose true vertex was found.
void describe(const State& state, Inspection& inspection) {
    const Certification& truth = inspection.truth;
    const CertificateClaims& claims = truth.claims;
    EquilibriumRecord& record = inspection.record;
    inspection.structural_zero = truth.structural_zero;
    find_rattlers(state, inspection);
    describe_forces(inspection);
    describe_interval(record, claims);
    inspection.equilibrium = claims.counting && claims.vertex && claims.forces && claims.gaps;
    record.verdict = inspection.equilibrium  ? Verdict::proved
                     : truth.refuted.empty() ? Verdict::undecided
                                             : Verdict::refuted;
    inspection.stable = claims.stable ? Verdict::proved : Verdict::undecided;
    if (!inspection.equilibrium) {
        inspection.remark = truth.refuted.empty() ? claims.undecided.front() : truth.refuted.front();
    }
    record.decided_by = claims.vertex->rung;
    const auto need = [&record](const auto& claim) {
        record.decided_by = claim ? std::max(record.decided_by, claim->rung) : record.decided_by;
    };
    need(claims.forces);
    need(claims.gaps);
    need(claims.load_interval);
    record.min_gap = claims.gaps ? claims.gaps->smallest : unknown;
    record.min_gap_contact = claims.gaps ? claims.gaps->where : Contact{ContactKind::disk_disk, -1, -1};
    record.sigma_min_bound = truth.smallest_sigma;
}

std::string numbers(const Counting& c) {
    return fmt::format("N_f = {}, N = {}, rank {}, h = {}, k = {}", c.dof_count, c.contact_count, c.rank,
                       c.hyperstaticity, c.mechanisms);
}

} // namespace

Result<Inspection> inspect_vertex(const State& state) {
    Inspection inspection;
    inspection.truth = certify(state);
    inspection.counting = inspection.truth.counting;
    inspection.contacts = state.contacts;
    const Counting& counting = inspection.counting;
    EquilibriumRecord& record = inspection.record;
    if (counting.hyperstaticity > 0) {
        return Failure{FailureKind::not_isostatic, numbers(counting) + ": forces are not determined by the geometry"};
    }
    const bool space = state.packing.dimension != plane;
    const bool clumps = !state.packing.bars.empty();
    // Of clumps, other mechanisms than free motions: the certificate counts these, and claims nothing of them.
    const bool moves = clumps ? counting.mechanisms > 0 && has_held(state) && !inspection.truth.claims.counting
                              : counting.mechanisms > 0 || has_held(state);
    if ((space || state.packing.cell.any()) && moves && !clumps) {
        return Failure{FailureKind::not_isostatic,
                       fmt::format("{}: mechanisms {} are counted, not followed yet", numbers(counting),
                                   space ? "of spheres" : "in a periodic cell")};
    }
    if (moves) {
        auto found = inspect_mechanism(state, counting.mechanisms > 0 ? count_contacts(state.packing, state.contacts)
                                                                      : counting);
        if (!found.ok()) {
            return found.failure();
        }
        MechanismInspection& mechanism = found.value();
        inspection.record = std::move(mechanism.record);
        inspection.contacts = std::move(mechanism.contacts);
        inspection.forces = std::move(mechanism.forces);
        inspection.structural_zero = std::move(mechanism.structural_zero);
        inspection.rattlers = std::move(mechanism.rattlers);
        inspection.stable = mechanism.stable;
        inspection.second_order = mechanism.second_order;
        inspection.yielding = mechanism.yielding;
        inspection.remark = std::move(mechanism.remark);
        if (clumps) {
            inspection.rattlers.clear();
            find_rattlers(state, inspection);
        }
        return inspection;
    }
    if (!inspection.truth.claims.vertex) {
        const auto& reasons =
            inspection.truth.refuted.empty() ? inspection.truth.claims.undecided : inspection.truth.refuted;
        return Failure{inspection.truth.refuted.empty() ? FailureKind::undecided : FailureKind::not_isostatic,
                       reasons.front()};
    }
    describe(state, inspection);
    record.number = state.equilibrium;
    record.stress = state.load.loaded_stress();
    record.dof_count = counting.dof_count;
    record.contact_count = counting.contact_count;
    record.rank = counting.rank;
    record.rattlers = static_cast<int>(inspection.rattlers.size());
    record.gap_residual = inspection.truth.stored_gap;
    return inspection;
}

Result<std::vector<Interval>> forces_at(State state, double sigma) {
    state.load.set_loaded_stress(sigma);
    Certification truth = certify(state);
    if (!truth.claims.vertex) {
        return Failure{truth.claims.counting ? FailureKind::undecided : FailureKind::not_isostatic,
                       truth.claims.undecided.front()};
    }
    return std::move(truth.finite);
}

} // namespace isostat
