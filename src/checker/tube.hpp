#pragma once
/// \file
/// A stretch of the curve on which the kept contacts stay closed, enclosed around a polynomial (proofs/checker.md, K16
/// to K18).

#include "checker/bounds.hpp"
#include "checker/problem.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace isostat::checker {

/// The moving grains of one arc and their equations, one fewer than their coordinates.
struct Moving {
    State state;                  ///< coordinates of the start; grains that do not move are marked as fixed
    std::vector<Contact> kept;    ///< contacts of moving grains
    std::vector<int> coordinates; ///< coordinates that move, in their order
    std::vector<bool> moves;      ///< per coordinate
    std::vector<bool> loose;      ///< per coordinate: at rest, but its true value is known only up to `rest`
    double rest = 0;
    [[nodiscard]] bool disk_moves(int i) const {
        return any_of(moves, i); // a pinned disk of a channel moves across it only
    }
    /// The images of a disk move with the cell.
    [[nodiscard]] bool cell_moves() const { return of_cell(moves); }
    [[nodiscard]] bool takes_part(const Contact& c) const;
    /// Bound of the error of |D_l x| of a pair from the grains at rest.
    [[nodiscard]] double off_rest(const Contact& pair) const;

  private:
    /// Whether a coordinate of a disk is marked.
    [[nodiscard]] bool any_of(const std::vector<bool>& flags, int disk) const;
    [[nodiscard]] bool of_cell(const std::vector<bool>& flags) const;
};

/// One component per axis for a pair of disks, one in all for a wall.
template <class Number> struct Separation {
    explicit Separation(std::size_t count) : axes(count) { component.fill(Number(0)); }
    std::size_t axes;
    PerAxis<Number> component;
    Number& operator[](std::size_t a) { return component[a]; }
    const Number& operator[](std::size_t a) const { return component[a]; }
};

/// D . E
template <class Number> Number product(const Separation<Number>& d, const Separation<Number>& e) {
    Number sum = d[0] * e[0];
    for (std::size_t a = 1; a < d.axes; ++a) {
        sum = sum + d[a] * e[a];
    }
    return sum;
}

/// An upper bound of |D|.
double length_above(const Separation<Bounds>& d);

/// The difference D_l x of the two grains of a contact, exact up to rounding of the differences; of a held one: 0.
Separation<Bounds> difference(const std::vector<double>& x, const Contact& c, const Layout& layout);

/// |A m| <= this times the 2-norm of the cell: |m|, 0 for a contact without an image.
double period_weight(const Contact& pair);

/// p(s) = centre + sum_k s^k a_k, with s = direction times (coordinate `row` less its value at the centre).
class Tube {
  public:
    /// `centre`: all coordinates. Nothing when the derivative there is not proved regular.
    static std::unique_ptr<Tube> make(const Moving& moving, std::vector<double> centre, int row, int direction);

    /// Finds the longest reach h for which K16 holds, up to a factor 0.7; false: no reach.
    bool prove();
    [[nodiscard]] double reach() const { return reach_; }
    [[nodiscard]] double radius() const { return radius_; }           ///< 2-norm of q(s) - p(s)
    [[nodiscard]] double slope_error() const { return slope_error_; } ///< 2-norm of q'(s) - p'(s)
    [[nodiscard]] double speed() const { return speed_; }             ///< 2-norm of p'(s)

    /// A true root of the kept equations within `uncertainty` (2-norm) of x (all coordinates) is q(s) for exactly one s
    /// within these bounds. Nothing when this is not proved.
    [[nodiscard]] std::optional<Bounds> locate(const std::vector<double>& x, double uncertainty) const;

    /// p(s) on all coordinates, rounded; `error`: 2-norm of the rounding.
    [[nodiscard]] std::vector<double> point(double s, double& error) const;
    /// q'(s) of one coordinate, s in these bounds.
    [[nodiscard]] Bounds slope(int coordinate, const Bounds& s) const;
    /// The coordinate that is fastest at s, in double precision.
    [[nodiscard]] int fastest(double s) const;
    /// A configuration near q(s), from a few Newton steps in double.
    [[nodiscard]] std::vector<double> corrected(double s) const;

    /// About -(A(centre)^T)^-1 force: one number per kept contact, then that of the row. `force` per coordinate.
    [[nodiscard]] std::vector<double> multipliers(const std::vector<double>& force) const;
    [[nodiscard]] double weight() const { return weight_; } ///< scale of the rows of walls and coordinates
    /// sum_l |D_l x| |D_l y| <= spread |x| |y|: 2 z of K16.
    [[nodiscard]] double spread() const { return spread_; }

    [[nodiscard]] const std::vector<double>& centre() const { return centre_; }
    [[nodiscard]] int row() const { return row_; }
    [[nodiscard]] int direction() const { return direction_; }
    /// a_1 ... a_K, all coordinates.
    [[nodiscard]] const std::vector<std::vector<double>>& coefficients() const { return a_; }

  private:
    Tube(const Moving& moving, std::vector<double> centre, int row, int direction)
        : moving_(moving), centre_(std::move(centre)), row_(row), direction_(direction) {}
    struct Linear;
    void expand();
    void bound_residuals();
    bool holds(double h);
    [[nodiscard]] double change_norm(double h) const;

    const Moving& moving_;
    std::vector<double> centre_;
    int row_;
    int direction_;
    std::shared_ptr<Linear> linear_; ///< not trusted
    double weight_ = 1;
    double sigma_ = 0; ///< lower bound of the singular values of the derivative at the centre
    double longest_ = 0;
    double spread_ = 2;    ///< largest sum of w_l^2 at one disk, or of all images
    double curvature_ = 2; ///< L of K16: the Lipschitz constant of A
    std::vector<std::vector<double>> a_;
    std::vector<std::vector<double>> stretch_;  ///< per kept contact: |D a_k|, k = 1 ...; [0]: from grains at rest
    std::vector<std::vector<double>> residual_; ///< per kept contact: bounds of the coefficients of F along p
    double reach_ = 0, radius_ = 0, slope_error_ = 0, speed_ = 0, unique_ = 0;
};

} // namespace isostat::checker
