#include "checker/elimination.hpp"

namespace isostat::checker {

namespace {

void swap_rows(Matrix& a, int i, int j) {
    for (int k = 0; i != j && k < a.columns(); ++k) {
        swap(a.at(i, k), a.at(j, k));
    }
}

/// The first row from `from` on with an entry in a column, or -1.
int pivot_row(const Matrix& a, int from, int column) {
    for (int i = from; i < a.rows(); ++i) {
        if (a.at(i, column) != 0) {
            return i;
        }
    }
    return -1;
}

/// row i <- (pivot row i - entry row p) / previous pivot: an exact division (Bareiss).
void eliminate(Matrix& a, int i, int p, int column, const Integer& previous) {
    const Integer pivot = a.at(p, column);
    const Integer entry = a.at(i, column);
    for (int k = 0; k < a.columns(); ++k) {
        Integer value = pivot * a.at(i, k) - entry * a.at(p, k);
        mpz_divexact(a.at(i, k).get_mpz_t(), value.get_mpz_t(), previous.get_mpz_t());
    }
}

} // namespace

int rank(Matrix a) {
    Integer previous = 1;
    int found = 0;
    for (int column = 0; column < a.columns() && found < a.rows(); ++column) {
        const int row = pivot_row(a, found, column);
        if (row < 0) {
            continue;
        }
        swap_rows(a, found, row);
        for (int i = found + 1; i < a.rows(); ++i) {
            eliminate(a, i, found, column, previous);
        }
        previous = a.at(found, column);
        ++found;
    }
    return found;
}

Matrix inverse_times_determinant(const Matrix& a, Integer& determinant) {
    const int n = a.rows();
    Matrix work(n, 2 * n);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            work.at(i, j) = a.at(i, j);
        }
        work.at(i, n + i) = 1;
    }
    Integer previous = 1;
    for (int k = 0; k < n; ++k) {
        const int row = pivot_row(work, k, k);
        if (row < 0) {
            determinant = 0;
            return a;
        }
        swap_rows(work, k, row);
        for (int i = 0; i < n; ++i) {
            if (i != k) {
                eliminate(work, i, k, k, previous);
            }
        }
        previous = work.at(k, k);
    }
    determinant = previous;
    Matrix adjugate(n, n);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            adjugate.at(i, j) = work.at(i, n + j);
        }
    }
    return adjugate;
}

} // namespace isostat::checker
