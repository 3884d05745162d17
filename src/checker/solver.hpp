#pragma once
/// \file
/// Approximate solutions. Nothing that comes out of here is trusted: every use is followed by an exact residual.

#include "checker/problem.hpp"

#include <Eigen/Dense>

#include <memory>

namespace isostat::checker {

/// A sparse LU factorisation in double of the scaled matrix A / 2^exponent at a configuration.
class Solver {
  public:
    Solver(const Structure& structure, const std::vector<double>& q);
    /// At the stored coordinates.
    explicit Solver(const Problem& problem);
    /// False: the factorisation gave up (which says nothing about the matrix).
    [[nodiscard]] bool usable() const { return factors_ != nullptr; }
    /// About the size of the largest entry, as a length.
    [[nodiscard]] int exponent() const { return exponent_; }
    /// The same in units of the problem's `fine`.
    [[nodiscard]] long scale(const Problem& problem) const { return exponent_ - problem.fine; }
    /// (A / 2^exponent)^-1 b: b per contact, result per degree of freedom. Any number of threads may ask. \pre usable
    [[nodiscard]] Eigen::MatrixXd solve(Eigen::MatrixXd b) const;
    /// (A / 2^exponent)^-T b: b per degree of freedom, result per contact.
    [[nodiscard]] Eigen::MatrixXd solve_transposed(Eigen::MatrixXd b) const;

  private:
    struct Factors; ///< of KLU
    int exponent_ = 0;
    std::shared_ptr<const Factors> factors_; ///< null: it gave up
};

/// target += value * 2^shift, rounded towards zero; nothing for what is not finite.
void add_scaled(Integer& target, double value, long shift);

} // namespace isostat::checker
