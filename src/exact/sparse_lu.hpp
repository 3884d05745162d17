#pragma once
// Sparse LU factors over any field that a small class of arithmetic describes: residues mod p, MPFR numbers.

#include "sparse/pattern.hpp"

#include <cstddef>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace isostat::exact {

/// Left-looking LU, P A Q = L U, with Q from an `Ordering` and row pivots by weight. `Arithmetic` provides
/// Value zero(), bool is_zero(x), void subtract_product(x, a, b) [x -= a b], void multiply(x, a) [x *= a],
/// Value reciprocal(x), and double weight(x) >= 0, larger for a better pivot (0 for zero).
template <class Arithmetic> class SparseLu {
  public:
    using Value = typename Arithmetic::Value;

    /// \pre `ordering` belongs to the pattern of `matrix`, structurally regular.
    SparseLu(Arithmetic arithmetic, const sparse::Matrix<Value>& matrix, const sparse::Ordering& ordering)
        : arithmetic_(std::move(arithmetic)), column_of_(ordering.column_order()) {
        factorise(matrix, ordering.row_order());
    }

    /// False: a column has no non-zero pivot, and the solves must not be called.
    [[nodiscard]] bool regular() const { return regular_; }

    /// A x = b in place: b by rows of A, x by columns.
    void solve(std::vector<Value>& b) const {
        const std::size_t n = row_of_.size();
        std::vector<Value> y(n, arithmetic_.zero());
        for (std::size_t k = 0; k < n; ++k) {
            y[k] = b[row_of_[k]];
            if (!arithmetic_.is_zero(y[k])) {
                for (std::size_t e = lower_start_[k]; e < lower_start_[k + 1]; ++e) {
                    arithmetic_.subtract_product(b[lower_row_[e]], lower_value_[e], y[k]);
                }
            }
        }
        for (std::size_t k = n; k-- > 0;) {
            if (!arithmetic_.is_zero(y[k])) {
                arithmetic_.multiply(y[k], reciprocal_[k]);
                for (std::size_t e = upper_start_[k]; e < upper_start_[k + 1]; ++e) {
                    arithmetic_.subtract_product(y[upper_step_[e]], upper_value_[e], y[k]);
                }
            }
        }
        for (std::size_t k = 0; k < n; ++k) {
            b[static_cast<std::size_t>(column_of_[k])] = std::move(y[k]);
        }
    }

    /// A^T x = b in place: b by columns of A, x by rows.
    void solve_transposed(std::vector<Value>& b) const {
        const std::size_t n = row_of_.size();
        std::vector<Value> y(n, arithmetic_.zero());
        for (std::size_t k = 0; k < n; ++k) {
            y[k] = b[static_cast<std::size_t>(column_of_[k])];
            for (std::size_t e = upper_start_[k]; e < upper_start_[k + 1]; ++e) {
                arithmetic_.subtract_product(y[k], upper_value_[e], y[upper_step_[e]]);
            }
            arithmetic_.multiply(y[k], reciprocal_[k]);
        }
        for (std::size_t k = n; k-- > 0;) {
            for (std::size_t e = lower_start_[k]; e < lower_start_[k + 1]; ++e) {
                arithmetic_.subtract_product(y[k], lower_value_[e], y[step_of_[lower_row_[e]]]);
            }
        }
        for (std::size_t k = 0; k < n; ++k) {
            b[row_of_[k]] = std::move(y[k]);
        }
    }

  private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    void factorise(const sparse::Matrix<Value>& matrix, const std::vector<int>& preferred) {
        const auto n = static_cast<std::size_t>(matrix.cols);
        std::vector<Value> work(n, arithmetic_.zero());
        std::vector<std::size_t> mark(n, none); // by row: the last step that reached it
        std::vector<std::size_t> candidates;
        step_of_.assign(n, none);
        lower_start_.push_back(0);
        upper_start_.push_back(0);
        for (std::size_t k = 0; k < n; ++k) {
            candidates.clear();
            // Earlier pivots act in the order of their steps: a pivot only reaches rows that became pivots later.
            std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> pending;
            const auto reach = [&](std::size_t row) {
                if (mark[row] != k) {
                    mark[row] = k;
                    if (step_of_[row] == none) {
                        candidates.push_back(row);
                    } else {
                        pending.push(step_of_[row]);
                    }
                }
            };
            const auto column = static_cast<std::size_t>(column_of_[k]);
            for (auto e = static_cast<std::size_t>(matrix.start[column]);
                 e < static_cast<std::size_t>(matrix.start[column + 1]); ++e) {
                const auto row = static_cast<std::size_t>(matrix.row[e]);
                work[row] = matrix.value[e];
                reach(row);
            }
            while (!pending.empty()) {
                const std::size_t step = pending.top();
                pending.pop();
                Value& x = work[row_of_[step]];
                if (!arithmetic_.is_zero(x)) {
                    for (std::size_t e = lower_start_[step]; e < lower_start_[step + 1]; ++e) {
                        reach(lower_row_[e]);
                        arithmetic_.subtract_product(work[lower_row_[e]], lower_value_[e], x);
                    }
                    upper_step_.push_back(step);
                    upper_value_.push_back(x);
                    x = arithmetic_.zero();
                }
            }
            upper_start_.push_back(upper_step_.size());
            if (!choose_pivot(work, candidates, static_cast<std::size_t>(preferred[k]))) {
                return;
            }
        }
        regular_ = true;
    }

    /// Stores the column of L, divided by its pivot, and clears the work space; false when every candidate is zero.
    bool choose_pivot(std::vector<Value>& work, const std::vector<std::size_t>& candidates, std::size_t preferred) {
        std::size_t pivot = none;
        double best = 0;
        double of_preferred = 0;
        for (const std::size_t row : candidates) {
            const double weight = arithmetic_.weight(work[row]);
            if (weight > best) {
                best = weight;
                pivot = row;
            }
            of_preferred = row == preferred ? weight : of_preferred;
        }
        if (pivot == none) {
            return false;
        }
        if (of_preferred >= 0.1 * best) {
            pivot = preferred; // gives less fill
        }
        const Value reciprocal = arithmetic_.reciprocal(work[pivot]);
        step_of_[pivot] = row_of_.size();
        row_of_.push_back(pivot);
        for (const std::size_t row : candidates) {
            if (row != pivot && !arithmetic_.is_zero(work[row])) {
                arithmetic_.multiply(work[row], reciprocal);
                lower_row_.push_back(row);
                lower_value_.push_back(work[row]);
            }
            work[row] = arithmetic_.zero();
        }
        reciprocal_.push_back(reciprocal);
        lower_start_.push_back(lower_row_.size());
        return true;
    }

    Arithmetic arithmetic_;
    bool regular_ = false;
    std::vector<int> column_of_;                       ///< by step
    std::vector<std::size_t> row_of_, step_of_;        ///< by step, by row
    std::vector<Value> reciprocal_;                    ///< of the pivots
    std::vector<std::size_t> lower_start_, lower_row_; ///< columns of L below the diagonal
    std::vector<Value> lower_value_;
    std::vector<std::size_t> upper_start_, upper_step_; ///< columns of U above the diagonal
    std::vector<Value> upper_value_;
};

} // namespace isostat::exact
