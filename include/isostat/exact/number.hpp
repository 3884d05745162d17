#pragma once
/// \file
/// Real numbers kept exactly: sums of rationals times square roots of rationals (multi-quadratic numbers); and linear
/// algebra over them: rank, kernel, systems of inequalities. Every result is proved.

#include <isostat/core/result.hpp>

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace isostat::exact {

struct Terms; // sorted pairs (square-free positive integer d, non-zero rational c); private to the room

/// The exact real sum over d of c_d sqrt(d), with rational c_d != 0 and distinct square-free positive integers d.
///
/// The square roots of distinct square-free integers are linearly independent over Q, so this form is unique: a number
/// is zero exactly when it has no term, and equality is equality of the terms. Every operation returns this form; none
/// rounds. Immutable value, copies share their terms (thread-safe). Cost: + and - linear in the terms, * quadratic, /
/// exponential in the number of independent radicands (2 for Q(sqrt 3), 4 for Q(sqrt 2, sqrt 3)).
class Number {
  public:
    Number() = default;                                               ///< 0
    Number(long long integer);                                        // NOLINT(google-explicit-constructor)
    Number(long integer) : Number(static_cast<long long>(integer)) {} // NOLINT(google-explicit-constructor)
    Number(int integer) : Number(static_cast<long long>(integer)) {}  // NOLINT(google-explicit-constructor)
    explicit Number(std::shared_ptr<const Terms> terms) : terms_(std::move(terms)) {} ///< canonical terms; null = 0

    /// The dyadic rational that equals a finite double. \pre finite
    static Number from_double(double value);

    /// Reads the text form: sums and differences of products and quotients of numbers and `sqrt(q)`:
    /// `0.1` (one tenth), `1e-3`, `7/3`, `0x1.8p+3` (hex float, exact), `1/2*sqrt(3)`, `1 + 3/2*sqrt(2) - sqrt(5/7)`,
    /// `sqrt(3)/2`. Under the root: one non-negative number or quotient of two. Spaces may stand between the tokens.
    /// Throws `Error(bad_input)` with the text, the position (from 1) and what was expected there, for anything else:
    /// nested roots, other functions, parentheses, trailing text, inf and nan, division by zero, exponents beyond
    /// +-10000, and a radicand from which no square-free part can be found (a factor above
    /// 10^18 left after the small primes).
    static Number parse(std::string_view text);

    [[nodiscard]] bool is_zero() const { return terms_ == nullptr; }
    [[nodiscard]] bool is_rational() const;
    /// -1, 0 or 1, always decided: zero by the form, otherwise by rational enclosures refined until they exclude 0.
    [[nodiscard]] int sign() const;
    /// A double enclosure; the radius is below 1 ulp of the value and is 0 when the value is a double. Infinite radius
    /// beyond the range of double.
    [[nodiscard]] Enclosure enclosure() const;
    /// Nearest double up to 1 ulp.
    [[nodiscard]] double to_double() const { return enclosure().value; }
    /// Text that `parse` reads back to the same number: `0`, `-7/3`, `1/2*sqrt(3)`, `1 - 3/2*sqrt(2)`.
    [[nodiscard]] std::string text() const;
    /// The radicands d of the terms, decimal.
    [[nodiscard]] std::vector<std::string> radicands() const;

    /// 1 / this. \pre not zero
    [[nodiscard]] Number inverse() const;
    Number operator-() const;
    friend Number operator+(const Number& a, const Number& b);
    friend Number operator-(const Number& a, const Number& b);
    friend Number operator*(const Number& a, const Number& b);
    /// \pre b is not zero
    friend Number operator/(const Number& a, const Number& b) { return a * b.inverse(); }
    Number& operator+=(const Number& b) { return *this = *this + b; }
    Number& operator-=(const Number& b) { return *this = *this - b; }
    Number& operator*=(const Number& b) { return *this = *this * b; }
    friend bool operator==(const Number& a, const Number& b);
    friend std::strong_ordering operator<=>(const Number& a, const Number& b) { return (a - b).sign() <=> 0; }

    /// For the room's own files.
    [[nodiscard]] const Terms* terms() const { return terms_.get(); }

  private:
    std::shared_ptr<const Terms> terms_;
};

/// The non-negative square root of a non-negative rational, in canonical form: sqrt(p/q) = sqrt(p q) / q with the
/// square part taken out. Throws `Error(bad_input)` when the number is negative, is not rational (nested root), or
/// cannot be factored (see `Number::parse`).
Number sqrt(const Number& rational);

/// A matrix by columns of (row, non-zero value), rows increasing.
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
    std::vector<int> columns;   ///< `rank` columns, greedy in their order; proved independent, because with the rows
                                ///< outside `free_rows` they are a regular submatrix
    std::vector<int> free_rows; ///< the rows that this submatrix does not use
};

/// Sparse elimination, one matrix column after the other; stops as soon as the rank is min(rows, cols).
/// Cost: O(columns * band^2) for a banded numbering of the rows.
RankBound rank_bound(const NumberMatrix& matrix);

struct KernelLimits {
    long long cells = 100000; ///< rows x cols beyond which no kernel is computed (dense elimination)
    int primes = 512;         ///< how many primes of 61 bits the reconstruction may use
};

/// Kernel of a matrix, by elimination mod p, reconstruction of the rationals, and an exact check. `rank` is always a
/// proved lower bound. With `exact == proved`, `basis` holds cols - rank vectors, each verified exactly (A v = 0 in the
/// field) and independent by their form (vector k has 1 at free[k] and 0 at the other free columns), so `rank` is the
/// rank: the upper bound needs no trust in the primes. With `undecided` the limits were reached: the rank may be
/// larger, the basis is empty.
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

/// Whether some z >= 0 has A z = b. Exactly one certificate is filled, and substitution confirmed it.
/// - feasible: `solution` = z;
/// - not feasible: `farkas` = u with u A <= 0 in every column and u b > 0 (Farkas' lemma).
struct Feasibility {
    bool feasible = false;
    std::vector<Number> solution;
    std::vector<Number> farkas;
};

/// `rows[i]` is row i of A (all of size `cols`). First phase of the primal simplex method with Bland's rule (it ends),
/// dense, in exact arithmetic. Cost: pivots * rows * (rows + cols) exact operations; for some
/// ten rows and a hundred columns.
Feasibility feasible_point(const std::vector<std::vector<Number>>& rows, const std::vector<Number>& b, int cols);

/// The smallest cost z over all z >= 0 with A z = b; nothing when there is no such z. Checked by a solution of the
/// dual. \pre the cost has a lower bound there. Cost: as `feasible_point`.
std::optional<Number> least(const std::vector<std::vector<Number>>& rows, const std::vector<Number>& b,
                            const std::vector<Number>& cost);

/// Signs of the combinations of a few vectors.
enum class OneSign {
    strict,  ///< some combination is > 0 in every component
    partial, ///< not strict, but some combination is >= 0 everywhere and > 0 somewhere
    none     ///< every combination that is not zero has components of both signs
};

/// The signs on the span of `vectors`, in the first `size` components, with an example in `combination` (empty:
/// `none`). An empty list spans 0: none. Gordan's and Stiemke's alternatives; each certificate is checked.
struct OneSignAnswer {
    OneSign kind = OneSign::none;
    std::vector<Number> combination;
};
OneSignAnswer one_sign(const std::vector<std::vector<Number>>& vectors, int size);

} // namespace isostat::exact
