#pragma once
/// \file
/// A stretch of the curve on which kept gaps stay 0, enclosed in a proved tube around a polynomial: private to the room
/// (statements A1 to A4, proofs/arcs.md).

#include <isostat/linear/factorisation.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace isostat {

/// The equations of one arc: contacts[l] keeps gap 0 for every l but `slot`, whose row is free. Only grains that move
/// take part; the others stay at their true place, which is within `rest_radius` (2-norm) of the one in `start`.
template <int Dim> struct KeptCurve {
    KeptCurve(const Packing<Dim>& start, std::vector<Contact> contacts, std::size_t slot, double rest_radius);

    const Packing<Dim>* start; ///< `fixed` and `walls` tell which grains move; held coordinates keep their value here
    std::vector<Contact> contacts;
    std::size_t slot;
    DofMap<Dim> dofs;
    std::vector<double> target; ///< sum of the radii, radius (walls), 0 (held), rounded
    double degree = 0;          ///< largest number of kept disk contacts of one moving disk
    double smallest = 0;        ///< smallest sum of radii of a kept disk contact (infinity: there is none)
    double lipschitz = 0;       ///< of the derivative of F over the moving coordinates (V4)
    double rest_radius = 0;
    double rest_residual = 0;   ///< bound of the change of F by the true places of the grains at rest
    double rest_derivative = 0; ///< the same for the derivative of F
};

/// p(s) = centre + sum_k s^k a_k for |s| <= h, and what `prove` found about the curve near it.
template <int Dim> class CurvePiece {
  public:
    /// Derivatives of the curve at `centre`, where `structure` (contacts of `curve`, but for the free row) has
    /// sigma_min >= `sigma_min`. `forward` = +1 or -1: sign of the rate of the free row for growing s.
    CurvePiece(const KeptCurve<Dim>& curve, Packing<Dim> centre, const IsostaticStructure<Dim>& structure,
               const Factorisation& factorisation, double sigma_min, double forward);

    /// Largest |s| worth trying (an estimate; 0: the centre is no good).
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

    /// A point of the curve (a true root of the kept equations within `uncertainty` of x, moving coordinates) is
    /// q(s) for one s within `slack` of `s`: proved, or nothing.
    struct Place {
        double s = 0;
        double slack = 0;
    };
    [[nodiscard]] std::optional<Place> locate(const std::vector<double>& x, double uncertainty) const;

    /// Sign of the rate at which this curve moves along the row of `other` at s, s growing: +1, -1, or 0 = not proved.
    [[nodiscard]] int direction_along(const CurvePiece& other, double s) const;
    /// Sign of the rate of the own row.
    [[nodiscard]] int forward() const { return forward_ > 0 ? 1 : -1; }

    /// Rounded p(s) on all coordinates; error per coordinate below 2^-51 times the largest coordinate for |s| <= reach.
    [[nodiscard]] std::vector<double> point(double s) const;
    [[nodiscard]] std::vector<double> slope(double s) const;
    /// The point of the curve near p(s), by chord iterations, on the grid; nothing when they do not converge.
    [[nodiscard]] std::optional<Packing<Dim>> corrected(double s) const;

    [[nodiscard]] const KeptCurve<Dim>& curve() const { return *curve_; }
    [[nodiscard]] const Packing<Dim>& centre() const { return centre_; }
    [[nodiscard]] const IsostaticStructure<Dim>& structure() const { return *structure_; }
    [[nodiscard]] const Factorisation& factorisation() const { return *factorisation_; }
    /// a_1 ... a_K on all coordinates (0 at rest).
    [[nodiscard]] const std::vector<std::vector<double>>& coefficients() const { return a_; }
    [[nodiscard]] const GapGradient<Dim>& row() const { return row_; }

  private:
    [[nodiscard]] std::vector<double> solved(std::vector<double> rhs) const;
    void expand();
    void bound_coefficients();
    void shorten_reach();
    /// Upper bound of the 2-norm of the matrix with row l = e_l on one disk and -e_l on the other.
    [[nodiscard]] double norm_of(const std::vector<double>& e) const;
    [[nodiscard]] std::vector<double> stretch(double h) const;

    const KeptCurve<Dim>* curve_;
    Packing<Dim> centre_;
    const IsostaticStructure<Dim>* structure_;
    const Factorisation* factorisation_;
    double forward_;
    double inverse_ = 0; ///< |DPhi(centre)^-1|; 0: unknown
    GapGradient<Dim> row_;
    std::vector<std::vector<double>> a_;
    std::vector<double> relative_; ///< |difference of a_k over contact l|, K per contact (rounded)
    std::vector<double> residual_; ///< bound of coefficient k = 0 ... 2K of F_l along p
    double reach_ = 0;
    double proved_ = 0;
    double radius_ = 0;
    double slope_error_ = 0;
    double unique_ = 0;
    double margin_ = 0;
    double row_rate_ = 0; ///< smallest |row . p'|
    double speed_ = 0;    ///< largest |p'| (2-norm)
};

extern template struct KeptCurve<2>;
extern template class CurvePiece<2>;

} // namespace isostat
