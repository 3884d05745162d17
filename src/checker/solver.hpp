#pragma once
/// \file
/// Approximate solutions. Nothing that comes out of here is trusted: every use is followed by an exact residual.

#include "checker/problem.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace isostat::checker {

/// A sparse LU factorisation in double of the scaled matrix A / 2^exponent at a configuration.
class Solver {
  public:
    Solver(const Structure& structure, const std::vector<double>& q);
    /// At the stored coordinates.
    explicit Solver(const Problem& problem);
    /// False: the factorisation gave up (which says nothing about the matrix).
    [[nodiscard]] bool usable() const { return usable_; }
    /// About the size of the largest entry, as a length.
    [[nodiscard]] int exponent() const { return exponent_; }
    /// The same in units of the problem's `fine`.
    [[nodiscard]] long scale(const Problem& problem) const { return exponent_ - problem.fine; }
    /// (A / 2^exponent)^-1 b: b per contact, result per degree of freedom.
    [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const { return lu_.solve(b); }
    /// (A / 2^exponent)^-T b: b per degree of freedom, result per contact.
    [[nodiscard]] Eigen::MatrixXd solve_transposed(const Eigen::MatrixXd& b) const { return lu_.transpose().solve(b); }

  private:
    using Lu = Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>>;
    int exponent_ = 0;
    bool usable_ = false;
    mutable Lu lu_; ///< its transposed view is not const
};

/// value * 2^shift, rounded towards zero; 0 for what is not finite.
Integer scaled_integer(double value, long shift);

} // namespace isostat::checker
