#include "trajectory/next_rearrangement.hpp"

#include <limits>

namespace isostat {

template <int Dim>
bool NextRearrangement<Dim>::begin(const Load<Dim>& load, const Segment& segment, const RunOptions& options,
                                   long step) {
    at_.load = load;
    const double stress = at_.stress();
    const InverseBound unknown;
    const Statics<Dim> statics(packing_, load, structure_, factorisation_, unknown);
    double smallest = std::numeric_limits<double>::infinity();
    for (int index = 0; index < structure_.size(); ++index) {
        const ContactId l(index);
        const double rate = segment.direction * statics.slope(l).value;
        if (rate < 0 && statics.force(l, stress).value / -rate < smallest) {
            smallest = statics.force(l, stress).value / -rate;
            opens_ = l;
        }
    }
    const double limit = stress + segment.direction * smallest;
    if (!opens_.valid() || (segment.to_stress && !(segment.direction * (limit - *segment.to_stress) < 0))) {
        return false;
    }
    at_.set_stress(limit);
    ArcStart<Dim> start;
    start.opening.contact = opens_;
    start.kind = ArcKind::limit;
    start.step = step;
    start.load = &at_.load;
    steering_ = std::make_unique<FloatingSteering<Dim>>(
        typename FloatingSteering<Dim>::Origin{packing_, structure_, factorisation_}, start, options,
        std::move(candidates_), false);
    return true;
}

template <int Dim> void NextRearrangement<Dim>::propose_ahead(const std::function<bool()>& enough) {
    const CountingIn counting(&work_);
    steering_->propose_ahead(enough);
}

template class NextRearrangement<2>;

} // namespace isostat
