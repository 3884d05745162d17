// Complete states: rattlers brought to rest, and vertices at the end of a descent.
#include "snap/backbone.hpp"
#include "snap/nearest_vertex.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace isostat::compare {

namespace {

/// Presses the grains of the list that have a contact without force to all of their contacts.
void press(const Snap& snap, State& state) {
    const std::vector<unsigned char>& zero = snap.truth.structural_zero;
    const std::size_t d = state.packing.axes();
    const std::vector<double> resting = resting_loads(state.packing, state.contacts, 1);
    for (std::size_t l = 0; l < zero.size(); ++l) {
        const Contact c = renumbered(snap.backbone.contacts[l], snap.disks);
        for (const int i : {c.i, c.of_disks() ? c.j : c.i}) {
            const std::size_t at = d * static_cast<std::size_t>(i);
            if (zero[l] != 0) {
                std::copy_n(&resting[at], d, &state.load.infinitesimal[at]);
            }
        }
    }
    if (std::ranges::find(zero, 1) != zero.end()) {
        balance(state.load.infinitesimal, state.packing.cell);
    }
}

Failure other_list(const std::vector<Contact>& list, const std::vector<Contact>& found, int dimension) {
    return {FailureKind::undecided,
            fmt::format("other contacts carry a force when the rattlers rest: without{}; with{}",
                        names_of(without(list, found), dimension), names_of(without(found, list), dimension))};
}

/// The programmes take stress times current lengths, while the forces are those of the load at the soft positions. In
/// space the programmes have one stress for all axes but the last: the mean. No claim says that it leads to the vertex.
void set_stresses(const SoftState& soft, PreparationOptions& options) {
    const std::size_t last = soft.packing.axes() - 1;
    PerAxis<double> stress{};
    double others = 0;
    for (std::size_t a = 0; a <= last; ++a) {
        stress[a] = soft.load.stress[a];
        for (std::size_t b = 0; b <= last && soft.load.kind == LoadKind::nominal; ++b) {
            stress[a] = b == a ? stress[a]
                               : stress[a] * soft.load.reference_length[b] / soft.packing.length(static_cast<int>(b));
        }
        others += a < last ? stress[a] : 0;
    }
    options.stress = others / static_cast<double>(last);
    options.ratio = stress[last] / options.stress;
}

} // namespace

std::vector<Contact> carrying(const Snap& snap) {
    const std::vector<unsigned char>& zero = snap.truth.structural_zero;
    std::vector<Contact> out;
    for (std::size_t l = 0; l < snap.backbone.contacts.size(); ++l) {
        if (l >= zero.size() || zero[l] == 0) {
            out.push_back(renumbered(snap.backbone.contacts[l], snap.disks));
        }
    }
    std::ranges::sort(out);
    return out;
}

Result<State> with_resting_rattlers(const Snap& snap, std::uint64_t seed) {
    std::vector<double> infinitesimal = generic_infinitesimal(snap.packing.radius, seed, snap.packing.dimension);
    balance(infinitesimal, snap.packing.cell);
    return with_resting_rattlers(snap, std::move(infinitesimal));
}

Result<State> with_resting_rattlers(const Snap& snap, std::vector<double> infinitesimal) {
    State state;
    state.packing = snap.packing;
    (void)snap_to_grid(state.packing);
    state.load = snap.backbone.load;
    state.load.infinitesimal = std::move(infinitesimal);
    std::vector<Contact> list;
    for (const Contact& c : snap.backbone.contacts) {
        list.push_back(renumbered(c, snap.disks));
    }
    std::ranges::sort(list);
    state.contacts = list;
    press(snap, state);
    for (const int i : snap.rattlers) {
        for (int a = 0; a < state.packing.dimension; ++a) {
            state.contacts.push_back({ContactKind::held, state.packing.dimension * i + a, 0});
        }
    }
    const bool keeps_shape = std::exchange(state.packing.cell.keeps_shape, false); // rattlers move, the cell does not
    Segment rest;
    rest.equilibria = 0; // only the initial equilibrium
    RunCounters counters;
    RunObserver nobody;
    RunOptions options;
    options.max_strain = HUGE_VAL; // the load is constant and the reference lengths are arbitrary
    const SegmentOutcome outcome = run_segment(state, rest, 0, options, counters, nobody);
    if (outcome.failure) {
        return Failure{outcome.failure->kind,
                       "rattlers do not come to rest: " + outcome.failure->message(state.packing.dimension)};
    }
    state.packing.cell.keeps_shape = keeps_shape;
    state.equilibrium = 0;
    const std::vector<Contact> found = carrying(state);
    list = carrying(snap);
    if (found != list) {
        return other_list(list, found, state.packing.dimension);
    }
    return state;
}

Result<Exchanged> exchange(const SoftState& soft, std::uint64_t seed) {
    if (soft.load.shear != PerTilt<double>{}) {
        return Failure{FailureKind::undecided, "the linear programmes know no shear stress"};
    }
    PreparationOptions options;
    options.seed = seed;
    options.load = soft.load.kind;
    set_stresses(soft, options);
    auto vertex = state_downhill(soft.packing, options);
    if (!vertex.ok()) {
        return vertex.failure();
    }
    Exchanged out;
    out.state = std::move(vertex.value());
    const std::vector<double> infinitesimal = out.state.load.infinitesimal;
    out.state.load = soft.load;
    out.state.load.infinitesimal = infinitesimal;
    out.truth = certify(out.state);
    out.contacts = carrying(out.state, out.truth);
    out.distance = moves_to(out.state, out.truth, soft.packing.q).backbone;
    return out;
}

} // namespace isostat::compare
