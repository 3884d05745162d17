#include "report/run_walk.hpp"

#include "checker/recorded_arc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace isostat {

namespace {

using namespace checker;

class Walk {
  public:
    Walk(const RunRecords& records, const WalkVisitor& visit) : records_(records), visit_(visit) {
        for (const EquilibriumLine& line : records.equilibria) {
            if (line.integer("previous") != line.integer("number") - 1) {
                branches_.insert(line.integer("previous"));
            }
        }
    }

    std::vector<std::string> go() {
        while (next_ < records_.events.size() && records_.events[next_].equilibrium == 0) {
            ++next_; // these arcs led to the start
        }
        for (const EquilibriumLine& line : records_.equilibria) {
            const int number = line.integer("number");
            if (number > 0) {
                begin(line.integer("previous"));
            }
            const std::size_t first = next_;
            while (next_ < records_.events.size() && records_.events[next_].equilibrium == number) {
                ++next_;
            }
            if (!rearrange({first, next_}, &line)) {
                return notes_;
            }
        }
        if (next_ < records_.events.size() && continues()) {
            (void)rearrange({next_, records_.events.size()}, nullptr);
        } else if (next_ < records_.events.size()) {
            notes_.push_back("the arcs after the last equilibrium");
        }
        return notes_;
    }

  private:
    struct Events {
        std::size_t first, end;
    };

    /// Restores the state at which a rearrangement starts.
    void begin(int previous) {
        if (here_ && here_->equilibrium == previous) {
            return;
        }
        forget();
        if (const auto kept = kept_.find(previous); kept != kept_.end()) {
            here_ = kept->second;
            return;
        }
        if (std::optional<StateFile> file = records_.stored(previous)) {
            here_ = std::move(file->state);
        }
    }

    void forget() {
        here_.reset();
        solver_.reset();
    }

    /// Whether the arcs after the last equilibrium start from the current state.
    [[nodiscard]] bool continues() const {
        const EventRecord& event = records_.events[next_];
        if (!here_ || records_.equilibria.empty() || event.arc != 1) {
            return false;
        }
        const EquilibriumLine& last = records_.equilibria.back();
        return event.stress == last.stress("_low") || event.stress == last.stress("_high");
    }

    /// Walks through the arcs of one rearrangement; `line`: the equilibrium at its end. False: stop.
    bool rearrange(Events events, const EquilibriumLine* line) {
        const std::optional<State> from = here_;
        for (std::size_t k = events.first; k < events.end && here_; ++k) {
            const EventRecord& event = records_.events[k];
            const State before = *here_;
            if (!step(event)) {
                notes_.push_back(fmt::format("equilibrium {} from its arc {} on", event.equilibrium, event.arc));
                forget();
                break;
            }
            const bool last = k + 1 == events.end && line != nullptr;
            if (last) {
                arrive(*line);
            }
            if (!visit_({*here_, &event, last ? line : nullptr, &before, &*from, false})) {
                return false;
            }
        }
        const bool visited = here_ && events.first < events.end;
        return line == nullptr || visited || stand(*line, from);
    }

    /// Visits an equilibrium without arcs, or with arcs that were not followed.
    bool stand(const EquilibriumLine& line, const std::optional<State>& from) {
        const int number = line.integer("number");
        bool relisted = false;
        if (!here_ || number == 0) {
            std::optional<StateFile> file = records_.stored(number);
            if (!file) {
                notes_.push_back(fmt::format("equilibrium {}", number));
                return true;
            }
            here_ = std::move(file->state);
            relisted = true;
        }
        arrive(line);
        return visit_({*here_, nullptr, &line, nullptr, from ? &*from : nullptr, relisted});
    }

    void arrive(const EquilibriumLine& line) {
        here_->equilibrium = line.integer("number");
        here_->load.set_loaded_stress(line.stress());
        if (branches_.contains(here_->equilibrium)) {
            kept_[here_->equilibrium] = *here_;
        }
    }

    bool step(const EventRecord& event) {
        const auto list = list_that_opens(*here_, event);
        if (!list) {
            return false;
        }
        if (here_->contacts != *list) {
            here_->contacts = *list;
            solver_.reset();
        }
        if (!solver_) {
            solver_ = std::make_shared<Solver>(Structure(here_->packing, here_->contacts), here_->packing.q);
        }
        here_->load.set_loaded_stress(event.stress);
        const ArcStart start{*here_, solver_};
        const std::optional<Opening> opening = opening_of(start, event);
        if (!opening) {
            return false;
        }
        const bool stays = // the arc has length O(eps): the contact changes and the positions do not
            std::ranges::any_of(event.ties, [](const TieRecord& tie) { return tie.what == "step"; });
        Followed followed;
        if (!stays) {
            followed = follow(start, event, *opening);
            if (!followed.end) {
                return false;
            }
            here_->packing.q = *followed.end;
        }
        here_->contacts[opening->contact] = *contact_named(event.closed, here_->packing);
        solver_ = followed.solver;
        return true;
    }

    const RunRecords& records_;
    const WalkVisitor& visit_;
    std::set<int> branches_; ///< equilibria from which later segments start
    std::map<int, State> kept_;
    std::size_t next_ = 0;
    std::optional<State> here_; ///< the current state; empty: not known
    std::shared_ptr<const Solver> solver_;
    std::vector<std::string> notes_;
};

} // namespace

std::vector<std::string> walk_run(const RunRecords& records, const WalkVisitor& visit) {
    return Walk(records, visit).go();
}

} // namespace isostat
