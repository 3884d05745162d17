#pragma once
/// \file
/// Cholesky's method in double for A^T A, with a bound of its roundings (proofs/checker.md, K30).

#include "checker/index.hpp"

#include <Eigen/Dense>

#include <memory>
#include <numeric>
#include <vector>

namespace isostat::checker {

/// Row by row.
template <class Value> struct SparseRows {
    std::vector<std::size_t> first{0}; ///< entry of each row, and behind the last one
    std::vector<int> column;
    std::vector<Value> value;
};

/// Where the Cholesky factor of a matrix has entries.
struct FactorPattern {
    std::vector<std::size_t> first{0}; ///< of each row in `column`
    std::vector<int> column;           ///< of the rows, left of the diagonal, each before its parent: its first row
    std::vector<std::size_t> start;    ///< of each column in a list of what is below the diagonal

    FactorPattern() = default;
    /// `visit_row(i, visit)` visits the columns of row i of the matrix, in any order; those from i on are left out.
    template <class VisitRow> FactorPattern(std::size_t size, const VisitRow& visit_row) : start(size + 1, 0) {
        std::vector<int> parent(size, -1);
        std::vector<int> met(size, -1); // the last row that has the column
        std::vector<int> reach(size);
        for (int i = 0; at(i) < size; ++i) {
            std::size_t top = size;
            visit_row(i, [&](int k) {
                std::size_t length = 0;
                for (; k < i && met[at(k)] != i; k = parent[at(k)]) {
                    parent[at(k)] = parent[at(k)] < 0 ? i : parent[at(k)];
                    met[at(k)] = i;
                    reach[length++] = k;
                    ++start[at(k) + 1];
                }
                while (length > 0) {
                    reach[--top] = reach[--length];
                }
            });
            column.insert(column.end(), reach.begin() + static_cast<std::ptrdiff_t>(top), reach.end());
            first.push_back(column.size());
        }
        std::partial_sum(start.begin(), start.end(), start.begin());
    }
};

class NormalFactor {
  public:
    virtual ~NormalFactor() = default;
    /// L L^T near A^T A - shift I. False: not positive definite as far as is seen.
    virtual bool compute(double shift) = 0;
    /// Above |A^T A - shift I - L L^T|, A with columns of large norm times powers of two below 1: that makes no
    /// singular value larger.
    [[nodiscard]] virtual double residual(double shift) const = 0;
    /// About A^-1 b, and A^-T b, from factors without a shift: the condition number counts twice, but for a second
    /// step.
    [[nodiscard]] virtual Eigen::VectorXd solve(const Eigen::VectorXd& b) const = 0;
    [[nodiscard]] virtual Eigen::VectorXd solve_transposed(const Eigen::VectorXd& b, int steps) const = 0;
    /// How many entries L has.
    [[nodiscard]] virtual int entries() const = 0;
};

/// `order`: of elimination, of the columns of A. \pre A is square, with entries up to 1
std::unique_ptr<NormalFactor> normal_factor(int dimension, const SparseRows<double>& a, const std::vector<int>& order);

} // namespace isostat::checker
