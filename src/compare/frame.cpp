#include "compare/frame.hpp"

#include "snap/force_split.hpp"

#include <fmt/format.h>

#include <limits>

namespace isostat::compare {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

PerAxis<double> strains_of(const Packing& packing, const Load& load) {
    PerAxis<double> out{};
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        const double length = load.reference_length[a];
        out[a] = (length - packing.length(static_cast<int>(a))) / length;
    }
    return out;
}

FrameResult begin(const Frame& frame, const Reading& reading) {
    FrameResult out = reading.result;
    out.frame = frame.number;
    out.timestep = frame.timestep;
    out.stress = frame.load.loaded_stress() / frame.scale;
    out.snapped = "none";
    out.distance = out.walls = out.rest = out.stiffness = out.downhill = out.self_stress = nan;
    out.strain = strains_of(frame.packing, frame.load);
    out.true_strain = {nan, nan, nan};
    return out;
}

void add_vertex(const Snap& snap, const Frame& frame, FrameResult& out) {
    out.snapped = "newton";
    out.distance = snap.distance;
    out.walls = snap.walls;
    out.true_strain = strains_of(snap.backbone.packing, frame.load);
}

/// The errors of the forces on a list with h > 0, and their differences from the vertex downhill.
void split(const SoftState& soft, const Reading& reading, const Snap& snapped, const Exchanged* downhill,
           FrameResult& out) {
    const bool surplus = out.counting.hyperstaticity > 0;
    if (!surplus && downhill == nullptr) {
        return;
    }
    const SurplusSplit split = split_surplus(soft, reading.forces, reading.mean, snapped, downhill);
    out.downhill = split.downhill;
    if (surplus) {
        out.rest = split.rest;
        out.self_stress = split.self_stress;
    }
}

/// Finds the vertex downhill of a list that is no equilibrium.
void try_exchange(const SoftState& soft, const Reading& reading, const Snap& snapped, JudgedFrame& out) {
    FrameResult& r = out.result;
    r.status = snapped.outcome == SnapOutcome::refuted ? FrameStatus::refuted : FrameStatus::undecided;
    r.reason = snapped.reason;
    const int d = soft.packing.dimension;
    auto found = exchange(soft, 1);
    const bool proved = found.ok() && found.value().truth.verdict == Verdict::proved;
    split(soft, reading, snapped, proved ? &found.value() : nullptr, r);
    if (!found.ok()) {
        r.reason += "; no vertex downhill: " + found.failure().message(d);
        return;
    }
    Exchanged& e = found.value();
    if (!proved) {
        r.reason += "; the vertex downhill is not proved";
        return;
    }
    r.snapped = "exchange";
    r.distance = e.distance;
    if (snapped.outcome == SnapOutcome::undecided) {
        r.reason += "; a vertex downhill is proved, which may be another one";
    } else {
        r.status = FrameStatus::soft;
        r.reason += fmt::format("; the vertex downhill is proved, not that it is the only one near: without{}; with{}",
                                names_of(without(out.list, e.contacts), d), names_of(without(e.contacts, out.list), d));
    }
    out.downhill = std::move(e.contacts);
    out.state = std::move(e.state);
}

JudgedFrame judge(const Series& series, const Frame& frame, const Reading& reading, bool complete) {
    JudgedFrame out;
    out.result = begin(frame, reading);
    out.list = reading.contacts;
    out.pressed = reading.pressed;
    out.note = frame.note;
    FrameResult& r = out.result;
    if (!reading.contradiction.empty()) {
        r.status = FrameStatus::file;
        r.reason = reading.contradiction;
        return out;
    }
    const SoftState soft{frame.packing, reading.contacts, frame.load};
    if (!reading.other_load.empty() && reading.dashpots.empty() && snap(soft).outcome != SnapOutcome::moving) {
        r.status = FrameStatus::file;
        r.reason = reading.other_load;
        return out;
    }
    if (!(r.unbalanced <= series.rest)) {
        r.status = reading.blurred ? FrameStatus::undecided : FrameStatus::moving;
        r.reason = fmt::format(
            "a force of {:.3g} mean forces is left: expected at most {:.3g} at rest{}{}{}{}", r.unbalanced, series.rest,
            reading.blurred ? "; so much is within the digits of the files, overlaps have no more" : "",
            reading.dashpots.empty() ? "" : "; ", reading.dashpots, reading.few);
        return out;
    }
    if (!reading.dashpots.empty()) {
        r.status = FrameStatus::moving;
        r.reason = fmt::format("forces differ from the law by {:.3g} mean forces; {}", r.law, reading.dashpots);
        return out;
    }
    const Snap snapped = snap(soft);
    r.counting = snapped.counting;
    r.rattlers = static_cast<int>(snapped.rattlers.size());
    if (snapped.outcome == SnapOutcome::moving) {
        r.status = FrameStatus::moving;
        r.reason = snapped.reason;
        return out;
    }
    if (r.counting.hyperstaticity == 0) {
        const ForceSplit split = split_forces(soft, reading.forces, reading.mean, snapped);
        r.rest = split.rest;
        r.stiffness = split.stiffness;
    }
    if (snapped.outcome != SnapOutcome::vertex) {
        try_exchange(soft, reading, snapped, out);
        return out;
    }
    r.status = FrameStatus::same;
    add_vertex(snapped, frame, r);
    out.list = carrying(snapped);
    if (complete) {
        auto state = with_resting_rattlers(snapped, 1);
        if (state.ok()) {
            out.state = std::move(state.value());
        } else {
            r.reason = state.failure().message(frame.packing.dimension);
        }
    }
    return out;
}

} // namespace

Load over(Load load, double scale) {
    for (double& stress : load.stress) {
        stress /= scale;
    }
    return load;
}

JudgedFrame judge(const Series& series, const Frame& frame, bool complete) {
    const Reading reading = read_frame(series, frame);
    JudgedFrame out = judge(series, frame, reading, complete);
    FrameResult& r = out.result;
    if (out.state) {
        out.state->load = over(out.state->load, frame.scale);
    }
    const auto add = [&](const std::string& words) {
        r.reason += (r.reason.empty() || words.empty() ? "" : "; ") + words;
    };
    const bool list_matters = r.status == FrameStatus::soft || r.status == FrameStatus::refuted ||
                              (r.status == FrameStatus::moving && r.counting.mechanisms > 0);
    if (list_matters && !reading.unsure.empty()) {
        r.status = FrameStatus::undecided;
        add(reading.unsure);
    }
    add(reading.rounding);
    return out;
}

} // namespace isostat::compare
