#include <isostat/trajectory/trajectory.hpp>

#include "trajectory/record.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/motion/arc.hpp>

#include <fmt/format.h>

namespace isostat {

template <int Dim> Result<Inspection<Dim>> inspect_vertex(const State<Dim>& state) {
    InverseBoundCache cache;
    auto made = Vertex<Dim>::make(state.packing, state.contacts, state.load, cache);
    if (!made.ok()) {
        return made.failure();
    }
    Vertex<Dim>& vertex = *made.value();
    Inspection<Dim> inspection;
    inspection.rattlers = rattlers(vertex);
    inspection.forces = finite_forces(vertex, state.load);
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        inspection.structural_zero.push_back(vertex.statics.is_structural_zero(ContactId(l)) ? 1 : 0);
    }
    const double sigma = state.load.stress[static_cast<std::size_t>(state.load.loaded_axis)];
    auto gaps = vertex.check_gaps(find_candidates(state.packing, candidate_fraction));
    auto decision = decide_opening(vertex.statics, sigma, OpeningRule::most_negative, ContactId(), 0);
    const bool in_equilibrium = decision.ok() && !decision.value().opening;
    if (!gaps.ok()) {
        inspection.remark = gaps.failure().message;
    } else if (gaps.value().negative) {
        inspection.remark = fmt::format("{} overlap", to_string<Dim>(*gaps.value().negative));
    } else if (!decision.ok()) {
        inspection.remark = decision.failure().message;
    } else if (!in_equilibrium) {
        const Opening& opening = *decision.value().opening;
        inspection.remark = fmt::format("not an equilibrium: {}force {:.6g} in contact {}", opening.infinitesimal ? "infinitesimal " : "",
                                        opening.force.value, to_string<Dim>(state.contacts[opening.contact.index()]));
    }
    if (in_equilibrium) {
        auto described = describe(vertex, state.load);
        if (described.ok()) {
            inspection.record = described.value();
            inspection.equilibrium = inspection.remark.empty();
            inspection.record.verdict = inspection.equilibrium ? Verdict::proved : Verdict::undecided;
            inspection.record.decided_by = std::max(inspection.record.decided_by, decision.value().rung);
            inspection.record.margin = std::min(inspection.record.margin, decision.value().margin);
        } else if (inspection.remark.empty()) {
            inspection.remark = described.failure().message;
        }
    }
    EquilibriumRecord<Dim>& record = inspection.record;
    record.number = state.equilibrium;
    record.dof_count = vertex.structure.size();
    record.contact_count = vertex.structure.size();
    record.rank = vertex.structure.size();
    record.rattlers = static_cast<int>(inspection.rattlers.size());
    record.backbone = vertex.statics.backbone_count();
    record.gap_residual = vertex.enclosure.max_gap;
    record.sigma_min_bound = vertex.inverse.sigma_min;
    if (gaps.ok()) {
        record.min_gap = gaps.value().smallest;
        record.min_gap_contact = gaps.value().where;
    }
    return inspection;
}

template Result<Inspection<2>> inspect_vertex<2>(const State<2>&);

} // namespace isostat
