// Complete states: rattlers at rest, and vertices downhill.
#include <isostat/certificate/certify.hpp>
#include <isostat/compare/snap.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isostat::compare {

namespace {

Failure other_list(const std::vector<Contact>& list, const std::vector<Contact>& found) {
    return {FailureKind::undecided,
            fmt::format("other contacts carry a force when the rattlers rest: without{}; with{}",
                        names_of(without(list, found)), names_of(without(found, list)))};
}

} // namespace

Result<State> with_resting_rattlers(const Snap& snap, std::uint64_t seed) {
    std::vector<double> infinitesimal = generic_infinitesimal(snap.packing.radius, seed);
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
    for (Contact c : snap.backbone.contacts) {
        c.i = snap.disks[static_cast<std::size_t>(c.i)];
        c.j = c.kind == ContactKind::disk_disk ? snap.disks[static_cast<std::size_t>(c.j)] : c.j;
        list.push_back(c);
    }
    std::sort(list.begin(), list.end());
    state.contacts = list;
    for (const int i : snap.rattlers) {
        state.contacts.push_back({ContactKind::held, 2 * i, 0});
        state.contacts.push_back({ContactKind::held, 2 * i + 1, 0});
    }
    const bool keeps_shape = std::exchange(state.packing.cell.keeps_shape, false); // rattlers move, the cell does not
    Segment rest;
    rest.equilibria = 0; // the start alone
    RunCounters counters;
    RunObserver nobody;
    const SegmentOutcome outcome = run_segment(state, rest, 0, {}, counters, nobody);
    if (outcome.failure) {
        return Failure{outcome.failure->kind, "rattlers do not come to rest: " + outcome.failure->message()};
    }
    state.packing.cell.keeps_shape = keeps_shape;
    state.equilibrium = 0;
    const std::vector<Contact> found = carrying(state);
    if (found != list) {
        return other_list(list, found);
    }
    return state;
}

Result<Exchanged> exchange(const SoftState& soft, std::uint64_t seed) {
    if (soft.load.shear[0] != 0) {
        return Failure{FailureKind::undecided, "the linear programmes know no shear stress"};
    }
    PreparationOptions options;
    options.seed = seed;
    options.load = soft.load.kind;
    // The programmes speak of stress times present length; the forces are those of the load at the soft place.
    const auto stress = [&](std::size_t a) {
        const auto other = static_cast<int>(1 - a);
        return soft.load.kind == LoadKind::nominal
                   ? soft.load.stress[a] * soft.load.reference_length[1 - a] / soft.packing.length(other)
                   : soft.load.stress[a];
    };
    options.stress = stress(0);
    options.ratio = stress(1) / stress(0);
    PreparationReport report;
    auto vertex = find_vertex(soft.packing, options, report);
    if (!vertex.ok() && !report.candidate) {
        return vertex.failure();
    }
    Exchanged out;
    out.state = vertex.ok() ? std::move(vertex.value()) : *report.candidate;
    const std::vector<double> infinitesimal = out.state.load.infinitesimal;
    out.state.load = soft.load;
    out.state.load.infinitesimal = infinitesimal;
    out.truth = certify(out.state);
    out.contacts = carrying(out.state, out.truth);
    const double radius = out.truth.claims.vertex ? out.truth.claims.vertex->radius : HUGE_VAL;
    constexpr double up = 1 + 0x1p-49;
    const auto way = [&](std::size_t k) {
        return (std::abs(out.state.packing.q[k] - soft.packing.q[k]) + radius) * up;
    };
    const auto measure = [&](int disk) {
        const auto i = static_cast<std::size_t>(disk);
        out.distance = std::max(out.distance, std::hypot(way(2 * i), way(2 * i + 1)) * up);
    };
    for (const Contact& c : out.contacts) {
        measure(c.i);
        if (c.kind == ContactKind::disk_disk) {
            measure(c.j);
        }
    }
    return out;
}

} // namespace isostat::compare
