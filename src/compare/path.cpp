#include "compare/path.hpp"

#include "core/parallel.hpp"
#include "snap/backbone.hpp"

#include <isostat/snap/snap.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat::compare {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr int further = 3; ///< equilibria after the last load, because frames may be early

/// Keeps the equilibria with their lists; an equilibrium without arcs is the previous one at another load.
class Collector final : public RunObserver {
  public:
    Collector(std::vector<PathEquilibrium>& out, NearestArcs* arcs) : out_(out), arcs_(arcs) {}
    void on_arc(const ArcRecord& arc) override {
        if (arcs_ != nullptr) {
            arcs_->add(arc, static_cast<int>(out_.size()));
        }
    }
    void on_equilibrium(const EquilibriumRecord& record, const State& state,
                        const std::vector<double>& /*forces*/) override {
        if (arcs_ != nullptr) {
            arcs_->start(state);
        }
        if (!out_.empty() && record.arcs == 0) {
            return;
        }
        PathEquilibrium e;
        e.number = static_cast<int>(out_.size());
        e.stress = record.stress;
        e.strain = record.strain[static_cast<std::size_t>(state.load.loaded_axis)];
        e.low = record.stress_low;
        e.high = record.stress_high;
        e.arcs = record.arcs;
        e.proved = record.verdict == Verdict::proved;
        e.state = state;
        e.contacts = carrying(state);
        e.soft_limit = e.stiffness_needed = unknown;
        out_.push_back(std::move(e));
        highs_.push_back(record.opens_high);
        lows_.push_back(record.opens_low);
    }
    /// The contact that opens at the end in the direction of the load.
    [[nodiscard]] const Contact& opens(std::size_t k, int direction) const {
        return direction > 0 ? highs_[k] : lows_[k];
    }

  private:
    std::vector<PathEquilibrium>& out_;
    NearestArcs* arcs_;
    std::vector<Contact> highs_, lows_;
};

void predict(PathEquilibrium& e, int direction, double stiffness) {
    const ExactInterval exact{e.low, e.high, direction};
    if (!(stiffness > 0) || !std::isfinite(e.high) || !(e.low > 0)) {
        return;
    }
    const State backbone = backbone_of(e.state, e.contacts);
    if (const auto limit = soft_limit(backbone, exact, stiffness)) {
        e.soft_limit = limit->stress;
    }
    e.stiffness_needed = stiffness_needed(backbone, exact).value_or(unknown);
}

/// Runs along the loads, segment by segment.
class Follower {
  public:
    Follower(State state, const RunOptions& options, NearestArcs* arcs)
        : state_(std::move(state)), options_(options), collector_(path.equilibria, arcs) {}

    void run(const std::vector<double>& loads) {
        Segment start;
        start.equilibria = 0;
        if (const auto failure = advance(start)) {
            path.end = failure->message(state_.packing.dimension);
        }
        for (const double load : loads) {
            if (path.end.empty() && load != state_.load.loaded_stress()) {
                direction_ = load > state_.load.loaded_stress() ? 1 : -1;
                if (!directions_.empty()) {
                    directions_.back() = direction_;
                }
                Segment segment;
                segment.to_stress = load;
                if (const auto failure = advance(segment)) {
                    path.end = failure->message(state_.packing.dimension);
                }
            }
            path.at_load.push_back(path.end.empty() ? static_cast<int>(path.equilibria.size()) - 1 : -1);
        }
    }
    void run_on() {
        if (path.end.empty()) {
            Segment on;
            on.equilibria = further;
            (void)advance(on); // until the run ends
        }
    }
    void predict_limits(double stiffness) {
        parallel_pieces(path.equilibria.size(), [&](std::size_t k) {
            path.equilibria[k].opens = collector_.opens(k, directions_[k]);
            predict(path.equilibria[k], directions_[k], stiffness);
        });
    }

    Path path;

  private:
    std::optional<Failure> advance(Segment segment) {
        segment.direction = direction_;
        const SegmentOutcome outcome = run_segment(state_, segment, number_++, options_, counters_, collector_);
        directions_.resize(path.equilibria.size(), direction_);
        return outcome.failure;
    }

    State state_;
    const RunOptions& options_;
    Collector collector_;
    RunCounters counters_;
    std::vector<int> directions_;
    int direction_ = 1, number_ = 0;
};

} // namespace

NearestArcs::NearestArcs(const std::vector<JudgedFrame>& frames) {
    for (std::size_t k = 0; k < frames.size(); ++k) {
        if (frames[k].result.status == FrameStatus::moving) {
            frames_.push_back({k, frames[k].pressed, -1, 0, {}, {}});
        }
    }
}

void NearestArcs::start(const State& equilibrium) {
    contacts_ = carrying(equilibrium);
}

void NearestArcs::add(const ArcRecord& arc, int equilibrium) {
    std::erase(contacts_, arc.opened);
    for (Found& found : frames_) {
        std::vector<Contact> lacking = without(contacts_, found.pressed), extra = without(found.pressed, contacts_);
        if (found.equilibrium < 0 || lacking.size() + extra.size() < found.lacking.size() + found.extra.size()) {
            found.equilibrium = equilibrium;
            found.arc = arc.arc;
            found.lacking = std::move(lacking);
            found.extra = std::move(extra);
        }
    }
    if (arc.kind != ArcKind::rattler && !arc.power_turn) {
        contacts_.insert(std::ranges::upper_bound(contacts_, arc.closed), arc.closed);
    }
}

void NearestArcs::tell(std::vector<JudgedFrame>& frames, int dimension) const {
    for (const Found& found : frames_) {
        const bool same = found.lacking.empty() && found.extra.empty();
        frames[found.frame].result.nearest_arc =
            found.equilibrium < 0 ? "the exact run has no arc"
                                  : fmt::format("arc {} on the way to equilibrium {}, {}", found.arc, found.equilibrium,
                                                same ? "the same contacts"
                                                     : "without" + names_of(found.lacking, dimension) + ", with" +
                                                           names_of(found.extra, dimension));
    }
}

Path follow(State state, const std::vector<double>& loads, const RunOptions& options) {
    Follower follower(std::move(state), options, nullptr);
    follower.run(loads);
    return std::move(follower.path);
}

Path follow_beyond(State state, const std::vector<double>& loads, const RunOptions& options, double stiffness,
                   NearestArcs* arcs) {
    Follower follower(std::move(state), options, arcs);
    follower.run(loads);
    follower.run_on();
    follower.predict_limits(stiffness);
    return std::move(follower.path);
}

Result<std::vector<Contact>> list_after(State state, double sigma, bool jump, const RunOptions& options) {
    RunCounters counters;
    RunObserver nobody;
    Segment segment;
    segment.equilibria = 0;
    if (jump) {
        state.load.set_loaded_stress(sigma);
    } else if (sigma != state.load.loaded_stress()) {
        segment.equilibria.reset();
        segment.direction = sigma > state.load.loaded_stress() ? 1 : -1;
        segment.to_stress = sigma;
    }
    const SegmentOutcome outcome = run_segment(state, segment, 0, options, counters, nobody);
    if (outcome.failure) {
        return *outcome.failure;
    }
    return carrying(state);
}

} // namespace isostat::compare
