#pragma once
/// \file
/// A stretch of the curve on which kept gaps stay 0, enclosed in a proved tube around a polynomial: private to the room
/// (statements A1 to A4, proofs/arcs.md).

#include "motion/curve_polynomial.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace isostat {

/// The polynomial for |s| <= h, and what `prove` proved about the curve near it.
class CurvePiece : public CurvePolynomial {
    using Polynomial = CurvePolynomial;

  public:
    CurvePiece(const KeptCurve& kept, const ArcCentre& at, double forward);

    using Polynomial::centre;
    using Polynomial::coefficients;
    using Polynomial::curve;
    using Polynomial::inverse_norm;
    using Polynomial::structure;

    /// Reach of the polynomial, shortened to where its misfit is at most that of the centre.
    [[nodiscard]] double natural_reach() const { return reach_; }
    /// Proves for every s in [-h, h]: exactly one point of the curve lies in the hyperplane {row . (q - p(s)) = 0}
    /// within `unique()` of p(s); it is within `radius()`, its derivative in s within `slope_error()` of p'(s), and
    /// row . p' does not vanish. False: nothing is known.
    bool prove(double h);

    [[nodiscard]] double reach() const { return proved_; }
    [[nodiscard]] double radius() const { return radius_; }
    [[nodiscard]] double slope_error() const { return slope_error_; }
    [[nodiscard]] double unique() const { return unique_; }
    /// (1/4) / (beta^2 K rho): above 1 the tube exists.
    [[nodiscard]] double margin() const { return margin_; }

    /// A point of the curve (a true root of the kept equations within `uncertainty` of x, moving coordinates) is q(s)
    /// for exactly one s within `slack` of `s`. Nothing when this is not proved.
    struct Place {
        double s = 0;
        double slack = 0;
    };
    [[nodiscard]] std::optional<Place> locate(const std::vector<double>& x, double uncertainty) const;

    /// Sign of the rate at which this curve moves along the row of `other` at s, s growing: +1, -1, or 0 = not proved.
    [[nodiscard]] int direction_along(const CurvePiece& other, double s) const;

  private:
    void bound_coefficients();
    void bound_coefficients_of(std::size_t l);
    void shift_residual_of(std::size_t l);
    void shorten_reach();
    /// |sum_k s^k (difference of a_k)| / D of every kept disk contact, for all |s| <= h.
    [[nodiscard]] std::vector<double> stretch(double h) const;
    /// For all |s| <= h: residual of the equations along p, its rate of change, largest |difference of p'| / D.
    struct Misfit {
        double value = 0;
        double rate = 0;
        double turn = 0;
    };
    [[nodiscard]] Misfit misfit(double h) const;
    /// For all |s| <= h: smallest rate of the row along p, largest |p'| (rounded).
    struct Motion {
        double row_rate = 0;
        double speed = 0;
    };
    [[nodiscard]] Motion motion(double h) const;
    [[nodiscard]] std::optional<double> nearest(const std::vector<double>& x) const;
    /// x - p(s).
    [[nodiscard]] std::vector<double> away(const std::vector<double>& x, double s) const;

    std::vector<double> relative_; ///< |difference of a_k over contact l|, K per contact (rounded)
    std::vector<double> residual_; ///< bound of coefficient k = 0 ... 2K of F_l along p + a_0
    std::vector<double> shifted_;  ///< |difference of a_0| over contact l
    double shift_norm_ = 0;        ///< |a_0|
    double rounded_ = 0;           ///< sum of the squared residuals of the centre
    double reach_ = 0;
    double proved_ = 0;
    double radius_ = 0;
    double slope_error_ = 0;
    double unique_ = 0;
    double margin_ = 0;
    double row_rate_ = 0; ///< smallest |row . p'|
    double speed_ = 0;    ///< largest |p'| (2-norm)
};

} // namespace isostat
