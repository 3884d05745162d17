#include "motion/power_along.hpp"

#include "contact/separation.hpp"
#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "motion/geometry.hpp"

#include <algorithm>
#include <cmath>

// guess: all other numbers of this file: of the path follower (arcs.md, status.md 1)

namespace isostat {

namespace {

double product(const std::vector<double>& maybe_empty, const std::vector<double>& v) {
    double sum = 0;
    for (std::size_t k = 0; k < maybe_empty.size(); ++k) {
        sum += maybe_empty[k] * v[k];
    }
    return sum;
}

/// n . third derivative of a kept gap, whose own third derivative is 0: -3 (t . curvature) / d, as approach.
double third_approach(const CurveCourse& course, const Contact& c) {
    if (!c.of_disks()) {
        return 0;
    }
    const auto d = separation(course.at.layout(), course.at.q, c);
    const auto t = separation(course.at.layout(), course.tangent, c);
    const auto bend = separation(course.at.layout(), course.curvature, c);
    double product = 0;
    double square = 0;
    for (std::size_t a = 0; a < d.size(); ++a) { // in the plane the third ones are 0
        square += d[a] * d[a];
        product += t[a] * bend[a];
    }
    return 3 * product / std::sqrt(square);
}

} // namespace

double PowerAlong::operator()(const Packing& at, const std::vector<double>& t) const {
    if (load_.infinitesimal) {
        return product(load_.load->infinitesimal, t);
    }
    double power = 0;
    load_.load->for_each_force(at, [&](std::size_t k, double f) { power += f * t[k]; });
    return power;
}

double PowerAlong::largest_force(const Packing& at) const {
    if (load_.infinitesimal) {
        return isostat::largest(load_.load->infinitesimal);
    }
    double most = 0;
    load_.load->for_each_force(at, [&most](std::size_t, double f) { most = std::max(most, std::abs(f)); });
    return most;
}

double PowerAlong::terms(const Packing& at, const std::vector<double>& v) const {
    double sum = 0;
    if (load_.infinitesimal) {
        for (std::size_t k = 0; k < load_.load->infinitesimal.size(); ++k) {
            sum += std::abs(load_.load->infinitesimal[k] * v[k]);
        }
        return sum;
    }
    load_.load->for_each_force(at, [&](std::size_t k, double f) { sum += std::abs(f * v[k]); });
    return sum;
}

/// DF v: true stresses act on lengths, which are linear in q, and in space on products of two lengths, of which a
/// central difference is the derivative. Empty when the load is dead.
std::vector<double> PowerAlong::change(const Packing& at, const std::vector<double>& v) const {
    if (load_.infinitesimal || load_.load->kind == LoadKind::nominal) {
        return {};
    }
    const bool linear = at.dimension == plane;
    std::vector<double> change = force_at(at, v, 1);
    const std::vector<double> before = force_at(at, v, linear ? 0 : -1);
    std::transform(change.begin(), change.end(), before.begin(), change.begin(),
                   [linear](double a, double b) { return linear ? a - b : 0.5 * (a - b); });
    return change;
}

/// v.D2F(v, v): 0 where F is linear.
double PowerAlong::bend_along(const Packing& at, const std::vector<double>& v) const {
    if (load_.infinitesimal || load_.load->kind == LoadKind::nominal || at.dimension == plane) {
        return 0;
    }
    return product(force_at(at, v, 1), v) - 2 * product(force_at(at, v, 0), v) + product(force_at(at, v, -1), v);
}

/// The load at q + s v.
std::vector<double> PowerAlong::force_at(const Packing& at, const std::vector<double>& v, double s) const {
    Packing there = at;
    for (std::size_t k = 0; k < there.q.size(); ++k) {
        there.q[k] += s * v[k];
    }
    return load_.load->external_force(there);
}

/// Makes passes until their effect on the power over a length s is small compared with `least`, a power, or, for a
/// power that starts at 0, with the effect of the slope.
void PowerAlong::sharpen(CurveCourse& course, Chord& chord, double s, double least) const {
    constexpr int most_passes = 10;
    constexpr double small = 0.1;
    double change = roundoff::infinity;
    for (int pass = 0; pass < most_passes && change > small * std::max(least, s * std::abs(slope_along(course)));
         ++pass) {
        const std::vector<double>& missed = chord.velocity(
            [&](const Contact& c) {
                return quick_curvature(course.at, c, course.tangent) + gap_rate(course.at, c, course.curvature);
            },
            course.fastest);
        for (std::size_t k = 0; k < missed.size(); ++k) {
            course.curvature[k] += missed[k];
        }
        change = s * std::abs((*this)(course.at, missed));
    }
}

std::optional<double> PowerAlong::dip(const CurveCourse& course, Chord& chord, const Step& step) const {
    // Factors of another configuration leave an error of this share in the curvature: a power smaller than this share
    // of its terms is a difference that they cannot resolve.
    constexpr double stale = 0.1;
    const double s = step.s;
    const double slope = s * slope_along(course);
    const double least = std::min({step.start, step.start + slope, step.end});
    // Passes are needed only where the curved part, estimated from the other three numbers, could bring the power near
    // 0. Like the cubic itself this is an estimate, not a proof.
    if (least > 2 * std::abs(step.end - step.start - slope) && least > stale * s * terms(course.at, course.curvature)) {
        return std::nullopt;
    }
    CurveCourse sharp = course;
    sharpen(sharp, chord, s, std::min(step.start, step.end));
    return dip_of_cubic(sharp, chord, step);
}

/// p' = F.c + t.DF t, c = dt/ds; dead loads: DF = 0.
double PowerAlong::slope_along(const CurveCourse& course) const {
    return (*this)(course.at, course.curvature) + product(change(course.at, course.tangent), course.tangent);
}

/// p'' = F.e + 2 c.DF t + t.DF c + t.D2F(t, t), e = dc/ds.
std::optional<double> PowerAlong::dip_of_cubic(const CurveCourse& course, Chord& chord, const Step& step) const {
    const double s = step.s;
    const double p1 = s * slope_along(course);
    const std::vector<double>& third =
        chord.velocity([&](const Contact& c) { return third_approach(course, c); }, course.fastest);
    const double p2 =
        0.5 * s * s *
        ((*this)(course.at, third) + 2 * product(change(course.at, course.tangent), course.curvature) +
         product(change(course.at, course.curvature), course.tangent) + bend_along(course.at, course.tangent));
    const double p3 = step.end - step.start - p1 - p2;
    // The error of the cubic at x is x^3 (1 - x) times a fourth derivative / 24, taken to be as large as p3.
    constexpr int samples = 32;
    for (int k = 1; k < samples; ++k) {
        const double x = static_cast<double>(k) / samples;
        if (step.start + x * (p1 + x * (p2 + x * p3)) < x * x * x * (1 - x) * std::abs(p3)) {
            return x * s;
        }
    }
    return std::nullopt;
}

double SignChange::next() const {
    const double s = (low_.value * high_.s - high_.value * low_.s) / (low_.value - high_.value);
    return s > low_.s && s < high_.s ? s : 0.5 * (low_.s + high_.s);
}

void SignChange::found(End there) {
    if (there.value > 0) {
        low_ = there;
        high_.value *= side_ == 1 ? 0.5 : 1.0;
        side_ = 1;
    } else {
        high_ = there;
        low_.value *= side_ == -1 ? 0.5 : 1.0;
        side_ = -1;
    }
}

} // namespace isostat
