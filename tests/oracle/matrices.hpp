#pragma once
// Sparse matrices to test with, and their dense twins in FLINT, which the library does not use.

#include "exact/rank.hpp"
#include "oracle/random.hpp"
#include "sparse/pattern.hpp"

#include <flint/fmpz_mat.h>
#include <flint/nmod_mat.h>
#include <gmpxx.h>

#include <algorithm>
#include <optional>
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
    std::ranges::transform(matrix.value, std::back_inserter(reduced.value), exact::residue);
    return reduced;
}

/// Rank of the stored doubles over the rationals. 2^1074 makes every double an integer.
inline int rational_rank(const sparse::Matrix<double>& matrix) {
    const mpq_class unit(mpz_class(1) << 1074);
    fmpz_mat_t integers;
    fmpz_mat_init(integers, matrix.rows, matrix.cols);
    for (std::size_t j = 0; j < static_cast<std::size_t>(matrix.cols); ++j) {
        for (auto e = static_cast<std::size_t>(matrix.start[j]); e < static_cast<std::size_t>(matrix.start[j + 1]);
             ++e) {
            const mpq_class integer = matrix.value[e] * unit;
            fmpz_set_mpz(fmpz_mat_entry(integers, matrix.row[e], j), integer.get_num_mpz_t());
        }
    }
    const auto rank = static_cast<int>(fmpz_mat_rank(integers));
    fmpz_mat_clear(integers);
    return rank;
}

/// The first columns of a matrix of residues mod p.
class Modular {
  public:
    Modular(const Dense<std::uint64_t>& dense, int cols, std::uint64_t p) {
        nmod_mat_init(a_, static_cast<slong>(dense.size()), cols, p);
        for (std::size_t i = 0; i < dense.size(); ++i) {
            std::copy_n(dense[i].begin(), cols, a_->rows[i]);
        }
    }
    Modular(const Modular&) = delete;
    Modular& operator=(const Modular&) = delete;
    ~Modular() { nmod_mat_clear(a_); }

    [[nodiscard]] int rank() const { return static_cast<int>(nmod_mat_rank(a_)); }
    /// A x = b; nothing where A is singular.
    [[nodiscard]] std::optional<std::vector<std::uint64_t>> solution(const std::vector<std::uint64_t>& b) const {
        std::vector<std::uint64_t> x(b.size());
        return nmod_mat_solve_vec(x.data(), a_, b.data()) != 0 ? std::optional(x) : std::nullopt;
    }

  private:
    nmod_mat_t a_;
};

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
    return Modular(expand(matrix), matrix.cols, p).rank();
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
