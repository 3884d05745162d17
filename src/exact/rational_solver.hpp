#pragma once
// Exact solutions of sparse integer systems by p-adic lifting.

#include "sparse/pattern.hpp"

#include <gmpxx.h>

#include <memory>
#include <optional>
#include <vector>

namespace isostat::exact {

/// A rational vector with one denominator > 0.
struct RationalVector {
    std::vector<mpz_class> numerator;
    mpz_class denominator = 1;
};

/// A x = b over the rationals (Dixon: solve mod p, divide the residual by p, repeat; then rational reconstruction).
/// Every solution is *verified*: A numerator = denominator b over the integers, and A is regular because it is regular
/// mod p (statement T4), so x is the solution whatever the primes did.
class RationalSolver {
  public:
    /// Factorises mod 2^61 - 1, and mod 2^31 - 1 when A is singular there. \pre `ordering` belongs to the pattern,
    /// structurally regular.
    RationalSolver(sparse::Matrix<mpz_class> matrix, const sparse::Ordering& ordering);
    ~RationalSolver();
    RationalSolver(RationalSolver&&) noexcept;
    RationalSolver& operator=(RationalSolver&&) noexcept;

    /// Proved regular. False: singular mod both primes, so that `solve` gives nothing.
    [[nodiscard]] bool regular() const;

    /// x with A x = b, or A^T x = b. Nothing only when the matrix is not `regular`. Cost: the solution has up to n log2
    /// |A| bits in numerator and denominator; 2 n log2|A| / 61 sparse products and solves mod p.
    [[nodiscard]] std::optional<RationalVector> solve(const std::vector<mpz_class>& b, bool transposed = false) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace isostat::exact
