#pragma once
/// \file
/// First-order change of a true vertex when the radii become R_i + eps rho_i (proofs/checker.md, K12 to K14).

#include "checker/evidence.hpp"

namespace isostat::checker {

/// Solutions of A(q*) v = b, enclosed. Lengths are real. The evidence must be of a found vertex and outlive the object.
class Velocities {
  public:
    explicit Velocities(const Evidence& evidence) : e_(evidence) {}

    struct Solution {
        std::vector<Rational> middle; ///< per coordinate; 0 for coordinates that do not move
        Rational radius;              ///< of every coordinate that moves
        [[nodiscard]] double fastest() const;
    };
    /// `b` per contact: the rate of F_l, each known up to `off`.
    [[nodiscard]] Solution solve(const std::vector<Rational>& b, const Rational& off = 0) const;
    /// The motion on which the gap of one contact changes at rate `direction` and no other gap of a contact changes.
    [[nodiscard]] Solution opening(std::size_t contact, int direction) const;
    /// The rate of the gap of a pair that touches at the true vertex.
    [[nodiscard]] Range gap_rate(const Contact& pair, const Solution& v) const;
    /// The second derivative of that gap by the gap of `opened`, v =
    /// opening(opened, 1), while all other contacts stay closed (K23).
    [[nodiscard]] Range bend(const Contact& pair, std::size_t opened, const Solution& v) const;

  private:
    [[nodiscard]] Range turning(const Contact& pair, const Solution& v) const;
    const Evidence& e_;
};

/// Derivatives with respect to eps at eps = 0; the contacts stay closed.
class FirstOrder {
  public:
    FirstOrder(const Evidence& evidence, const std::vector<double>& rho);

    /// First-order gap of a pair that touches at the true vertex.
    [[nodiscard]] Range gap(const Contact& pair) const;
    /// First-order forces at a fixed stress, from the forces f0.
    [[nodiscard]] std::vector<Range> forces(const std::vector<Range>& f0) const;
    [[nodiscard]] const Velocities& velocities() const { return velocities_; }

  private:
    [[nodiscard]] Rational grown(const Contact& pair) const;
    const Evidence& e_;
    const std::vector<double>& rho_;
    Velocities velocities_;
    Velocities::Solution change_;
};

/// First-order term of the stress at which the force of a contact vanishes, from the first-order term of the force.
inline Range limit_rate(const Range& first, const Range& slope) {
    return -(first / slope);
}

} // namespace isostat::checker
