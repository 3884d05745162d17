#include "motion/gap_watch.hpp"

#include "core/dot.hpp"
#include "motion/geometry.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <cmath>

// exact: all other numbers of this file: a half

namespace isostat {

namespace {

constexpr int max_depth = 60; // cost: halvings (arcs.md A5)

} // namespace

/// Relative position of the two grains of a candidate along p(s), and its uncertainty from the tube.
struct GapWatch::Motion {
    Motion(const CurvePiece& piece, const Contact& contact) {
        wall = !contact.of_disks();
        components = wall ? 1 : most_axes;
        target = touching_distance(piece.centre().radius, contact);
        a.push_back(separation_over(piece.centre().layout(), piece.centre().q, contact));
        for (const auto& coefficient : piece.coefficients()) {
            a.push_back(separation_over(piece.centre().layout(), coefficient, contact));
        }
        for (const auto& d : a) {
            size.push_back(std::sqrt(dot(d, d)) * upward);
        }
        const double weight = separation_weight(contact);
        apart = weight * (piece.radius() + piece.curve().rest_radius) * upward;
        slope_error = weight * piece.slope_error() * upward;
    }

    /// Bounds for s in [from, to].
    struct View {
        double gap_low = 0;  ///< gap > gap_low
        double gap = 0;      ///< at the middle
        double gap_open = 0; ///< error of the gap at the middle
        double rate = 0;     ///< (relative position).(its derivative) at the middle (walls: the derivative)
        double rate_open = 0;
        double rate_spread = 0; ///< largest change within the stretch
    };
    [[nodiscard]] View view(double from, double to) const {
        const double s = 0.5 * (from + to);
        const double half = std::max(to - s, s - from) * (1 + 4 * u); // precision.md B1 (last operations)
        const Course course = at(s, std::max(std::abs(from), std::abs(to)));
        return wall ? view_of_wall(course, half) : view_of_disks(course, half);
    }

    /// Relative position and velocity at s, and for |s| <= h: bounds of two derivatives and of roundings.
    struct Course {
        PerAxis<double> x{};
        PerAxis<double> v{};
        double first = 0;  ///< largest |x'|
        double second = 0; ///< largest |x''|
        double rounding = 0;
        double slope_rounding = 0;
    };
    [[nodiscard]] Course at(double s, double h) const {
        Course course;
        for (std::size_t k = a.size(); k-- > 0;) {
            for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c) {
                course.x[c] = course.x[c] * s + a[k][c];
                course.v[c] = k > 0 ? course.v[c] * s + static_cast<double>(k) * a[k][c] : course.v[c];
            }
        }
        double terms = 0; // sum of the absolute values in x
        double power = 1; // h^(k-2)
        for (std::size_t k = 1; k < a.size(); ++k) {
            const auto order = static_cast<double>(k);
            if (k >= 2) {
                course.second += order * (order - 1) * power * size[k];
                power *= h;
            }
            const double slope_power = k >= 2 ? power : 1;
            course.first += order * slope_power * size[k];
            terms += slope_power * h * size[k];
        }
        course.first *= upward;
        course.second *= upward;
        terms = (terms + size[0]) * upward;
        course.rounding = (2 * static_cast<double>(a.size()) + 24) * u * (terms + target);  // arcs.md A8
        course.slope_rounding = (2 * static_cast<double>(a.size()) + 8) * u * course.first; // 8: arcs.md A8
        return course;
    }
    [[nodiscard]] View view_of_wall(const Course& c, double half) const {
        View view;
        view.gap = c.x[0] - target;
        view.gap_open = (apart + c.rounding) * upward;
        const double lost = (half * std::abs(c.v[0]) + 0.5 * half * half * c.second) * upward;
        view.gap_low = view.gap - view.gap_open - lost - u * std::abs(view.gap);
        view.rate = c.v[0];
        view.rate_open = (slope_error + c.slope_rounding) * upward;
        view.rate_spread = half * c.second * upward;
        return view;
    }
    [[nodiscard]] View view_of_disks(const Course& c, double half) const {
        View view;
        const double product = dot(c.x, c.v);
        const double distance = std::sqrt(dot(c.x, c.x));
        view.gap = distance - target;
        view.gap_open = (apart + c.rounding) * upward;
        // A distance is at least its projection on the line of centres in the middle of the stretch.
        const double projected = std::abs(product) / distance + c.slope_rounding;
        const double lost = (half * projected + 0.5 * half * half * c.second) * upward;
        view.gap_low = view.gap - view.gap_open - lost - u * std::abs(view.gap);
        const double farthest = distance + half * c.first + c.rounding;
        view.rate = product;
        view.rate_open = (apart * c.first + slope_error * (farthest + apart) + c.rounding * c.first +
                          c.slope_rounding * farthest + 8 * u * distance * c.first) *
                         upward;
        view.rate_spread = half * (c.first * c.first + farthest * c.second) * upward;
        return view;
    }

    bool wall = false;
    int components = most_axes;
    double target = 0;
    std::vector<PerAxis<double>> a; ///< position, then coefficients
    std::vector<double> size;
    double apart = 0;       ///< bound of the distance of the true relative position from that of p
    double slope_error = 0; ///< the same for the derivative
};

bool GapWatch::walk(const Motion& motion, double from, double to, int depth, GapTrend& last, bool& only_falls) {
    const auto view = motion.view(from, to);
    if (view.gap_low > 0) {
        last = GapTrend::above;
        only_falls = false;
        margin_ = std::min(margin_, view.gap / view.gap_open);
        return true;
    }
    if (std::abs(view.rate) > view.rate_open + view.rate_spread) {
        const bool rises = view.rate > 0;
        if (rises && last == GapTrend::falling && !(motion.view(from, from).gap_low > 0)) {
            where_ = from;
            return false; // the gap may have passed through 0 where the two meet
        }
        if (!rises && last == GapTrend::zero) {
            where_ = from;
            return false; // the contact does not open
        }
        margin_ = std::min(margin_, std::abs(view.rate) / view.rate_open);
        only_falls = only_falls && !rises;
        last = rises ? GapTrend::rising : GapTrend::falling;
        return true;
    }
    const double middle = 0.5 * (from + to);
    if (depth >= max_depth || !(middle > from && middle < to) || std::abs(view.rate) < view.rate_open) {
        // No stretch around the middle can be settled unless the gap there is proved positive.
        if (depth >= max_depth || !(view.gap > view.gap_open) || !(middle > from && middle < to)) {
            where_ = middle;
            return false;
        }
    }
    return walk(motion, from, middle, depth + 1, last, only_falls) &&
           walk(motion, middle, to, depth + 1, last, only_falls);
}

void GapWatch::begin(const CurvePiece& piece, double from, double to) {
    const double h = std::max(std::abs(from), std::abs(to));
    double power = h;
    double order = 1;
    moved_ = 0;
    for (const std::vector<double>& a : piece.coefficients()) { // 3.5: above 2 sqrt 3
        // arcs.md A5 (above twice the root of three components)
        moved_ += 3.5 * (1 + 0.5 * order * order) * power * largest(a) * upward;
        power *= h;
        order += 1;
    }
}

/// The first stretch of `walk` proves the gap positive, and leaves the margin as it is: nothing else need be computed.
bool GapWatch::is_far(const CurvePiece& piece, const Contact& contact) const {
    const Packing& at = piece.centre();
    const auto line = contact.image.is_here() ? centre_line(at, contact) : std::nullopt;
    if (!line) {
        return false;
    }
    // arcs.md A8 (the 24 of relative positions, and the highest coefficient)
    const double rounding = (2 * static_cast<double>(piece.coefficients().size()) + 26) * u;
    const double open = separation_weight(contact) * (piece.radius() + piece.curve().rest_radius) * upward +
                        rounding * (2 * line->length + moved_);
    return gap_of(at, contact, *line) - moved_ > 2 * margin_ * open; // the margin is above 1
}

bool GapWatch::look(const CurvePiece& piece, const Contact& contact, double from, double to) {
    if (is_far(piece, contact)) {
        last_.erase(contact);
        fell_.erase(contact);
        return true;
    }
    const Motion motion(piece, contact);
    const auto found = last_.find(contact);
    GapTrend last = found == last_.end() ? GapTrend::above : found->second;
    bool only_falls = true;
    if (!walk(motion, from, to, 0, last, only_falls)) {
        return false;
    }
    if (only_falls) {
        fell_.insert(contact);
    } else {
        fell_.erase(contact);
    }
    if (last != GapTrend::above) {
        last_[contact] = last;
    } else if (found != last_.end()) {
        last_.erase(found);
    }
    return true;
}

int GapWatch::rate_sign(const CurvePiece& piece, const Contact& contact, double s) {
    const auto view = Motion(piece, contact).view(s, s);
    return view.rate > view.rate_open ? 1 : -view.rate > view.rate_open ? -1 : 0;
}

} // namespace isostat
