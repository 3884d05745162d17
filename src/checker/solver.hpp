#pragma once
/// \file
/// Approximate solutions. They are not trusted: an exact residual follows every use.

#include "checker/problem.hpp"

#include <Eigen/Dense>

#include <memory>

namespace isostat::checker {

/// A sparse factorisation in double of the scaled matrix A / 2^exponent at a configuration.
class Solver {
  public:
    /// `like`: factors of a list in which nearly all contacts are the same, whose orders then serve; or null. `quick`:
    /// by A^T A, where the condition number counts twice.
    Solver(const Structure& structure, const std::vector<double>& q, const Solver* like = nullptr, bool quick = false);
    /// The matrix at the stored coordinates.
    explicit Solver(const Problem& problem, const Solver* like = nullptr);
    /// False: the factorisation failed (which proves nothing about the matrix).
    [[nodiscard]] bool usable() const { return factors_ != nullptr; }
    /// About the size of the largest entry, as a length.
    [[nodiscard]] int exponent() const { return exponent_; }
    /// `exponent` relative to the problem's `fine`.
    [[nodiscard]] long scale(const Problem& problem) const { return exponent_ - problem.fine; }
    /// An order for A^T A of these contacts or others; empty: none is known.
    [[nodiscard]] const std::vector<int>& order() const;
    /// (A / 2^exponent)^-1 b: b per contact, result per degree of freedom. Several threads may call it. \pre usable
    [[nodiscard]] Eigen::MatrixXd solve(Eigen::MatrixXd b) const;
    /// (A / 2^exponent)^-T b: b per degree of freedom, result per contact. Quick factors do better in two steps.
    [[nodiscard]] Eigen::MatrixXd solve_transposed(Eigen::MatrixXd b, int steps = 1) const;

  private:
    struct Factors; ///< those of KLU, or of A^T A
    int exponent_ = 0;
    std::shared_ptr<const Factors> factors_; ///< null: the factorisation failed
};

/// target += value * 2^shift, rounded towards zero; nothing is added for infinity and NaN.
void add_scaled(Integer& target, double value, long shift);
/// The same. False: the sum has more than `most` bits, or that step. \pre most < 126
inline bool add_scaled(Wide& target, double value, long shift, long most) {
    const double step = times_power(value, shift);
    if (!(std::abs(step) < times_power(1, most))) {
        return false;
    }
    // exact: below the largest integer of 64 bits
    target += std::abs(step) < 0x1p62 ? static_cast<std::int64_t>(step) : static_cast<Wide>(step); // a call
    return bits(target) <= most;
}
inline bool add_scaled(Integer& target, double value, long shift, long) {
    add_scaled(target, value, shift);
    return true;
}

} // namespace isostat::checker
