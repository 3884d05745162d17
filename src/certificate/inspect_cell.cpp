#include <isostat/certificate/inspect.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace isostat {

namespace {

/// N = N_f of full strain, h = k = 0: the forces under an isotropic pressure are unique, and say whether it is jammed
/// strictly (C7). They are those of the load at one value of the loaded stress, where the tilt bears no shear.
JammingAnswer strictly(const State<2>& state, const CertificateClaims& claims) {
    if (state.load.shear[0] != 0 || state.load.loads_tilt() || !claims.load_interval) {
        return {Verdict::undecided,
                "k = 0 for full strain; its forces under an isotropic pressure are not those of its "
                "load at any stress that was looked at"};
    }
    constexpr double rounded = 0x1p-48; // nine operations, each to 2^-53
    const auto loaded = static_cast<std::size_t>(state.load.loaded_axis);
    const std::size_t other = 1 - loaded;
    const auto stress_at = [&](double off) { // lengths of the true vertex: within the radius
        const double across = state.packing.lattice(other, other) + off;
        const double along = state.packing.lattice(loaded, loaded) - off;
        return state.load.stress[other] * state.load.reference_length[loaded] * across /
               (state.load.reference_length[other] * along);
    };
    const double low = stress_at(-claims.vertex->radius) * (1 - rounded);
    const double high = stress_at(claims.vertex->radius) * (1 + rounded);
    const LoadEndClaim& from = claims.load_interval->low;
    const LoadEndClaim& to = claims.load_interval->high;
    if (!(low > 0)) {
        return {Verdict::undecided, "k = 0 for full strain; the stress that is not changed is no pressure"};
    }
    if ((from.unbounded || from.stress.upper < low) && (to.unbounded || high < to.stress.lower)) {
        return {Verdict::proved, fmt::format("k = 0 for full strain, and every force of the backbone is positive under "
                                             "an isotropic pressure (sigma_{} = {:.12g})",
                                             loaded + 1, high)};
    }
    if ((!from.unbounded && high < from.stress.lower) || (!to.unbounded && low > to.stress.upper)) {
        return {Verdict::refuted, fmt::format("a force is negative under an isotropic pressure (sigma_{} = {:.12g}): "
                                              "its contact opens alone while the volume falls",
                                              loaded + 1, high)};
    }
    return {Verdict::undecided, "k = 0 for full strain; an isotropic pressure is at the end of the supported interval"};
}

/// An isostatic equilibrium has no mechanism while its own cell moves, so none while the cell stays; and it has too few
/// contacts for a cell that strains in more ways (C6, C7).
template <int Dim> void judge(const State<Dim>& state, const CertificateClaims& claims, CellInspection& out) {
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
        out.strict = strictly(state, claims);
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
        const JammingAnswer unknown{Verdict::undecided,
                                    loaded ? "forces on disks: no self-stress is known"
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
        judge(state, truth.claims, out);
    }
    return out;
}

template CellInspection inspect_cell<2>(const State<2>&, const Certification&);

} // namespace isostat
