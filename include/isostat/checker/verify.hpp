#pragma once
/// \file
/// An independent checker of certificates. It shares with the program that made a certificate only the data (states,
/// contacts, claims) and the reader of the file: no matrix, bound, solver or list of neighbours. Mathematics:
/// proofs/checker.md (K1 to K15).

#include <isostat/core/verdict.hpp>
#include <isostat/io/certificate_file.hpp>

#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// The answer to one claim.
/// - `proved`: the checker's own rigorous enclosure implies the claim;
/// - `refuted`: it contradicts the claim;
/// - `undecided`: neither; `detail` says what is missing. Nothing is known of the claim then.
struct ClaimCheck {
    std::string claim{};  ///< name of the field of `CertificateClaims`
    bool claimed = false; ///< false: the certificate does not claim it (`undecided`)
    Verdict verdict = Verdict::undecided;
    std::string detail{};                                  ///< one line: what was proved, or why not
    std::vector<std::pair<std::string, double>> numbers{}; ///< the numbers behind it: proved bounds, rounded outwards
};

/// The answers to all claims, in the order of `CertificateClaims`, `stable` last.
struct Verification {
    std::vector<ClaimCheck> checks;
    /// Refuted when a claim is; else undecided when a claim is undecided or absent; else proved: then the state has a
    /// true vertex nearby that is an isostatic equilibrium without overlap and a strict local minimum.
    Verdict verdict = Verdict::undecided;
};

/// How the inverse is bounded. All of them prove; they differ in reach and cost.
enum class CheckerArithmetic {
    automatic,      ///< the first of the others that is good enough for the claim about the vertex
    singular_value, ///< a sparse Cholesky factor, its residual in 64-bit integers: condition numbers up to about 1e7
    rows,           ///< row by row of an approximate inverse: the first of the following that succeeds
    fixed64, ///< rows of 64-bit integers, products in 128 bits: coordinates on a common grid of at most 2^60 steps
    gmp,     ///< rows of GMP integers, refined: any coordinates, condition numbers up to about 1e14
    rational ///< exact inverse: at most `largest_exact_matrix` contacts, any regular matrix
};

/// Largest number of rows and columns for which the checker eliminates exactly.
inline constexpr int largest_exact_matrix = 100;

/// Checks every claim from the state and the claims alone. Does not throw on false claims. Coordinates, radii and loads
/// are the stored doubles, taken as exact rationals. Supported: all that `State<2>` can hold, except held coordinates:
/// then every claim is undecided. Cost: some sparse factorisations, of which nothing is trusted, and as many integer
/// products as one of them takes; where that does not suffice N solves and 4 N^2 integer products. Memory: the factors.
Verification verify(const Certificate& certificate, CheckerArithmetic arithmetic = CheckerArithmetic::automatic);

/// The first thing in which two states differ, bit for bit, in words; empty: they are the same problem. Numbers of
/// equilibria, provenance and recorded results (first-order terms) do not count.
std::string state_difference(const State<2>& a, const State<2>& b);

} // namespace isostat
