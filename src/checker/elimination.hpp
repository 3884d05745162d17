#pragma once
/// \file
/// Exact elimination of small dense integer matrices (fraction-free, after Bareiss).

#include "checker/rational.hpp"

#include <vector>

namespace isostat::checker {

/// A dense matrix, row by row.
class Matrix {
  public:
    Matrix(int rows, int columns)
        : rows_(rows), columns_(columns), values_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {}
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] Integer& at(int i, int j) { return values_[index(i, j)]; }
    [[nodiscard]] const Integer& at(int i, int j) const { return values_[index(i, j)]; }

  private:
    [[nodiscard]] std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(j);
    }
    int rows_;
    int columns_;
    std::vector<Integer> values_;
};

/// The rank of a matrix, exact.
int rank(Matrix a);

/// The adjugate of a square matrix and its determinant; with determinant 0 the returned matrix has no meaning.
Matrix inverse_times_determinant(const Matrix& a, Integer& determinant);

} // namespace isostat::checker
