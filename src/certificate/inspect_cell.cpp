#include <isostat/certificate/inspect_cell.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace isostat {

namespace {

/// An isostatic equilibrium has no mechanism while its own cell moves, so none while the cell stays; and it has too few
/// contacts for a cell that strains in more ways (C5, C6).
template <int Dim> void judge(const State<Dim>& state, CellInspection& out) {
    const auto moving =
        std::count(state.packing.cell.period_moves.begin(), state.packing.cell.period_moves.end(), true) +
        std::count(state.packing.cell.tilt_moves.begin(), state.packing.cell.tilt_moves.end(), true);
    const int missing = strain_count<Dim>(Strain::full) - static_cast<int>(moving);
    out.collective = {Verdict::proved, "positive forces, and no mechanism: k = 0 at the true vertex"};
    out.local = {Verdict::proved, "it is jammed collectively"};
    if (missing > 0) {
        out.strict = {Verdict::refuted,
                      fmt::format("N is {} short of N_f for full strain: a strain of the cell keeps every contact from "
                                  "closing while the volume does not grow",
                                  missing)};
    } else {
        out.strict = {Verdict::undecided, "k = 0 for full strain; whether some positive self-stress is an isotropic "
                                          "pressure is not decided"};
    }
}

} // namespace

template <int Dim> CellInspection inspect_cell(const State<Dim>& state, const Certification& truth) {
    assert(state.packing.cell.all());
    CellInspection out;
    out.all = count_strains(state.packing, state.contacts);
    const bool equilibrium = truth.claims.vertex && truth.claims.forces && truth.claims.gaps;
    const auto& on_disks = state.load.disk_force;
    const bool loaded = std::any_of(on_disks.begin(), on_disks.end(), [](double f) { return f != 0; });
    if (!equilibrium || loaded) {
        const Answer unknown{Verdict::undecided, loaded ? "forces on disks: no self-stress is known"
                                                        : "no equilibrium of this state is proved: the counts alone do "
                                                          "not tell"};
        out.local = out.collective = out.strict = unknown;
        return out;
    }
    std::vector<Contact> carrying;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        if (truth.structural_zero[l] == 0) {
            carrying.push_back(state.contacts[l]);
        }
    }
    const std::vector<int> rattlers = untouched(state.packing.disk_count(), carrying);
    out.backbone_disks = state.packing.disk_count() - static_cast<int>(rattlers.size());
    if (out.backbone_disks > 0) {
        out.backbone = count_strains(without_disks(state.packing, rattlers), carrying);
        judge(state, out);
    }
    return out;
}

template CellInspection inspect_cell<2>(const State<2>&, const Certification&);

} // namespace isostat
