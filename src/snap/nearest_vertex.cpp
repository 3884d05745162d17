#include "snap/nearest_vertex.hpp"

#include "contact/near_pairs.hpp"
#include "packing/bodies.hpp"
#include "snap/backbone.hpp"
#include "verified/to_vertex.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/rigidity/counting.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::compare {

namespace {

/// The strains that count the motions of the cell.
Strain strain_of(const Cell& cell) {
    return cell.keeps_shape ? Strain::isotropic : cell.tilt_moves[0] ? Strain::full : Strain::diagonal;
}

crafted::Plateau plateau_of(const Packing& packing, double rounding) {
    const double largest = nearly_touching * packing.min_radius();
    const double deepest = std::min(crafted::plateau(packing, {largest}).deepest_overlap, largest);
    return crafted::plateau(packing, deepest, largest, 1, strain_of(packing.cell), rounding);
}

} // namespace

SoftList list_of_plateau(const Packing& packing, double rounding) {
    const auto widest = plateau_of(packing, rounding).widest;
    return !widest
               ? list_up_to(packing, rounding)
               : SoftList{crafted::backbone_at(packing, widest->range.first),
                          fmt::format("the backbone at thresholds from {:.6g} to {:.6g}, the widest range of plateau",
                                      widest->range.first, widest->range.last)};
}

Result<SoftList> list_below(const Packing& packing, std::optional<double> threshold, double rounding) {
    const double largest = threshold.value_or(nearly_touching * packing.min_radius());
    if (threshold) {
        const crafted::PlateauStep step = crafted::plateau(packing, {largest}, strain_of(packing.cell)).steps.front();
        if (step.backbone.isostatic != Verdict::proved) {
            return Failure{
                step.backbone.isostatic == Verdict::refuted ? FailureKind::not_isostatic : FailureKind::undecided,
                fmt::format("at the threshold {} the backbone has N_f = {}, N = {}, h = {}, k = {}: expected "
                            "an isostatic one",
                            largest, step.backbone.dof_count, step.backbone.contact_count, step.backbone.hyperstaticity,
                            step.backbone.mechanisms)};
        }
        return SoftList{crafted::backbone_at(packing, largest), fmt::format("gaps up to {}", largest)};
    }
    crafted::Plateau plateau = plateau_of(packing, rounding);
    std::erase_if(plateau.ranges, [](const crafted::PlateauRange& range) { return !range.told; });
    if (plateau.ranges.empty()) {
        return Failure{plateau.special.empty() ? FailureKind::not_isostatic : FailureKind::undecided,
                       fmt::format("the backbone is isostatic at no threshold up to {:.6g}: isostat plateau shows the "
                                   "counts",
                                   largest)};
    }
    const auto range = *std::ranges::max_element(
        plateau.ranges, [&](const auto& x, const auto& y) { return plateau.width(x) < plateau.width(y); });
    return SoftList{
        crafted::backbone_at(packing, range.first),
        fmt::format("isostatic backbone at every threshold from {:.6g} to {:.6g}, proved", range.first, range.last)};
}

Result<State> state_downhill(const Packing& packing, const PreparationOptions& options) {
    PreparationReport report;
    auto vertex = find_vertex(packing, options, report);
    return !vertex.ok() && report.candidate ? std::move(*report.candidate) : std::move(vertex);
}

Result<NearestVertex> vertex_downhill(const SoftState& soft, std::uint64_t seed) {
    PreparationOptions options;
    options.seed = seed;
    options.stress = soft.load.stress[0];
    options.ratio = soft.load.stress[1] / soft.load.stress[0];
    options.load = soft.load.kind;
    auto vertex = state_downhill(soft.packing, options);
    if (!vertex.ok()) {
        return vertex.failure();
    }
    NearestVertex out;
    out.state = std::move(vertex.value());
    out.truth = certify(out.state);
    out.contacts =
        fmt::format("{} carry a force, as the nearest vertex has them", carrying(out.state, out.truth).size());
    return out;
}

Result<NearestVertex> vertex_of_list(SoftState soft, const std::string& words, std::uint64_t seed) {
    Snap snapped = compare::snap(soft);
    if (!snapped.disks.empty()) {
        soft.load.refer_to(snapped.backbone.packing);
    }
    snapped = compare::snap(soft);
    if (snapped.outcome != SnapOutcome::vertex) {
        const bool undecided = snapped.outcome == SnapOutcome::undecided;
        return Failure{undecided ? FailureKind::undecided : FailureKind::not_isostatic,
                       fmt::format("{}: the contacts of the file ({}) have no equilibrium near: {}",
                                   to_string(snapped.outcome), words, snapped.reason)};
    }
    auto state = with_resting_rattlers(snapped, seed);
    if (!state.ok()) {
        return state.failure();
    }
    NearestVertex out;
    out.state = std::move(state.value());
    out.truth = certify(out.state);
    out.contacts = fmt::format("{} carry a force, those of the file: {}", snapped.backbone.contacts.size(), words);
    return out;
}

SoftList list_up_to(const Packing& packing, double threshold) {
    const double reach = std::nextafter(std::max(threshold, 0.0), HUGE_VAL);
    SoftList out{isostat::near_contacts(packing, reach, reach), fmt::format("gaps up to {:.6g}", threshold)};
    std::erase_if(out.contacts, [&](const Contact& c) { return !(gap(packing, c) <= threshold); });
    std::ranges::sort(out.contacts);
    return out;
}

NearestVertex vertex_as_listed(const SoftState& soft, const std::string& words, std::uint64_t seed) {
    NearestVertex out;
    State& state = out.state;
    state.packing = soft.packing;
    state.contacts = with_bars(soft.contacts, soft.packing);
    state = with_free_motions_held(std::move(state));
    long steps = 0;
    constexpr double near = 0.1; // in smallest radii
    const auto failure = to_vertex(state.packing, state.contacts, steps, near * state.packing.min_radius());
    out.contacts =
        fmt::format("{}, {}{}{}", soft.contacts.size(), words, failure ? "; as they stand in the file: " : "",
                    failure ? failure->message(state.packing.dimension) : "");
    state.load = soft.load;
    state.load.refer_to(state.packing);
    if (state.packing.bars.empty()) { // the free motions of clumps are held in place
        state.load.infinitesimal = resting_loads(state.packing, state.contacts, seed);
    }
    out.truth = certify(state);
    return out;
}

Moves moves_to(const State& state, const Certification& truth, const std::vector<double>& from) {
    const Packing& packing = state.packing;
    const double radius = truth.claims.vertex ? truth.claims.vertex->radius : HUGE_VAL;
    constexpr double up = 1 + 0x1p-49; // covers the rounding of a difference and of a sum
    const auto way = [&](std::size_t k) { return (std::abs(packing.q[k] - from[k]) + radius) * up; };
    Moves moves;
    const std::size_t n = packing.radius.size();
    moves.rattler.assign(n, 0);
    for (const int rattler : untouched(packing.disk_count(), carrying(state, truth))) {
        moves.rattler[static_cast<std::size_t>(rattler)] = 1;
    }
    const std::size_t d = packing.axes();
    for (std::size_t i = 0; i < n; ++i) {
        moves.disk.push_back(distance_above(d, [&](std::size_t a) { return way(d * i + a); }));
        double& largest = moves.rattler[i] != 0 ? moves.rattlers : moves.backbone;
        largest = std::max(largest, moves.disk[i]);
    }
    for (std::size_t k = d * n; k < packing.q.size(); ++k) {
        moves.walls = std::max(moves.walls, way(k));
    }
    return moves;
}

} // namespace isostat::compare
