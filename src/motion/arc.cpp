#include "motion/arc.hpp"

#include "motion/follower.hpp"

namespace isostat {

struct ArcDeparture::Implementation {
    Follower follower;
};

ArcDeparture::ArcDeparture(const ArcOrigin& origin, const PowerLoad& power, CandidateList& candidates,
                           const ArcOptions& options, std::vector<Contact> open)
    : implementation_(new Implementation{Follower(origin, power, candidates, options, std::move(open))}) {
    implementation_->follower.begin();
}
ArcDeparture::ArcDeparture(ArcDeparture&&) noexcept = default;
ArcDeparture::~ArcDeparture() = default;

std::optional<ArcDeparture::Expected> ArcDeparture::expected() const {
    return implementation_->follower.expected();
}

Result<Arc> ArcDeparture::follow() {
    return implementation_->follower.run();
}

Result<Arc> follow_arc(const ArcOrigin& origin, const PowerLoad& power, CandidateList& candidates,
                       const ArcOptions& options) {
    return ArcDeparture(origin, power, candidates, options).follow();
}

} // namespace isostat
