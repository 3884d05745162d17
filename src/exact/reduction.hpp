#pragma once
/// \file
/// Ring homomorphisms from multi-quadratic numbers to a prime field.

#include <isostat/exact/number.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace isostat::exact {

/// The search for primes goes downwards from here.
inline constexpr std::uint64_t largest_prime_bound = std::uint64_t{1} << 61;

/// Sums, products and powers mod a prime below 2^61.
class PrimeField {
  public:
    explicit PrimeField(std::uint64_t prime) : prime_(prime) {}
    [[nodiscard]] std::uint64_t prime() const { return prime_; }
    [[nodiscard]] std::uint64_t add(std::uint64_t a, std::uint64_t b) const {
        return a + b >= prime_ ? a + b - prime_ : a + b;
    }
    [[nodiscard]] std::uint64_t subtract(std::uint64_t a, std::uint64_t b) const {
        return a >= b ? a - b : a + prime_ - b;
    }
    [[nodiscard]] std::uint64_t multiply(std::uint64_t a, std::uint64_t b) const;
    [[nodiscard]] std::uint64_t power(std::uint64_t a, std::uint64_t exponent) const;
    /// \pre a != 0 mod p
    [[nodiscard]] std::uint64_t inverse(std::uint64_t a) const { return power(a, prime_ - 2); }

  private:
    std::uint64_t prime_;
};

/// A ring homomorphism Z[1/m, sqrt(b_1), .., sqrt(b_k)] -> F_p (statement T4): the b_i are pairwise coprime, each
/// radicand of the numbers is a product of some of them, and each sqrt(b_i) goes to one chosen root of b_i mod p, so
/// sqrt(b_i b_j) goes to the product of their images. (Roots chosen for 2, 3 and 6 independently are *not* a
/// homomorphism.) m is the product of the denominators.
class Reduction {
  public:
    /// The homomorphism for every number of a list, and all sums and products of them, mod the largest suitable prime
    /// smaller than `below`: p = 3 mod 4, each b_i a square, no denominator and no b_i divisible by p. Deterministic.
    /// \pre below <= 2^61 Cost: some 50 2^k primality tests, below 1 ms for small k.
    static Reduction suitable(const std::vector<const Number*>& numbers, std::uint64_t below = largest_prime_bound);

    [[nodiscard]] const PrimeField& field() const { return field_; }
    /// k, the number of independent square roots; there are 2^k sign choices.
    [[nodiscard]] int root_count() const { return static_cast<int>(base_.size()); }
    /// The pairwise coprime b_i, decimal.
    [[nodiscard]] const std::vector<std::string>& base() const { return base_; }
    /// Image; bit i of `signs` takes the other root of b_i (another homomorphism, the composition with a field
    /// automorphism). \pre the number lies in the ring for which this was made
    [[nodiscard]] std::uint64_t residue(const Number& number, unsigned signs = 0) const;
    /// Image of sqrt(b_i), the root chosen when bit i of `signs` is 0.
    [[nodiscard]] std::uint64_t root(int i) const { return root_[static_cast<std::size_t>(i)]; }

  private:
    explicit Reduction(std::uint64_t prime) : field_(prime) {}
    PrimeField field_;
    std::vector<std::string> base_;
    std::vector<std::uint64_t> root_;
};

} // namespace isostat::exact
