#pragma once
// The power of the load along an arc: private to the room.

#include "motion/arc.hpp"
#include "motion/chord.hpp"
#include "motion/curve_course.hpp"

#include <optional>
#include <vector>

namespace isostat {

/// Power of the load, F_ext . t, and where it may vanish inside a step: estimates.
class PowerAlong {
  public:
    explicit PowerAlong(const PowerLoad& load) : load_(load) {}

    [[nodiscard]] bool starts_at_zero() const { return load_.starts_at_zero; }
    /// F_ext . t at a configuration.
    [[nodiscard]] double operator()(const Packing& at, const std::vector<double>& t) const;
    /// The largest component of the load.
    [[nodiscard]] double largest_force(const Packing& at) const;

    /// A step of length s with the power at its two ends.
    struct Step {
        double start, end, s;
    };
    /// First place inside a step where the power seems to be negative although both ends are positive: by the cubic
    /// with value and two derivatives at the start, and the value at the end. Mostly without a pass; else the curvature
    /// is solved for until the slope of the power is accurate, then one more pass.
    [[nodiscard]] std::optional<double> dip(const CurveCourse& course, Chord& chord, const Step& step) const;

  private:
    /// Sum of the absolute values of the terms of F_ext . v.
    [[nodiscard]] double terms(const Packing& at, const std::vector<double>& v) const;
    [[nodiscard]] double slope_along(const CurveCourse& course) const;
    void sharpen(CurveCourse& course, Chord& chord, double s, double least) const;
    [[nodiscard]] std::optional<double> dip_of_cubic(const CurveCourse& course, Chord& chord, const Step& step) const;
    [[nodiscard]] std::vector<double> change(const Packing& at, const std::vector<double>& v) const;
    [[nodiscard]] double bend_along(const Packing& at, const std::vector<double>& v) const;
    [[nodiscard]] std::vector<double> force_at(const Packing& at, const std::vector<double>& v, double s) const;

    PowerLoad load_;
};

/// Root of a function between two places where it has opposite signs, positive at the lower one: false position with
/// the Illinois rule.
class SignChange {
  public:
    struct End {
        double s, value;
    };
    SignChange(End low, End high) : low_(low), high_(high) {}
    /// The place to evaluate next.
    [[nodiscard]] double next() const;
    /// The value found there: it replaces the end with the same sign.
    void found(End there);
    [[nodiscard]] double width() const { return high_.s - low_.s; }

  private:
    End low_, high_;
    int side_ = 0; ///< +1, -1: the lower, the upper end was replaced last
};

} // namespace isostat
