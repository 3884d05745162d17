#include "motion/arc.hpp"

#include "motion/follower.hpp"

namespace isostat {

template <int Dim> struct ArcDeparture<Dim>::Implementation {
    Follower<Dim> follower;
};

template <int Dim>
ArcDeparture<Dim>::ArcDeparture(const ArcOrigin<Dim>& origin, const PowerLoad<Dim>& power,
                                CandidateList<Dim>& candidates, const ArcOptions& options, std::vector<Contact> open)
    : implementation_(new Implementation{Follower<Dim>(origin, power, candidates, options, std::move(open))}) {
    implementation_->follower.begin();
}
template <int Dim> ArcDeparture<Dim>::ArcDeparture(ArcDeparture&&) noexcept = default;
template <int Dim> ArcDeparture<Dim>::~ArcDeparture() = default;

template <int Dim> std::optional<typename ArcDeparture<Dim>::Expected> ArcDeparture<Dim>::expected() const {
    return implementation_->follower.expected();
}

template <int Dim> Result<Arc<Dim>> ArcDeparture<Dim>::follow() {
    return implementation_->follower.run();
}

template <int Dim>
Result<Arc<Dim>> follow_arc(const ArcOrigin<Dim>& origin, const PowerLoad<Dim>& power, CandidateList<Dim>& candidates,
                            const ArcOptions& options) {
    return ArcDeparture<Dim>(origin, power, candidates, options).follow();
}

template class ArcDeparture<2>;
template Result<Arc<2>> follow_arc<2>(const ArcOrigin<2>&, const PowerLoad<2>&, CandidateList<2>&, const ArcOptions&);

} // namespace isostat
