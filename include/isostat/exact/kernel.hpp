#pragma once
/// \file
/// Linear algebra with exact numbers: rank, kernel, systems of inequalities. Every answer is proved.

#include <isostat/core/verdict.hpp>
#include <isostat/exact/number.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace isostat::exact {

/// Columns of (row, non-zero value), rows increasing.
struct NumberMatrix {
    int rows = 0;
    std::vector<std::vector<std::pair<int, Number>>> column;
    [[nodiscard]] int cols() const { return static_cast<int>(column.size()); }
};

NumberMatrix transposed(const NumberMatrix& matrix);

/// A x, dense. \pre x.size() == cols
std::vector<Number> product(const NumberMatrix& matrix, const std::vector<Number>& x);

/// A rank mod p under one homomorphism: a *proved lower bound* of the rank of the exact matrix (statement T4).
struct RankBound {
    int rank = 0;
    std::uint64_t prime = 0;
    std::vector<int> columns;   ///< `rank` columns, greedy in their order; with the rows that are not in `free_rows`
                                ///< they are a regular submatrix: proved independent
    std::vector<int> free_rows; ///< the other rows
};

/// Sparse elimination, one matrix column after the other; stops as soon as the rank is min(rows, cols).
/// Cost: O(columns * band^2) for a banded numbering of the rows.
RankBound rank_bound(const NumberMatrix& matrix);

struct KernelLimits {
    long long cells = 100000; ///< rows x cols beyond which no kernel is sought (dense elimination)
    int primes = 512;         ///< how many primes of 61 bits the reconstruction may use
};

/// Kernel of a matrix, by elimination mod p, reconstruction of the rationals, and an exact check.
/// `rank` is always a proved lower bound. With `exact == proved`, `basis` holds cols - rank vectors, each verified
/// exactly (A v = 0 in the field) and independent by their form (vector k has 1 at free[k] and 0 at the other free
/// columns), so `rank` is the rank: the upper bound needs no trust in the primes. With `undecided`, the limits were
/// reached: the rank may be larger, the basis is empty.
struct Kernel {
    int rank = 0;
    std::vector<int> pivots;                ///< independent columns, greedy in their order
    std::vector<int> free;                  ///< the other columns: each depends on the pivots before it (when `exact`)
    std::vector<std::vector<Number>> basis; ///< one vector per free column
    Verdict exact = Verdict::undecided;
    int primes = 0; ///< primes used
};

/// Cost: rows * cols * rank * 2^k multiplications mod p per prime, k independent roots; 62 x 80: 2 ms per prime and
/// sign choice.
Kernel kernel(const NumberMatrix& matrix, const KernelLimits& limits = {});

/// Answer to: is there z >= 0 with A z = b? Exactly one certificate is filled, and it was checked by substitution.
/// - feasible: `solution` = z;
/// - not feasible: `farkas` = u with u A <= 0 in every column and u b > 0 (Farkas' lemma).
struct Feasibility {
    bool feasible = false;
    std::vector<Number> solution;
    std::vector<Number> farkas;
};

/// `rows[i]` is row i of A (all of size `cols`). First phase of the primal simplex method with Bland's rule (it ends),
/// dense, in exact arithmetic. Cost: pivots * rows * (rows + cols) exact operations; for some ten rows and a hundred
/// columns.
Feasibility feasible_point(const std::vector<std::vector<Number>>& rows, const std::vector<Number>& b, int cols);

/// Signs of the combinations of a few vectors.
enum class OneSign {
    strict,  ///< some combination is > 0 in every component
    partial, ///< not strict, but some combination is >= 0 everywhere and > 0 somewhere
    none     ///< every combination that is not zero has components of both signs
};

/// What the span of `vectors` (all of size `size`) contains; `combination` is such a vector (empty for `none`). An
/// empty list spans 0: none. Gordan's and Stiemke's alternatives, each answer with its certificate checked.
struct OneSignAnswer {
    OneSign kind = OneSign::none;
    std::vector<Number> combination;
};
OneSignAnswer one_sign(const std::vector<std::vector<Number>>& vectors, int size);

} // namespace isostat::exact
