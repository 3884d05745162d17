#pragma once
// The curve of an arc near one of its points: private to the room.

#include <isostat/packing/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace isostat {

/// A point of the curve, and the tangent there.
struct CurvePoint {
    Packing at;
    std::vector<double> tangent; ///< on coordinates
};

/// The curve to second order, with one coordinate as parameter: q(s) = at + s tangent + s^2 curvature / 2.
struct CurveCourse {
    Packing at;
    std::vector<double> tangent;
    std::vector<double> curvature; ///< 0 in the fastest coordinate
    std::size_t fastest = 0;       ///< the coordinate s: its tangent is +1 or -1, and no other is larger

    /// Takes the coordinate with the largest tangent as s. A tangent that is not finite stays so.
    void choose_fastest() {
        fastest = 0;
        for (std::size_t k = 0; k < tangent.size(); ++k) {
            if (std::abs(tangent[k]) > std::abs(tangent[fastest])) {
                fastest = k;
            }
        }
        const double scale = 1 / std::abs(tangent[fastest]);
        for (double& c : tangent) {
            c *= scale;
        }
    }
    [[nodiscard]] double direction() const { return tangent[fastest] < 0 ? -1.0 : 1.0; }
    [[nodiscard]] Packing predicted(double s) const {
        Packing there = at;
        for (std::size_t k = 0; k < there.q.size(); ++k) {
            // 0.5: guess: of the path follower (arcs.md, status.md 1)
            there.q[k] += s * (tangent[k] + 0.5 * s * curvature[k]);
        }
        return there;
    }
    /// The tangent at a point of the curve, extrapolated from the path: the third derivative comes from the error of
    /// the prediction. Below `shortest` this error is rounding, and the third derivative is left out.
    [[nodiscard]] std::vector<double> extrapolated_tangent(const Packing& there, double s, double shortest) const {
        const double third = s > shortest ? 3 / s : 0.0; // guess: of the path follower (arcs.md, status.md 1)
        std::vector<double> t(tangent.size());
        for (std::size_t k = 0; k < t.size(); ++k) {
            const double missed = there.q[k] - (at.q[k] + s * (tangent[k] + 0.5 * s * curvature[k]));
            t[k] = tangent[k] + s * curvature[k] + third * missed;
        }
        return t;
    }
};

} // namespace isostat
