#pragma once
/// \file
/// A stretch of the curve on which kept gaps stay 0, as a polynomial: private to the room (proofs/arcs.md).

#include "motion/arc_centre.hpp"
#include "motion/kept_curve.hpp"
#include "motion/rounding.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace isostat {

/// p(s) = centre + sum_k s^k a_k, the derivatives of the curve at a nearby point. Nothing is proved of it here.
class CurvePolynomial {
  public:
    /// Derivatives of the curve at a centre with the contacts of `curve`, except for the free row. `forward` = +1 or
    /// -1: sign of the rate of the free row for growing s. \pre the curve and the centre outlive it
    CurvePolynomial(const KeptCurve& curve, const ArcCentre& centre, double forward);

    /// Largest |s| worth trying (an estimate; 0: the centre cannot be used).
    [[nodiscard]] double natural_reach() const { return reach_; }
    /// Upper bound of |DPhi(centre)^-1|; 0: unknown, and there are no coefficients.
    [[nodiscard]] double inverse_norm() const { return inverse_; }
    /// Sign of the rate of the free row.
    [[nodiscard]] int forward() const { return forward_ > 0 ? 1 : -1; }

    /// Rounded p(s) on all coordinates; error per coordinate below 2^-51 times the largest coordinate for |s| <= reach.
    [[nodiscard]] std::vector<double> point(double s) const;
    [[nodiscard]] std::vector<double> slope(double s) const;
    /// The point of the curve near p(s), by chord iterations, on the grid; nothing when they do not converge.
    [[nodiscard]] std::optional<Packing> corrected(double s) const;
    /// row . v, and the sum of the absolute values of its terms.
    [[nodiscard]] RoundedSum along_row(const std::vector<double>& v) const;
    /// row . (x - p(s)) / row . p'(s), from the coordinates of the row alone.
    [[nodiscard]] double ahead_along_row(const std::vector<double>& x, double s) const;
    /// At least the 2-norm of the row, and at least a fourth of the sum of its absolute values.
    [[nodiscard]] double row_norm() const;
    [[nodiscard]] double row_terms() const;

    [[nodiscard]] const KeptCurve& curve() const { return *curve_; }
    [[nodiscard]] const Packing& centre() const { return at_->packing(); }
    [[nodiscard]] const IsostaticStructure& structure() const { return at_->structure(); }
    [[nodiscard]] const Factorisation& factorisation() const { return at_->factorisation(); }
    /// a_1 ... a_K on all coordinates (0 at rest). In a cell on a grid of their own: their separations are exact.
    [[nodiscard]] const std::vector<std::vector<double>>& coefficients() const { return a_; }
    /// Differences of a_0 = 0, a_1 ... a_K over contact l (rounded; in a cell exact).
    [[nodiscard]] std::span<const PerAxis<double>> differences(std::size_t l) const {
        return {&differences_[l * (max_order + 1)], a_.size() + 1};
    }
    /// a_0: p + a_0 meets the equations at s = 0 far better than the centre, which is rounded to a grid. Used in cells,
    /// whose grid is coarse; empty: 0.
    [[nodiscard]] const std::vector<double>& shift() const { return shift_; }

  private:
    static constexpr std::size_t max_order = 14; // cost: order of the polynomial
    [[nodiscard]] double coordinate(std::size_t k, double s) const;
    [[nodiscard]] double rate(std::size_t k, double s) const;
    [[nodiscard]] std::vector<double> solved(std::vector<double> rhs) const;
    void expand();
    void find_shift();
    bool first_coefficient();
    void append(std::vector<double> coefficient);
    void choose_reach();

    const KeptCurve* curve_;
    const ArcCentre* at_;
    double forward_;
    double inverse_ = 0;
    GapGradient row_;
    std::vector<std::vector<double>> a_;
    std::vector<PerAxis<double>> differences_; ///< contact by contact
    std::vector<double> shift_;
    double reach_ = 0;
};

} // namespace isostat
