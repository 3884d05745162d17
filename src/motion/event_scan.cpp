#include "motion/event_scan.hpp"

#include "contact/candidates.hpp"
#include "contact/contact_set.hpp"
#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "motion/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

// guess: all other numbers of this file: of the path follower (arcs.md, status.md 1)

namespace isostat {

namespace {

using roundoff::infinity;

/// Smallest positive root of h + h1 s + h2 s^2 / 2, h >= 0; infinity when there is none.
double first_root(double h, double h1, double h2) {
    const double a = 0.5 * h2;
    const double discriminant = h1 * h1 - 4 * a * h;
    if (discriminant < 0) {
        return infinity;
    }
    if (h1 < 0) {
        return 2 * h / (-h1 + std::sqrt(discriminant));
    }
    return a < 0 ? (h1 + std::sqrt(discriminant)) / (-2 * a) : infinity;
}

/// A gap over a step of length s: the cubic with these values and slopes at the two ends.
struct Cubic {
    double h0, d0, h1, d1, s;

    /// Bounds from the control points: the cubic is at least the smallest and at most the largest of these.
    [[nodiscard]] double floor() const {
        return std::min(std::min(h0, h1), std::min(h0 + d0 * s / 3, h1 - d1 * s / 3));
    }
    [[nodiscard]] double ceiling() const {
        return std::max(std::max(h0, h1), std::max(h0 + d0 * s / 3, h1 - d1 * s / 3));
    }
    struct Point {
        double position, value;
    };
    /// The minimum. \pre d0 < 0 < d1
    [[nodiscard]] Point lowest() const {
        const double c3 = (d0 + d1) * s - 2 * (h1 - h0);
        const double c2 = 3 * (h1 - h0) - (2 * d0 + d1) * s;
        const double c1 = d0 * s;
        // c1 + 2 c2 x + 3 c3 x^2 changes sign once on [0, 1]: bisection.
        double low = 0;
        double high = 1;
        for (int k = 0; k < 40; ++k) {
            const double x = 0.5 * (low + high);
            (c1 + x * (2 * c2 + 3 * c3 * x) < 0 ? low : high) = x;
        }
        return {low * s, h0 + low * (c1 + low * (c2 + low * c3))};
    }
    /// The place where the cubic comes so near 0 that the gap may touch 0.
    [[nodiscard]] std::optional<double> dip() const {
        // `depth` below is at most max - floor, and x^2 (1 - x)^2 is at most 1/16: most gaps are far from a dip.
        if (floor() > 0.1 * (std::max(h0, h1) - floor())) {
            return std::nullopt;
        }
        // The error of the cubic at x is x^2 (1 - x)^2 h/24 (x in units of the step);
        // h is taken as 40 depths, far above that of a disk rolling through a step of
        // a tenth of a radius. It vanishes at the ends, where the gap is known.
        const Point low = lowest();
        const double depth = std::max(h0, h1) - low.value;
        const double x = low.position / s;
        return low.value <= 1.6 * depth * x * x * (1 - x) * (1 - x) ? std::optional(low.position) : std::nullopt;
    }
};

/// Factor by which a separation can change faster than that of two disks when no coordinate is faster than 1: the image
/// of a disk moves with the cell too.
double image_weight(const Contact& contact) {
    const auto& m = contact.image.m;
    return contact.image.is_here() ? 1.0 : 1 + 0.5 * (std::abs(m[0]) + std::abs(m[1]) + std::abs(m[2]));
}

bool listed(const std::vector<Contact>& list, const Contact& c) {
    return std::find(list.begin(), list.end(), c) != list.end();
}

} // namespace

double reach_left(const CandidateList& candidates, const Packing& at) {
    if (candidates.reference.size() != at.q.size()) {
        return -1;
    }
    if (at.cell.any()) {
        return 0.5 * candidates.reach - cell_drift(candidates, at).used;
    }
    return candidates.reach * (0.5 - candidates.moved_in_box(at));
}

double longest_step(const CandidateList& candidates, const Packing& at) {
    const double reach = reach_left(candidates, at);
    // Displacements are at most sqrt(d) s, and the corrector adds a little.
    const double root_dim = std::sqrt(static_cast<double>(at.dimension));
    if (!at.cell.any()) {
        return 0.9 * reach / (1.3 * root_dim);
    }
    const double in_cell = std::sqrt(static_cast<double>(at.axes() + at.tilts())); // coordinates of the cell
    return 0.9 * reach / (1.3 * in_cell * cell_drift(candidates, at).rate);
}

bool renew_candidates(CandidateList& candidates, const Packing& at) {
    if (reach_left(candidates, at) >= 0.25 * candidates.reach) {
        return false;
    }
    candidates = find_candidates(at, candidate_fraction, candidates.triangulation);
    return true;
}

EventScan::EventScan(const Contact& opened, const ArcOptions& options, CandidateList& candidates,
                     std::vector<Contact> open)
    : opened_(opened), leaving_(options.leaving), touching_(options.kept_touching), candidates_(candidates),
      active_(std::move(open)) {
    touching_.insert(touching_.end(), options.assumed_touching.begin(), options.assumed_touching.end());
    if (!active_.empty()) {
        complete();
    }
}

void EventScan::list(const Packing& at, const std::vector<Contact>& kept) {
    if (renew_candidates(candidates_, at)) {
        active_.clear();
    }
    longest_ = isostat::longest_step(candidates_, at);
    if (active_.empty()) {
        const ContactSet contacts(kept, at.disk_count());
        active_.reserve(candidates_.contacts.size());
        std::copy_if(candidates_.contacts.begin(), candidates_.contacts.end(), std::back_inserter(active_),
                     [&](const Contact& c) { return !contacts.contains(c); });
        complete();
    }
}

/// The open candidates that take part, and the contact that opens, which may close again.
void EventScan::complete() {
    std::erase_if(active_, [&](const Contact& c) { return c == opened_ || listed(touching_, c); });
    if (opened_.kind != ContactKind::held) {
        active_.push_back(opened_);
    }
}

GapEvent EventScan::first_event(const CurveCourse& course, double longest, double noise, bool at_start) {
    gap_.resize(active_.size());
    rate_.resize(active_.size());
    GapEvent first;
    // Roots beyond the longest step are not needed: |t| <= 1 in every
    // coordinate, so that no second derivative of a gap is larger than this.
    const double root_dim = std::sqrt(static_cast<double>(course.at.dimension));
    const double bend =
        1.01 * (2 * root_dim * largest(course.curvature) + 2 * course.at.dimension / course.at.min_radius());
    const double of_disks = 0.5 * bend * longest * longest;
    for (std::size_t c = 0; c < active_.size(); ++c) {
        const bool opening = at_start && leaves(active_[c]);
        if (const auto line = centre_line(course.at, active_[c]); line && !opening) {
            gap_[c] = gap_of(course.at, active_[c], *line);
            rate_[c] = rate_of(course.at.layout(), *line, active_[c], course.tangent);
            const double weight = image_weight(active_[c]);
            if (gap_[c] + std::min(1.01 * rate_[c], 0.0) * longest > of_disks * weight * weight) {
                continue;
            }
        }
        const GapCourse gap = gap_course(course.at, active_[c], course.tangent, course.curvature);
        gap_[c] = opening ? 0.0 : gap.value;
        // A touching pair that separates by its second derivative: its rate is 0 but for rounding. Not the opening
        // contact, whose rate shows when the motion began in the wrong direction.
        const bool parts = opening && active_[c] != opened_;
        rate_[c] = parts ? std::max(gap.rate, 0.0) : gap.rate;
        double root = first_root(std::max(gap_[c], 0.0), rate_[c], gap.bend);
        if (gap_[c] <= 0 && !(rate_[c] > 0) && !(parts && gap.bend > 0)) {
            root = 0;
        }
        // 0 to rounding, and the step does not bring the gap below 0: double cannot resolve its course.
        if (gap_[c] <= noise && first_root(std::max(gap_[c], 0.0) + noise, rate_[c], gap.bend) > longest) {
            root = infinity;
        }
        if (root < first.s) {
            first = {active_[c], root};
        }
    }
    return first;
}

std::optional<GapEvent> EventScan::first_violation(const Step& step, double noise) const {
    std::optional<GapEvent> found;
    double moved = 0;
    for (std::size_t k = 0; k < step.to.q.size(); ++k) {
        moved = std::max(moved, std::abs(step.to.q[k] - step.from.q[k]));
    }
    // A gap changes by at most the motion of its grains, or of its grain and wall.
    const double within = 2.01 * std::sqrt(static_cast<double>(step.to.dimension)) * moved;
    for (std::size_t c = 0; c < active_.size(); ++c) {
        if (gap_[c] > within * image_weight(active_[c]) || active_[c] == step.closing) {
            continue;
        }
        const double h = quick_gap(step.to, active_[c]);
        if (h < -noise) {
            const double bend = 2 * (h - gap_[c] - rate_[c] * step.s) / (step.s * step.s);
            const double root = std::min(first_root(gap_[c], rate_[c], bend), step.s);
            if (!found || root < found->s) {
                found = {active_[c], root};
            }
        }
    }
    return found;
}

std::optional<double> EventScan::suspicious_dip(const Step& step, const std::vector<double>& tangent,
                                                double noise) const {
    std::optional<double> where;
    for (std::size_t c = 0; c < active_.size(); ++c) {
        if (!(rate_[c] < 0) || active_[c] == step.closing) {
            continue;
        }
        const double rate = gap_rate(step.to, active_[c], tangent);
        const double gap = quick_gap(step.to, active_[c]);
        const Cubic course{gap_[c], rate_[c], gap, rate, step.s};
        const bool grazes_at_event =
            step.closing.i >= 0 && std::abs(gap) <= noise && rate > 0 && course.lowest().value >= -noise;
        const bool still = course.floor() >= -noise && course.ceiling() <= noise; // a dip within rounding
        if (!(rate > 0) || grazes_at_event || still) {
            continue;
        }
        const auto dip = course.dip();
        if (dip && (!where || *dip < *where)) {
            where = dip;
        }
    }
    return where;
}

bool EventScan::leaves(const Contact& contact) const {
    return contact == opened_ || listed(leaving_, contact);
}

std::vector<Contact> EventScan::open_at_end(const Contact& closed) {
    if (!touching_.empty() || active_.empty()) {
        return {};
    }
    if (opened_.kind != ContactKind::held) {
        active_.pop_back();
    }
    std::erase(active_, closed);
    if (opened_.kind != ContactKind::held && opened_ != closed) {
        active_.insert(std::lower_bound(active_.begin(), active_.end(), opened_), opened_);
    }
    return std::move(active_);
}

} // namespace isostat
