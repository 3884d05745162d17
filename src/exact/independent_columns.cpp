#include "exact/independent_columns.hpp"

#include "exact/rank.hpp"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

namespace isostat::exact {

namespace {

/// Left-looking elimination mod p, column by column.
class ColumnElimination {
  public:
    explicit ColumnElimination(const sparse::Matrix<std::uint64_t>& matrix)
        : matrix_(matrix), pivot_of_row_(static_cast<std::size_t>(matrix.rows), -1),
          row_weight_(static_cast<std::size_t>(matrix.rows), 0), x_(static_cast<std::size_t>(matrix.rows), 0),
          seen_(static_cast<std::size_t>(matrix.rows), 0) {
        for (const int r : matrix.row) {
            ++row_weight_[static_cast<std::size_t>(r)];
        }
    }

    /// True when the column is independent of the columns added before.
    bool add(int column) {
        const auto begin = static_cast<std::size_t>(matrix_.start[static_cast<std::size_t>(column)]);
        const auto end = static_cast<std::size_t>(matrix_.start[static_cast<std::size_t>(column) + 1]);
        for (std::size_t e = begin; e < end; ++e) {
            x_[static_cast<std::size_t>(matrix_.row[e])] = matrix_.value[e];
            touch(matrix_.row[e]);
        }
        apply_pivots();
        const int row = lightest_row();
        if (row >= 0) {
            make_pivot(row);
        }
        for (const int r : touched_) {
            x_[static_cast<std::size_t>(r)] = 0;
            seen_[static_cast<std::size_t>(r)] = 0;
        }
        touched_.clear();
        return row >= 0;
    }

    [[nodiscard]] std::size_t rank() const { return row_of_pivot_.size(); }

  private:
    /// Marks a row of the current column that may not be 0.
    void touch(int r) {
        const auto i = static_cast<std::size_t>(r);
        if (seen_[i] == 0) {
            seen_[i] = 1;
            touched_.push_back(r);
            if (pivot_of_row_[i] >= 0) {
                pending_.push(pivot_of_row_[i]);
            }
        }
    }

    void apply_pivots() {
        while (!pending_.empty()) {
            const auto pivot = static_cast<std::size_t>(pending_.top());
            pending_.pop();
            const std::uint64_t factor = x_[static_cast<std::size_t>(row_of_pivot_[pivot])];
            if (factor == 0) {
                continue;
            }
            for (const auto& [r, multiplier] : lower_[pivot]) {
                touch(r);
                auto& value = x_[static_cast<std::size_t>(r)];
                value = subtract(value, multiply(multiplier, factor));
            }
        }
    }

    /// The row without pivot, not 0 in the current column, that has the fewest entries; -1: there is none.
    [[nodiscard]] int lightest_row() const {
        int chosen = -1;
        for (const int r : touched_) {
            const auto i = static_cast<std::size_t>(r);
            if (pivot_of_row_[i] < 0 && x_[i] != 0 &&
                (chosen < 0 ||
                 std::pair(row_weight_[i], r) < std::pair(row_weight_[static_cast<std::size_t>(chosen)], chosen))) {
                chosen = r;
            }
        }
        return chosen;
    }

    void make_pivot(int row) {
        const auto c = static_cast<std::size_t>(row);
        pivot_of_row_[c] = static_cast<int>(rank());
        row_of_pivot_.push_back(row);
        const std::uint64_t reciprocal = inverse(x_[c]);
        lower_.emplace_back();
        for (const int r : touched_) {
            const auto i = static_cast<std::size_t>(r);
            if (x_[i] != 0 && pivot_of_row_[i] < 0) {
                lower_.back().emplace_back(r, multiply(x_[i], reciprocal));
            }
        }
    }

    const sparse::Matrix<std::uint64_t>& matrix_;
    std::vector<std::vector<std::pair<int, std::uint64_t>>> lower_; ///< multipliers of each pivot column
    std::vector<int> pivot_of_row_;
    std::vector<int> row_of_pivot_;
    std::vector<int> row_weight_;                                        ///< entries of each row
    std::vector<std::uint64_t> x_;                                       ///< the current column
    std::vector<unsigned char> seen_;                                    ///< its rows, as flags
    std::vector<int> touched_;                                           ///< its rows, as a list
    std::priority_queue<int, std::vector<int>, std::greater<>> pending_; ///< pivots to apply, in order
};

} // namespace

std::vector<int> independent_columns(const sparse::Matrix<std::uint64_t>& matrix) {
    ColumnElimination elimination(matrix);
    std::vector<int> independent;
    const auto rows = static_cast<std::size_t>(matrix.rows);
    for (int column = 0; column < matrix.cols && elimination.rank() < rows; ++column) {
        if (elimination.add(column)) {
            independent.push_back(column);
        }
    }
    return independent;
}

} // namespace isostat::exact
