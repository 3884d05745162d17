#include "motion/follower.hpp"

#include "contact/images.hpp"
#include "contact/words.hpp"
#include "core/dot.hpp"
#include "motion/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

// guess: all other numbers of this file: of the path follower (arcs.md, status.md 1)

namespace isostat {

namespace {

/// Relative accuracy of tangents. These only predict, choose the fastest
/// coordinate and locate dips and power turns; no sign depends on them.
constexpr double tangent_accuracy = 1e-7;
constexpr double turn_tangent_accuracy = 1e-15; ///< at a power turn, located only as well as its tangent
/// Required accuracy of such a tangent: factors of a nearly singular list may not reach a higher one.
constexpr double turn_tangent_error = 1e-8; // arcs.md Jump of the power
// arcs.md Jump of the power
constexpr double no_power = 1e-6;             ///< of the largest force of the load: accepted power at a turn
constexpr double end_tangent_accuracy = 1e-4; ///< at an event, where only dips and the sign of the power need it

} // namespace

Follower::Follower(const ArcOrigin& origin, const PowerLoad& power, CandidateList& candidates,
                   const ArcOptions& options, std::vector<Contact> open)
    : start_(origin.packing), opened_(origin.structure.contacts()[origin.opened.index()]), options_(options),
      chord_(origin.structure, origin.factorisation, origin.opened.index()),
      scan_(opened_, options, candidates, std::move(open)), power_(power),
      here_{origin.packing, chord_.mechanism(), {}, 0},
      step_limit_(options.step_fraction * origin.packing.min_radius()), noise_(16 * grid_step(origin.packing)),
      here_power_(power.starts_at_zero ? 0.0 : infinity) {
    for (double& c : here_.tangent) {
        c *= -origin.direction;
    }
    if (options.precisely) {
        chord_.be_precise();
    }
}

void Follower::begin() {
    if (chord_.is_precise()) {
        failure_ = sharpen();
    } else if (!chord_.is_fresh()) { // the mechanism is that of a neighbouring matrix
        here_.choose_fastest();
        if (auto t = chord_.tangent(here_.tangent, here_.fastest, end_tangent_accuracy)) {
            here_.tangent = std::move(*t);
        } else {
            failure_ = renew();
        }
    }
    if (!failure_) {
        predicted_ = predict();
    }
}

std::optional<ArcDeparture::Expected> Follower::expected() const {
    if (!predicted_ || !(event_.s <= step_limit_)) {
        return std::nullopt;
    }
    return ArcDeparture::Expected{event_.contact, here_.predicted(event_.s)};
}

/// Computes curvature and first event from `here_` and its tangent; false: `failure_` has the reason.
bool Follower::predict() {
    here_.choose_fastest();
    if (!std::isfinite(here_.tangent[here_.fastest])) {
        failure_ = Failure{FailureKind::not_converged, "the mechanism is not finite"};
        return false;
    }
    scan_.list(here_.at, chord_.contacts());
    here_.curvature =
        chord_.velocity([&](const Contact& c) { return quick_curvature(here_.at, c, here_.tangent); }, here_.fastest);
    event_ = scan_.first_event(here_, step_limit_, noise_, !moved_);
    return true;
}

Result<Arc> Follower::run() {
    if (failure_) {
        return *failure_;
    }
    while (steps_ < options_.max_steps) {
        auto ending = step();
        if (!ending.ok()) {
            return ending.failure();
        }
        if (ending.value()) {
            return std::move(*ending.value());
        }
    }
    return failed(FailureKind::unbounded, "no new contact after {} predictor steps", steps_);
}

/// The power is minus the force that opens; where that is small, only a sharper tangent gives its sign.
double Follower::power_at_start() {
    const double power = power_(here_.at, here_.tangent);
    if (power > 0 || power_.starts_at_zero()) {
        return power;
    }
    const auto t = chord_.tangent(here_.at, here_.tangent, here_.fastest, turn_tangent_accuracy);
    return t ? power_(here_.at, *t) : power;
}

/// One attempt at a step. Nothing: the arc goes on, from the end of the step or from the same point.
Follower::Ending Follower::step() {
    if (!predicted_ && !predict()) {
        return *failure_;
    }
    predicted_ = false;
    if (!(here_power_ < infinity)) {
        here_power_ = power_at_start();
    }
    ++steps_;
    Attempt attempt =
        reach(std::min({step_limit_ * pace_.shrink, scan_.longest_step(), pace_.for_dip, pace_.for_power}));
    if (!attempt.ok()) {
        return attempt.failure();
    }
    if (!attempt.value()) {
        return Ending(std::nullopt);
    }
    Reached& there = *attempt.value();
    const Result<bool> dips = dips_within(there);
    if (!dips.ok()) {
        return dips.failure();
    }
    if (dips.value()) {
        return Ending(std::nullopt);
    }
    const PowerSign sign = judge_power(there);
    if (sign == PowerSign::shorten) {
        return Ending(std::nullopt);
    }
    if (sign == PowerSign::unclear) {
        if (pace_.shrink < 1e-9) {
            return failed(FailureKind::undecided,
                          "the power of the load is {:.3g} where the arc starts and {:.3g} beyond: where it turns is "
                          "not known",
                          here_power_, there.power);
        }
        if (auto failure = narrow()) {
            return *failure;
        }
        return Ending(std::nullopt);
    }
    if (sign == PowerSign::turned) {
        auto turn = power_turn(there.s, there.power);
        return turn.ok() ? Ending(std::move(turn.value())) : Ending(turn.failure());
    }
    if (there.closing != nothing) {
        const Contact closed = options_.closes.value_or(there.closing);
        if (closed != there.closing && !converge_to(there.point.at, closed)) {
            return failed(FailureKind::not_converged, "the event at contact {} was not reached", named(closed));
        }
        return Ending(finish(std::move(there.point), ArcEnd::contact, closed, there.power));
    }
    if (auto failure = go_on(std::move(there))) {
        return *failure;
    }
    return Ending(std::nullopt);
}

/// True: a gap seems to dip within the step, which is to be repeated up to the dip at most.
Result<bool> Follower::dips_within(const Reached& there) {
    const auto dip = there.s > noise_ ? scan_.suspicious_dip({here_.at, there.point.at, there.s, there.closing},
                                                             there.point.tangent, noise_)
                                      : std::nullopt;
    if (!dip) {
        return false;
    }
    if (*dip < 1e-9 * step_limit_) {
        return Failure{FailureKind::undecided, "a gap touches zero inside an arc and cannot be told from a contact"};
    }
    pace_.for_dip = std::max(*dip, 0.05 * there.s);
    if (there.closing != nothing && !(pace_.for_dip < event_.s)) {
        pace_.for_dip = 0.5 * event_.s; // else the same event would be met again and again
    }
    return true;
}

/// The event, if it is predicted or found within this length; else the end of a step of this length.
Follower::Attempt Follower::reach(double longest) {
    if (event_.s <= longest) {
        return reach_event(event_, longest);
    }
    auto point = step_to(longest, tangent_accuracy);
    if (!point) {
        if (pace_.shrink < 1e-9) {
            return Failure{FailureKind::not_converged, "the path could not be followed: steps became too short"};
        }
        if (auto failure = narrow()) {
            return *failure;
        }
        return Attempt(std::nullopt);
    }
    if (const auto violation = scan_.first_violation({here_.at, point->at, longest, nothing}, noise_)) {
        return reach_event(*violation, longest);
    }
    return Attempt(Reached{std::move(*point), longest, nothing});
}

/// The place where the gap of an event closes, or the gap of another event that closes before.
Follower::Attempt Follower::reach_event(GapEvent event, double longest) {
    for (int attempt = 0; attempt < 40; ++attempt) {
        Packing at = here_.predicted(event.s);
        if (!converge_to(at, event.contact)) {
            break;
        }
        const double reached = here_.direction() * (at.q[here_.fastest] - here_.at.q[here_.fastest]);
        if (!(reached >= -noise_) || reached > 1.5 * std::max(longest, event.s) + noise_) {
            break; // another root
        }
        if (!moved_ && scan_.leaves(event.contact) && reached < 0.25 * event.s) {
            break; // the start itself, where the opening gap is zero too
        }
        const double s = std::max(reached, 0.0);
        if (s > noise_) {
            if (const auto violation = scan_.first_violation({here_.at, at, s, event.contact}, noise_)) {
                event = *violation;
                continue;
            }
        }
        auto point = tangent_at_event(std::move(at), s, event.contact);
        if (!point) {
            break;
        }
        return Attempt(Reached{std::move(*point), s, event.contact});
    }
    return shorten_before(event, longest);
}

/// The direct solve failed: renews the factors, and shortens the step when that does not help. Before a gap that nearly
/// grazes the step shrinks to 0, because the gap is 0 to rounding while it still falls. Then the arc ends here, and the
/// caller computes the end with more digits.
Follower::Attempt Follower::shorten_before(const GapEvent& event, double longest) {
    if (longest < 1e-12 * step_limit_ || pace_.shrink < 1e-9) {
        if (moved_ && std::abs(quick_gap(here_.at, event.contact)) <= noise_) {
            return Attempt(Reached{{here_.at, here_.tangent}, 0, event.contact});
        }
        return failed(FailureKind::not_converged, "the event at contact {} was not reached", named(event.contact));
    }
    if (pace_.renewed) {
        pace_.shrink = std::min(pace_.shrink, event.s / step_limit_) * 0.25;
        return Attempt(std::nullopt);
    }
    if (auto failure = renew()) {
        return *failure;
    }
    pace_.renewed = true;
    return Attempt(std::nullopt);
}

std::optional<CurvePoint> Follower::step_to(double s, double accuracy) {
    Packing at = here_.predicted(s);
    Vector off = at.q;
    if (!chord_.converge(at, Contact{ContactKind::held, static_cast<int>(here_.fastest), 0})) {
        return std::nullopt;
    }
    std::transform(at.q.begin(), at.q.end(), off.begin(), off.begin(), std::minus<>());
    // A start is on the curve up to its last bits only: the allowance of 1e-10 keeps a short step from counting the
    // correction to the curve as a bend.
    if (!(largest(off) <= 0.2 * s + 1e-10 * at.min_radius())) {
        return std::nullopt; // another branch, or a curve too bent for this step
    }
    auto t = chord_.tangent(at, here_.tangent, here_.fastest, accuracy);
    if (!t || !(largest(*t) <= 4)) {
        return std::nullopt; // another coordinate became much faster: shorter steps re-choose it in time
    }
    return CurvePoint{std::move(at), std::move(*t)};
}

bool Follower::converge_to(Packing& at, const Contact& closing) {
    const bool converged = chord_.converge(at, closing);
    if (converged) {
        snap_to_grid(at);
    }
    return converged;
}

/// The point with the tangent that the event needs: solved for where
/// an extrapolation does not decide a dip or the sign of the power.
std::optional<CurvePoint> Follower::tangent_at_event(Packing at, double s, const Contact& closing) {
    if (options_.extrapolate_tangent) {
        Vector t = here_.extrapolated_tangent(at, s, 1e-5 * step_limit_);
        const double power = power_(here_.at, here_.tangent);
        if (power_(at, t) > 0.1 * std::abs(power) && !scan_.suspicious_dip({here_.at, at, s, closing}, t, noise_)) {
            return CurvePoint{std::move(at), std::move(t)};
        }
    }
    auto t = chord_.tangent(at, here_.tangent, here_.fastest, end_tangent_accuracy);
    return t ? std::optional(CurvePoint{std::move(at), std::move(*t)}) : std::nullopt;
}

/// Judges the step by the power at its end.
Follower::PowerSign Follower::judge_power(Reached& there) {
    CurvePoint& point = there.point;
    there.power = power_(point.at, point.tangent);
    // At a limit load the power grows from zero: over the first, possibly
    // tiny, step its sign is decided by the force in the new contact.
    const bool judged = !power_.starts_at_zero() || moved_;
    const bool long_enough = there.s > 1e-6 * step_limit_;
    if (judged && (there.power < 0 || options_.sharp_power)) { // recheck, as a turn at the very end is no turn
        if (auto t = chord_.tangent(point.at, here_.tangent, here_.fastest, turn_tangent_accuracy)) {
            point.tangent = std::move(*t);
            there.power = power_(point.at, point.tangent);
        }
    }
    if (!judged && there.power < 0 && long_enough) {
        pace_.for_dip = 0.25 * there.s; // the power may have grown and turned within the step
        return PowerSign::shorten;
    }
    if (there.power > 0 && long_enough) {
        if (const auto dip = power_.dip(here_, chord_, {here_power_, there.power, there.s})) {
            pace_.for_power = std::min(pace_.for_power, 0.5 * *dip);
            return PowerSign::shorten;
        }
    }
    if (!(judged && there.power < 0)) {
        return PowerSign::positive;
    }
    if (here_power_ > 0) {
        return chord_.tangent_error() <= turn_tangent_error ? PowerSign::turned : PowerSign::unclear;
    }
    // A hold with multiplier 0 may be released to test whether its arc goes down, which its end decides.
    return opened_.kind == ContactKind::held ? PowerSign::positive : PowerSign::unclear;
}

/// The end where the power vanishes, within a step of length s at whose end the power is negative.
Result<Arc> Follower::power_turn(double s, double power) {
    SignChange bracket({0.0, here_power_}, {s, power});
    std::optional<CurvePoint> best;
    double smallest = infinity;
    for (int k = 0; k < 60; ++k) {
        const double tried = bracket.next();
        auto point = step_to(tried, turn_tangent_accuracy);
        if (!point) {
            return Failure{FailureKind::not_converged, "the point where the power of the load vanishes was not found"};
        }
        const double p = power_(point->at, point->tangent);
        if (std::abs(p) < std::abs(smallest) && chord_.tangent_error() <= turn_tangent_error) {
            smallest = p;
            best = std::move(point);
        }
        if (p == 0 || bracket.width() < 4 * grid_step(here_.at)) {
            break;
        }
        bracket.found({tried, p});
    }
    if (!best || !(std::abs(smallest) <= no_power * power_.largest_force(best->at))) {
        return failed(FailureKind::undecided,
                      "the power of the load changes its sign without vanishing: {:.3g} is the least that was met, the "
                      "motion is not the same on both sides",
                      smallest);
    }
    here_.tangent = best->tangent;
    here_.choose_fastest();
    snap_to_grid(best->at);
    return finish(std::move(*best), ArcEnd::power_turn, Contact{ContactKind::held, static_cast<int>(here_.fastest), 0},
                  smallest);
}

/// Makes the end of the step the start of the next one.
std::optional<Failure> Follower::go_on(Reached there) {
    moved_ = true;
    here_.at = std::move(there.point.at);
    here_.tangent = std::move(there.point.tangent);
    here_power_ = there.power;
    for (const Contact& pair : options_.assumed_touching) {
        constexpr double seen = 1e-10; // of a radius: far above the rounding of a length
        if (quick_gap(here_.at, pair) < -seen * here_.at.min_radius()) {
            return failed(FailureKind::undecided, "{} touch and were taken not to close, but overlap on the way",
                          named(pair));
        }
    }
    pace_.for_dip = infinity;
    pace_.renewed = false;
    if (chord_.iterations() > 10) {
        here_.choose_fastest();
        if (auto failure = renew()) {
            return failure;
        }
    }
    pace_.shrink = std::min(1.0, 2 * pace_.shrink);
    for (int a = 0; a < start_.dimension; ++a) {
        if (std::abs(here_.at.length(a) / start_.length(a) - 1) > options_.max_length_change) {
            return failed(FailureKind::unbounded, "the motion has no end: L along axis {} went from {} to {}", a,
                          start_.length(a), here_.at.length(a));
        }
    }
    for (std::size_t k = start_.length_at(start_.axes()); k < start_.q.size(); ++k) { // tilts
        if (std::abs(here_.at.q[k] - start_.q[k]) > options_.max_length_change * start_.length(0)) {
            return failed(FailureKind::flows, "the motion has no end: the tilt went from {} to {}", start_.q[k],
                          here_.at.q[k]);
        }
    }
    if (here_.at.cell.any()) { // before the list of candidates would refuse the configuration
        if (const auto beyond = disk_beyond(here_.at, here_.at.min_radius(), farthest_disk_of_a_run)) {
            return Failure{FailureKind::undecided, "too far for lists of pairs: " + *beyond};
        }
    }
    return std::nullopt;
}

/// Renews stale factors first, then shortens the step.
std::optional<Failure> Follower::narrow() {
    if (chord_.iterations() > 12 || pace_.shrink < 0.3) {
        if (auto failure = renew()) {
            return failure;
        }
    }
    pace_.shrink *= 0.25;
    return std::nullopt;
}

/// The factors of the start are stale: makes those of the structure that holds the fastest coordinate, here.
std::optional<Failure> Follower::renew() {
    if (auto failure = chord_.renew(here_.at, here_.fastest)) {
        return failure;
    }
    const double scale = here_.direction() / chord_.mechanism()[here_.fastest];
    here_.tangent = chord_.mechanism();
    for (double& c : here_.tangent) {
        c *= scale;
    }
    return chord_.is_precise() ? sharpen() : std::nullopt;
}

/// Solves for a tangent here as accurate as the rounding of the coordinates allows.
std::optional<Failure> Follower::sharpen() {
    here_.choose_fastest();
    auto t = chord_.tangent(here_.at, here_.tangent, here_.fastest, tangent_accuracy);
    if (!t) {
        return Failure{FailureKind::not_converged, "the mechanism was not found in double-double"};
    }
    here_.tangent = std::move(*t);
    return std::nullopt;
}

Arc Follower::finish(CurvePoint end, ArcEnd kind, const Contact& closed, double power) {
    Arc arc;
    for (std::size_t l = 0; l < chord_.contacts().size(); ++l) {
        const Contact& contact = chord_.contacts()[l];
        if (contact.kind == ContactKind::held && contact != opened_ && l != chord_.slot()) {
            const auto k = static_cast<std::size_t>(contact.i);
            end.at.q[k] = start_.q[k]; // a held coordinate keeps its value without rounding
        }
    }
    for (std::size_t k = start_.length_at(0); start_.cell.any() && k < end.at.q.size(); ++k) {
        if (chord_.dofs().dof_of(k) < 0) {
            end.at.q[k] =
                start_.q[k]; // fixed coordinates of a cell are not rounded: the vertex reports one off the grid
        }
    }
    for (std::size_t k = 0; k < end.at.q.size(); ++k) {
        arc.displacement = std::max(arc.displacement, std::abs(end.at.q[k] - start_.q[k]));
    }
    arc.end = std::move(end.at);
    arc.kind = kind;
    arc.closed = closed;
    arc.power = power;
    arc.tangent = std::move(end.tangent);
    arc.open = scan_.open_at_end(closed);
    arc.steps = steps_;
    arc.factorisations = chord_.factorisations();
    arc.passes = chord_.passes();
    return arc;
}

} // namespace isostat
