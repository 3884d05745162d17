#include "contact/candidates.hpp"
#include "core/refuse.hpp"
#include "exact/rank.hpp"
#include "linear/factorisation.hpp"
#include "packing/load_faults.hpp"

#include <isostat/rigidity/counting.hpp>
#include <isostat/scene/scene.hpp>

#include <fmt/format.h>

#include <cmath>

namespace isostat {

namespace {

/// Names, for a message, the contacts of one self-stress for each contact that depends on earlier contacts.
std::string self_stresses(const State& state) {
    const DofMap dofs(state.packing);
    const std::vector<int> independent =
        exact::independent_columns(exact_contact_matrix(state.packing, dofs, state.contacts));
    std::vector<Contact> kept;
    for (const int l : independent) {
        kept.push_back(state.contacts[static_cast<std::size_t>(l)]);
    }
    const auto structure = IsostaticStructure::prove(state.packing, kept);
    if (!structure.ok()) {
        return {};
    }
    const Factorisation factorisation(structure.value());
    std::string text;
    for (std::size_t l = 0, next = 0; l < state.contacts.size(); ++l) {
        if (next < independent.size() && independent[next] == static_cast<int>(l)) {
            ++next;
            continue;
        }
        std::vector<double> force(kept.size(), 0.0); // a unit force in contact l, which the others balance
        gap_gradient(state.packing, state.contacts[l]).for_each_dof(dofs, [&](std::size_t dof, double value) {
            force[dof] += value;
        });
        factorisation.solve_forces(force);
        text += fmt::format("{}{{{}", text.empty() ? "" : ", ", to_string(state.contacts[l], state.packing.dimension));
        for (std::size_t c = 0; c < kept.size(); ++c) {
            text += std::abs(force[c]) > 1e-9 ? " " + to_string(kept[c], state.packing.dimension) : "";
        }
        text += "}";
    }
    return text;
}

} // namespace

void check_start(const State& state, const std::string& source, bool hyperstatic_allowed) {
    validate(state.packing, source);
    require_pressed_sides(state.packing, state.load, true, source);
    if (const auto pair = fixed_overlap(state.packing)) {
        refuse(source, "{} overlap, and cannot move: expected every gap >= 0",
               to_string(*pair, state.packing.dimension));
    }
    // The value is far above the rounding of a vertex (1e-15) and far below any visible gap.
    const double visible = 1e-6 * state.packing.min_radius();
    const Admissibility admissible = certify_admissible(state.packing, visible);
    if (admissible.verdict == Verdict::refuted) {
        refuse(source,
               "grains overlap: the gap of {} is {:.6g}: expected every gap >= 0 (isostat snap makes the equilibrium "
               "next to soft grains)",
               to_string(admissible.worst, state.packing.dimension), admissible.worst_gap);
    }
    for (const Contact& contact : state.contacts) {
        const double opening = gap(state.packing, contact);
        if (std::abs(opening) > visible) {
            refuse(source, "the gap of the listed contact {} is {:.6g}: expected 0",
                   to_string(contact, state.packing.dimension), opening);
        }
    }
    const Counting count = count_contacts(state.packing, state.contacts);
    if (count.dof_count == 0) {
        refuse(source, "N_f = 0: there are no degrees of freedom: expected a grain that can move");
    }
    if (count.hyperstaticity > 0 && count.mechanisms == 0) {
        if (hyperstatic_allowed) {
            return;
        }
        const std::string basis = self_stresses(state);
        refuse(source,
               "N_f = {} degrees of freedom, N = {} contacts, rank {}: h = {}, k = 0: a trajectory starts from an "
               "isostatic structure, N = N_f = rank; ties = \"choose\" in [run] keeps the contacts that carry the load "
               "when the radii change a little{}{}",
               count.dof_count, count.contact_count, count.rank, count.hyperstaticity,
               basis.empty() ? "" : "; a basis of the self-stresses is in the contacts ", basis);
    }
    if (count.hyperstaticity != 0 || count.mechanisms != 0) {
        refuse(source,
               "N_f = {} degrees of freedom, N = {} contacts, rank {}: h = {}, k = {}: a trajectory starts from an "
               "isostatic structure, N = N_f = rank (h = k = 0)",
               count.dof_count, count.contact_count, count.rank, count.hyperstaticity, count.mechanisms);
    }
}

} // namespace isostat
