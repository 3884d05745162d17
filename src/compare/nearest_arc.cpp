#include "compare/path.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace isostat::compare {

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
        std::vector<Contact> lacking = without(contacts_, found.pressed), beside = without(found.pressed, contacts_);
        if (found.equilibrium < 0 || lacking.size() + beside.size() < found.lacking.size() + found.beside.size()) {
            found.equilibrium = equilibrium;
            found.arc = arc.arc;
            found.lacking = std::move(lacking);
            found.beside = std::move(beside);
        }
    }
    if (arc.kind != ArcKind::rattler && !arc.power_turn) {
        contacts_.insert(std::upper_bound(contacts_.begin(), contacts_.end(), arc.closed), arc.closed);
    }
}

void NearestArcs::tell(std::vector<JudgedFrame>& frames, int dimension) const {
    for (const Found& found : frames_) {
        const bool same = found.lacking.empty() && found.beside.empty();
        frames[found.frame].result.nearest_arc =
            found.equilibrium < 0 ? "the exact run has no arc"
                                  : fmt::format("arc {} on the way to equilibrium {}, {}", found.arc, found.equilibrium,
                                                same ? "the same contacts"
                                                     : "without" + names_of(found.lacking, dimension) + ", with" +
                                                           names_of(found.beside, dimension));
    }
}

} // namespace isostat::compare
