#pragma once
// The canonical form of a multi-quadratic number, and the helpers that need GMP types.

#include <isostat/exact/number.hpp>

#include <gmpxx.h>

#include <utility>
#include <vector>

namespace isostat::exact {

/// One summand c sqrt(d).
struct Term {
    mpz_class radicand;    ///< square-free, positive
    mpq_class coefficient; ///< non-zero
};

/// Sorted by radicand, no radicand twice, never empty (0 is the null pointer).
struct Terms {
    std::vector<Term> list;
};

/// Sorts, merges and drops zeros.
Number make_number(std::vector<Term> list);
Number make_rational(const mpq_class& value);

/// square * square_free = value, square_free without a square factor: returns (root of the square part, square-free
/// part). \pre value > 0. Throws `Error(bad_input)` when a factor that may hide a square is left after trial division.
std::pair<mpz_class, mpz_class> square_free_part(mpz_class value);

/// Pairwise coprime integers above 1 whose products give every one of the square-free integers above 1.
std::vector<mpz_class> coprime_base(const std::vector<mpz_class>& square_free);

} // namespace isostat::exact
