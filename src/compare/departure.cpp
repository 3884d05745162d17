#include "compare/path.hpp"
#include "snap/backbone.hpp"

#include <isostat/snap/snap.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace isostat::compare {

namespace {

/// The frames and equilibria before and after a departure.
class Diagnosis {
  public:
    Diagnosis(const Series& series, const std::vector<JudgedFrame>& frames, const Path& path, const Bundle& bundle,
              const CompareOptions& options)
        : series_(series), frames_(frames), path_(path), bundle_(bundle), options_(options) {}

    std::optional<Departure> run() {
        const auto find = [&](std::size_t from) {
            while (from < frames_.size() && (frames_[from].result.status == FrameStatus::same ||
                                             frames_[from].result.status == FrameStatus::moving)) {
                ++from;
            }
            return from;
        };
        const std::size_t to = find(0);
        if (to == frames_.size()) {
            return std::nullopt;
        }
        after_ = &frames_[to];
        out_.to = after_->result.frame;
        for (std::size_t k = 0; k < to; ++k) {
            if (frames_[k].result.status == FrameStatus::same) {
                before_ = &frames_[k];
                out_.from = before_->result.frame;
            }
        }
        out_.opened = after_->result.missing;
        out_.closed = after_->result.extra;
        if (!(file() || moving() || tie() || stiffness() || step() || choice())) {
            last();
        }
        return out_;
    }

  private:
    bool is(const char* reason, const std::string& words) {
        out_.reason = reason;
        out_.words = words;
        return true;
    }
    bool file() { return after_->result.status == FrameStatus::file && is("file", after_->result.reason); }

    bool moving() {
        for (const JudgedFrame* frame = before_ == nullptr ? frames_.data() : before_ + 1; frame != after_; ++frame) {
            const FrameResult& r = frame->result;
            if (r.status == FrameStatus::moving) {
                return is("moving",
                          fmt::format("the load went on while frame {} was in motion: {}", r.frame, r.reason));
            }
        }
        return false;
    }

    /// The exact run ends, or its decision depends on less than the distance from the grains to a rigid vertex: each
    /// contact that only the frame has is open there by less than this distance.
    bool tie() {
        const FrameResult& r = after_->result;
        if (r.expected < 0) {
            return !path_.end.empty() && is("tie", "the exact run ends before this load: " + path_.end);
        }
        if (r.counting.hyperstaticity > 0 || r.extra.empty()) {
            return false;
        }
        const PathEquilibrium& e = path_.equilibria[static_cast<std::size_t>(r.expected)];
        double widest = 0;
        for (const Contact& contact : r.extra) {
            widest = std::max(widest, gap(e.state.packing, contact));
        }
        return widest < r.distance &&
               is("tie",
                  fmt::format("in equilibrium {} the gaps of{} are {:.3g} at most, less than the way of the grains "
                              "to a rigid vertex, {:.3g}: which contact closes is not told at this stiffness",
                              e.number, names_of(r.extra, series_.dimension), widest, r.distance));
    }

    /// The equilibrium that both the run and the frame have before the departure; null: none.
    [[nodiscard]] const PathEquilibrium* common() const {
        return before_ == nullptr || before_->result.expected < 0
                   ? nullptr
                   : &path_.equilibria[static_cast<std::size_t>(before_->result.expected)];
    }
    [[nodiscard]] int direction() const {
        return before_ == nullptr || after_->result.stress >= before_->result.stress ? 1 : -1;
    }

    /// The frame's load separates the limit of the structure for rigid grains from the limit for soft grains.
    bool stiffness() {
        const Counting& counting = after_->result.counting;
        if (after_->result.status == FrameStatus::soft && counting.hyperstaticity > 0) {
            return is("stiffness",
                      fmt::format("{} contacts with a force for {} degrees of freedom: rigid grains close h = "
                                  "{} fewer",
                                  counting.contact_count, counting.dof_count, counting.hyperstaticity));
        }
        const PathEquilibrium* e = common();
        if (e == nullptr || !(series_.linear_stiffness() > 0)) {
            return false;
        }
        const auto soft =
            soft_limit(backbone_of(e->state, e->contacts), {e->low, e->high, direction()}, series_.linear_stiffness());
        const double exact = direction() > 0 ? e->high : e->low;
        if (!soft) {
            return false;
        }
        const double load = after_->result.stress;
        const bool soft_left = direction() * (load - soft->stress) > 0, exact_left = direction() * (load - exact) > 0;
        const std::string words = fmt::format(
            "equilibrium {} ends at {:.7g}, with stiffness {:.3g} at {:.7g} (predicted); {} needs a stiffness "
            "of {:.2g} for 1e-3",
            e->number, exact, series_.linear_stiffness(), soft->stress, to_string(e->opens, series_.dimension),
            e->stiffness_needed);
        return soft_left != exact_left && is("stiffness", words);
    }

    bool step() {
        const PathEquilibrium* e = common();
        const int limits = e == nullptr ? 0 : after_->result.expected - e->number;
        if (limits < 2) {
            return false;
        }
        RunOptions run;
        run.rule = options_.rule;
        const auto list = list_after(at(*e), after_->result.stress, true, run);
        return list.ok() && list.value() == after_->list &&
               is("step",
                  fmt::format("{} limits of the exact run in one step of the load; the run that jumps ends where "
                              "the frame is",
                              limits));
    }

    /// The common equilibrium at the load of the previous frame.
    [[nodiscard]] State at(const PathEquilibrium& e) const {
        State state = e.state;
        state.load.stress[static_cast<std::size_t>(state.load.loaded_axis)] = before_->result.stress;
        return state;
    }

    /// Some members of the bundle are at the equilibrium of the frame, at its load.
    bool choice() {
        const FrameStatus status = after_->result.status;
        if (status == FrameStatus::undecided || status == FrameStatus::refuted) {
            return false; // a member may have the same list, but the frame was not proved to be at that equilibrium
        }
        int here = 0, ended = 0;
        std::set<int> nodes;
        for (const BundleMember& member : bundle_.members) {
            const int node = member.at_load[static_cast<std::size_t>(after_ - frames_.data())];
            if (node >= 0) {
                ++ended;
                nodes.insert(node);
                here += node == after_->result.node ? 1 : 0;
            }
        }
        if (ended < 2) {
            return false;
        }
        members_ = fmt::format("{} exact runs (other rules of opening, rattlers that rest elsewhere) stand at {} "
                               "equilibria at this load, {} of them where the frame is",
                               ended, nodes.size(), here);
        return here > 0 && is("choice", members_);
    }

    void last() {
        const FrameResult& r = after_->result;
        std::string words = r.reason + (members_.empty() || r.reason.empty() ? "" : "; ") + members_;
        words = words.empty() ? "a proved equilibrium that the exact run does not have at this load; no bundle was made"
                              : words;
        (void)(r.status == FrameStatus::refuted     ? is("wrong", words)
               : r.status == FrameStatus::undecided ? is("undecided", words)
                                                    : is("dynamics", words));
    }

    const Series& series_;
    const std::vector<JudgedFrame>& frames_;
    const Path& path_;
    const Bundle& bundle_;
    const CompareOptions& options_;
    const JudgedFrame* before_ = nullptr;
    const JudgedFrame* after_ = nullptr;
    std::string members_;
    Departure out_;
};

} // namespace

std::optional<Departure> find_departure(const Series& series, const std::vector<JudgedFrame>& frames, const Path& path,
                                        const Bundle& bundle, const CompareOptions& options) {
    return Diagnosis(series, frames, path, bundle, options).run();
}

} // namespace isostat::compare
