#pragma once
/// \file
/// Exact rank of a sparse matrix by elimination over a prime field, and its first independent columns.

#include "sparse/pattern.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace isostat::exact {

/// p = 2^61 - 1: products fold by shifts, and powers of two are rotations. Residues are in [0, p).
inline constexpr std::uint64_t mersenne61 = (std::uint64_t{1} << 61) - 1;

/// The residue of a finite double, exactly: m * 2^e mod p. A ring homomorphism from the dyadic rationals.
std::uint64_t residue(double value);

/// For residues mod 2^31 - 1: a smaller field, cheaper words, and a chance of about n / 2^31 of a false deficiency.
inline constexpr std::uint32_t mersenne31 = (std::uint32_t{1} << 31) - 1;
std::uint32_t residue31(double value);

/// (a - b) mod p, (a * b) mod p.
std::uint64_t subtract(std::uint64_t a, std::uint64_t b);
std::uint64_t multiply(std::uint64_t a, std::uint64_t b);

/// 1 / a mod p. \pre 0 < a < p. Cost: about 0.15 us.
std::uint64_t inverse(std::uint64_t a);

/// A lower bound of the rank of a matrix of residues, by elimination of its diagonal blocks only: the sum of their
/// ranks mod p.
/// - n (full): the matrix is regular mod p, and every matrix over Q (or the dyadic rationals) that reduces to it is
///   *proved* regular (statement T4, proofs/rank_mod_p.md).
/// - less than n: the determinant is 0 mod p. The number is still a lower bound of the rank mod p, hence of the
///   rank over Q, and equal to the rank mod p when there is a single block. It proves nothing more: over Q the
///   matrix is singular except for an accident with a chance of about n / p = n / 2e18 (the determinant is a
///   non-zero number that p divides).
/// \pre `ordering` belongs to the pattern of `matrix` (square, structurally regular); stored zeros are allowed,
/// rows are not repeated in a column. Cost: 0.3 of one UMFPACK analysis and factorisation of the matrix at n =
/// 4000, 0.4 at n = 10 000 (1.9 and 7.5 ms; tests/bench/state_cost.cpp). The workspace, about 16 bytes per entry of
/// the factor L, is kept per thread.
int rank(const sparse::Matrix<std::uint64_t>& matrix, const sparse::Ordering& ordering);

/// The rank in the field with p = 2^31 - 1: a full rank is the same proof, a deficient one weak evidence (n / 2^31).
int rank(const sparse::Matrix<std::uint32_t>& matrix, const sparse::Ordering& ordering);

/// The rank mod p, exactly, of any matrix: a lower bound of the rank over Q, as above. Columns are eliminated in a
/// COLAMD order, of many spheres in one by nested dissection; pivots are the candidate rows with the fewest entries in
/// `matrix`. \pre rows are not repeated in a column. Cost: 1.3 to 1.6 times that with an ordering.
int rank(const sparse::Matrix<std::uint64_t>& matrix);

/// The ranks of the first `ends[k]` rows for every k, in one elimination: a pivot is taken from later rows only where
/// the rest of its column is 0 in the earlier rows. \pre `ends` ascends to the number of rows
std::vector<int> ranks_of_first_rows(const sparse::Matrix<std::uint64_t>& matrix, std::span<const int> ends);

/// Columns that are independent mod 2^61 - 1 of the columns before them, in increasing order:
/// their number is the rank mod p, and they are independent over Q (statement T4). Other columns
/// are dependent mod p, which proves nothing over Q. Rows are eliminated sparsest column entry
/// first; cost grows with the fill of the natural column order, so this is for inspection.
std::vector<int> independent_columns(const sparse::Matrix<std::uint64_t>& matrix);

} // namespace isostat::exact
