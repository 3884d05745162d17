#pragma once
/// \file
/// Dense columns as a sparse Cholesky factorisation needs them. Every element is made by the same operations in the
/// same order, whatever the processor and the number of threads: the bits are always the same.

#include <cstddef>

namespace isostat::preparation {

/// C(i, j) -= sum over k of A(i, k) B(j, k), k ascending, one rounding per product and per difference; column-major,
/// `ld...` from one column to the next.
struct ProductSum {
    double* c;
    std::size_t ldc;
    const double* a;
    std::size_t lda;
    const double* b;
    std::size_t ldb;
    std::size_t rows, columns, terms;

    void subtract() const;
    /// Only i >= j is needed; a few elements above may be changed. Several threads for large ones.
    void subtract_lower() const;
};

/// Cholesky factor of the first `columns` rows (lower triangle), and the rows below times its inverse transpose, in
/// place. False when a pivot is not positive. \pre rows >= columns.
bool factorise_panel(double* panel, std::size_t rows, std::size_t columns);

/// With the factored panel (L above, M below) and x = (y, z): y becomes L^-1 y, z becomes z - M L^-1 y.
void solve_panel(const double* panel, std::size_t rows, std::size_t columns, double* x);
/// y becomes L^-T (y - M^T z).
void solve_panel_transposed(const double* panel, std::size_t rows, std::size_t columns, double* x);

} // namespace isostat::preparation
