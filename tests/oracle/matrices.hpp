#pragma once
// Sparse matrices to test with, and their dense exact twins: GMP rationals, and plain elimination mod p.

#include "exact/rank.hpp"
#include "oracle/random.hpp"
#include "sparse/pattern.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <vector>

namespace isostat::oracle {

template <class Value> using Dense = std::vector<std::vector<Value>>;

/// Compressed columns of the marked entries; `stored(i, j)` tells which entries are kept, zeros included.
template <class Value, class Stored>
sparse::Matrix<Value> compress(const Dense<Value>& dense, int cols, Stored stored) {
    sparse::Matrix<Value> matrix;
    matrix.rows = static_cast<int>(dense.size());
    matrix.cols = cols;
    matrix.start.push_back(0);
    for (std::size_t j = 0; j < static_cast<std::size_t>(cols); ++j) {
        for (std::size_t i = 0; i < dense.size(); ++i) {
            if (stored(i, j)) {
                matrix.row.push_back(static_cast<int>(i));
                matrix.value.push_back(dense[i][j]);
            }
        }
        matrix.start.push_back(static_cast<int>(matrix.row.size()));
    }
    return matrix;
}

inline sparse::Matrix<std::uint64_t> reduce(const sparse::Matrix<double>& matrix) {
    sparse::Matrix<std::uint64_t> reduced{matrix.rows, matrix.cols, matrix.start, matrix.row, {}};
    std::transform(matrix.value.begin(), matrix.value.end(), std::back_inserter(reduced.value), exact::residue);
    return reduced;
}

/// Rank over the rationals, by elimination of the stored doubles.
inline int rational_rank(const sparse::Matrix<double>& matrix) {
    Dense<mpq_class> a(static_cast<std::size_t>(matrix.rows),
                       std::vector<mpq_class>(static_cast<std::size_t>(matrix.cols)));
    for (std::size_t j = 0; j < static_cast<std::size_t>(matrix.cols); ++j) {
        for (auto e = static_cast<std::size_t>(matrix.start[j]); e < static_cast<std::size_t>(matrix.start[j + 1]);
             ++e) {
            a[static_cast<std::size_t>(matrix.row[e])][j] = mpq_class(matrix.value[e]);
        }
    }
    std::size_t rank = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(matrix.cols) && rank < a.size(); ++j) {
        std::size_t pivot = rank;
        while (pivot < a.size() && sgn(a[pivot][j]) == 0) {
            ++pivot;
        }
        if (pivot == a.size()) {
            continue;
        }
        std::swap(a[rank], a[pivot]);
        for (std::size_t i = rank + 1; i < a.size(); ++i) {
            const mpq_class factor = a[i][j] / a[rank][j];
            for (std::size_t k = j; sgn(factor) != 0 && k < a[i].size(); ++k) {
                a[i][k] -= factor * a[rank][k];
            }
        }
        ++rank;
    }
    return static_cast<int>(rank);
}

__extension__ using Wide = unsigned __int128;

inline std::uint64_t multiply_mod(std::uint64_t a, std::uint64_t b, std::uint64_t p) {
    return static_cast<std::uint64_t>(static_cast<Wide>(a) * b % p);
}

/// a^(p-2): the inverse by Fermat's theorem.
inline std::uint64_t inverse_mod(std::uint64_t a, std::uint64_t p) {
    std::uint64_t result = 1;
    for (std::uint64_t e = p - 2; e != 0; e >>= 1) {
        if ((e & 1) != 0) {
            result = multiply_mod(result, a, p);
        }
        a = multiply_mod(a, a, p);
    }
    return result;
}

/// Reduces [A | b] mod p by dense elimination; returns the rank of A. When A is regular, b is the solution afterwards,
/// in the order of the columns.
inline int dense_eliminate(Dense<std::uint64_t> a, std::vector<std::uint64_t>& b, int cols,
                           std::uint64_t p = exact::mersenne61) {
    std::size_t rank = 0;
    for (std::size_t j = 0; j < static_cast<std::size_t>(cols) && rank < a.size(); ++j) {
        std::size_t pivot = rank;
        while (pivot < a.size() && a[pivot][j] == 0) {
            ++pivot;
        }
        if (pivot == a.size()) {
            continue;
        }
        std::swap(a[rank], a[pivot]);
        std::swap(b[rank], b[pivot]);
        const std::uint64_t scale = inverse_mod(a[rank][j], p);
        for (std::uint64_t& x : a[rank]) {
            x = multiply_mod(x, scale, p);
        }
        b[rank] = multiply_mod(b[rank], scale, p);
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (i == rank || a[i][j] == 0) {
                continue;
            }
            const std::uint64_t factor = p - a[i][j];
            for (std::size_t k = j; k < a[i].size(); ++k) {
                a[i][k] = (a[i][k] + multiply_mod(factor, a[rank][k], p)) % p;
            }
            b[i] = (b[i] + multiply_mod(factor, b[rank], p)) % p;
        }
        ++rank;
    }
    return static_cast<int>(rank);
}

template <class Value> Dense<Value> expand(const sparse::Matrix<Value>& matrix) {
    Dense<Value> dense(static_cast<std::size_t>(matrix.rows),
                       std::vector<Value>(static_cast<std::size_t>(matrix.cols), Value{}));
    for (std::size_t j = 0; j < static_cast<std::size_t>(matrix.cols); ++j) {
        for (auto e = static_cast<std::size_t>(matrix.start[j]); e < static_cast<std::size_t>(matrix.start[j + 1]);
             ++e) {
            dense[static_cast<std::size_t>(matrix.row[e])][j] = matrix.value[e];
        }
    }
    return dense;
}

inline int dense_rank(const sparse::Matrix<std::uint64_t>& matrix, std::uint64_t p = exact::mersenne61) {
    std::vector<std::uint64_t> unused(static_cast<std::size_t>(matrix.rows), 0);
    return dense_eliminate(expand(matrix), unused, matrix.cols, p);
}

/// Size of a maximum matching of the pattern, by augmenting paths.
inline int matching_size(const sparse::Matrix<std::uint64_t>& matrix) {
    std::vector<int> column_of(static_cast<std::size_t>(matrix.rows), -1);
    std::vector<char> tried;
    const auto augment = [&](auto&& self, int j) -> bool {
        for (int e = matrix.start[static_cast<std::size_t>(j)]; e < matrix.start[static_cast<std::size_t>(j) + 1];
             ++e) {
            const auto i = static_cast<std::size_t>(matrix.row[static_cast<std::size_t>(e)]);
            if (tried[i] == 0) {
                tried[i] = 1;
                if (column_of[i] < 0 || self(self, column_of[i])) {
                    column_of[i] = j;
                    return true;
                }
            }
        }
        return false;
    };
    int size = 0;
    for (int j = 0; j < matrix.cols; ++j) {
        tried.assign(static_cast<std::size_t>(matrix.rows), 0);
        size += augment(augment, j) ? 1 : 0;
    }
    return size;
}

/// A random pattern with `extra` entries besides a hidden perfect matching (left out when `matched` is false).
inline Dense<char> random_pattern(int rows, int cols, int extra, bool matched, Random& random) {
    Dense<char> pattern(static_cast<std::size_t>(rows), std::vector<char>(static_cast<std::size_t>(cols), 0));
    std::vector<int> shuffled(static_cast<std::size_t>(rows));
    for (int i = 0; i < rows; ++i) {
        shuffled[static_cast<std::size_t>(i)] = i;
    }
    for (int i = rows; i-- > 1;) {
        std::swap(shuffled[static_cast<std::size_t>(i)], shuffled[static_cast<std::size_t>(random.integer(i + 1))]);
    }
    for (std::size_t k = 0; matched && k < static_cast<std::size_t>(std::min(rows, cols)); ++k) {
        pattern[static_cast<std::size_t>(shuffled[k])][k] = 1;
    }
    for (int k = 0; k < extra; ++k) {
        pattern[static_cast<std::size_t>(random.integer(rows))][static_cast<std::size_t>(random.integer(cols))] = 1;
    }
    return pattern;
}

} // namespace isostat::oracle
