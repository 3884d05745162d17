#pragma once
/// \file
/// Proved bounds of the inverse of a contact matrix, and of matrices with more columns than rows.

#include "linear/factorisation.hpp"
#include "sparse/pattern.hpp"

#include <isostat/core/result.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// Proved lower bound of the smallest singular value of H, the *exact* unit-normal matrix of the stored configuration.
/// verdict `proved`: sigma_min(H) >= sigma_min > 0, hence |H^-1|_2 = |G^-1|_2 <= 1 / sigma_min. `undecided`: no bound
/// was found with double precision; sigma_min is 0 and implies nothing.
struct InverseBound {
    Verdict verdict = Verdict::undecided;
    double sigma_min = 0;
    /// The argument that proved the bound.
    enum class Route : unsigned char { cholesky, double_double, multiprecision, carried } route = Route::cholesky;
    /// For a carried bound: sigma_min of the bound at the start of the chain; else 0.
    double carried_from = 0;
};

/// An order of elimination of little fill, for the blocks of a Cholesky factorisation.
struct FillOrder {
    std::vector<int> rows; ///< two by two these rows make a block
    double work = 0;       ///< work of a factorisation in this order when it was computed
};

class BlockCholesky; // private to the room

/// Data that one bound leaves for the next one, at a neighbouring vertex: they change the cost, never what is proved.
/// Copies share the memory, so they are not for concurrent use.
struct InverseBoundCache {
    std::vector<double> vector; ///< guess of the singular vector of sigma_min
    FillOrder order;
    std::shared_ptr<BlockCholesky> workspace;
    /// Empties the cache but keeps its memory, so that what follows does not depend on what was before.
    void forget() {
        vector.clear();
        order = {};
    }
};

/// First route: Cholesky factorisation (in doubles, blocks of 2 x 2) of H H^T - s I with s chosen from a few inverse
/// iterations; when it runs to the end, lambda_min(H H^T) >= s - E with E bounded a priori (statement V1 in proofs/).
/// Works down to sigma_min ~ 1e-5; 3 to 9 ms at n = 1936 to 4900. Second route, when rounding hides sigma_min: the same
/// in double-double (Eigen), down to sigma_min ~ 1e-12 (1e-13 for some contacts); about 0.3 s at n = 4900. Before it
/// `worth_more` is called, for a structure that is not proved yet, and false ends with `undecided`.
InverseBound bound_inverse(const IsostaticStructure& structure, const Factorisation& factorisation,
                           InverseBoundCache& cache, const std::function<bool()>& worth_more = {});

/// As `bound_inverse`, for sigma_min down to the range of double (about 1e-300): R ~ H^-1 row by row from sparse LU
/// factors in MPFR with 128, 256, ... `max_bits` bits, then |H^-1|_2 <= sqrt(|R|_1 |R|_inf) / (1 - |R H - I|) with the
/// rounding of the entries and products included (statement V2 with the unit 2^-bits). `undecided` when N_f exceeds
/// `size_limit`, or at the cap. Cost: N_f solves with `bits` bits; N_f = 200, sigma_min = 1e-40: about 0.1 s.
InverseBound bound_inverse_multiprecision(const Packing& packing, const IsostaticStructure& structure,
                                          // 400: cost: larger matrices are given up; 4096: cost: then it is given up
                                          int size_limit = 400, int max_bits = 4096);

/// A bound of the inverse that is at the same time the proof that the exchanged matrix is regular.
struct ProvedExchange {
    InverseBound bound;
    RegularityProof proof;
};

/// By Cholesky (statement V1), for a matrix that is not known to be regular. `inverse` only
/// guesses the shift. Nothing when the factorisation fails or rounding hides sigma_min:
/// then use `IsostaticStructure::prove`. Cost: 2 ms at n = 1936, 9 ms at n = 4900.
std::optional<ProvedExchange> bound_exchanged(const ExchangedContacts& contacts, const ApproximateInverse& inverse,
                                              InverseBoundCache& cache);

/// Carries the bound of the previous structure over an exchange (statement V8 in proofs/exchange.md): the kept rows of
/// G keep at least `bound.sigma_min` minus the norm of their change; the forces z that balance the mechanism measure
/// what the new row adds. Loses a factor below sqrt 2 per exchange when the grains hardly move; no factorisation.
/// `mechanism` (on degrees of freedom) is a guess of the null vector of the kept rows at the end, `inverse` makes the
/// other guesses; neither is trusted. Nothing when the grains moved too far, or when less than `worth` of the last
/// bound that was not carried is left. Cost: 2 to 4 passes.
std::optional<ProvedExchange> carry_bound(const IsostaticStructure& before, const InverseBound& bound,
                                          const ExchangedContacts& after, const ApproximateInverse& inverse,
                                          // cost: below it the bound is made anew (exchange.md V8)
                                          std::vector<double> mechanism, double worth = 0.02);

/// A lower bound of the smallest of the `h.rows` singular values of the exact matrix that `h` is rounded from
/// (statement V1, which needs no square matrix); 0: no bound was found, and nothing is known. Cost: a Cholesky
/// factorisation for every factor 2 that it is below 1.
double smallest_row_singular_value(const sparse::Matrix<double>& h, int dimension);

/// r = v - H z. Returns an upper bound of the exact |v - H z|_2, v known to 3u. `size`, `terms`: scratch, as long as v.
double residual_of_forces(const sparse::Matrix<double>& h, const std::vector<double>& v, const std::vector<double>& z,
                          std::vector<double>& r, std::vector<double>& size, std::vector<int>& terms);

} // namespace isostat
