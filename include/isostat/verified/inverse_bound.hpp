#pragma once
/// \file
/// A proved bound of the inverse of a contact matrix.

#include <isostat/core/verdict.hpp>
#include <isostat/linear/factorisation.hpp>

#include <vector>

namespace isostat {

/// Proved lower bound of the smallest singular value of H, the *exact* unit-normal matrix of the stored configuration.
/// verdict `proved`: sigma_min(H) >= sigma_min > 0, hence |H^-1|_2 = |G^-1|_2 <= 1 / sigma_min. `undecided`: no bound
/// was found with double precision; sigma_min is 0 and says nothing.
struct InverseBound {
    Verdict verdict = Verdict::undecided;
    double sigma_min = 0;
    /// Which argument proved it.
    enum class Route : unsigned char { cholesky, double_double, rows, multiprecision } route = Route::cholesky;
};

/// What one bound leaves for the next one, at a neighbouring vertex: changes the cost, never the validity.
struct InverseBoundCache {
    std::vector<double> vector;   ///< guess of the singular vector that belongs to sigma_min
    std::vector<int> permutation; ///< fill-reducing order of the degrees of freedom
};

/// First route: Cholesky factorisation (CHOLMOD, simplicial, in round to nearest) of H H^T - s I with s chosen from a
/// few inverse iterations; when it runs to the end, lambda_min(H H^T) >= s - E with E bounded a priori (statement V1 in
/// proofs/). Works down to sigma_min ~ 1e-5; 3 to 9 ms at n = 1936 to 4900. Second route, when rounding hides sigma_min
/// there: the same in double-double (Eigen), down to sigma_min ~ 1e-12; about 0.3 s at n = 4900. Third route:
/// R ~ H^-1 row by row from the LU factors, |H^-1| <= |R| / (1 - |I - R H|) in the 1 and the infinity norm (statement
/// V2); one solve per row, tried when size <= `row_limit`.
template <int Dim>
InverseBound bound_inverse(const IsostaticStructure<Dim>& structure, const Factorisation& factorisation,
                           InverseBoundCache& cache, int row_limit = 20000);

extern template InverseBound bound_inverse<2>(const IsostaticStructure<2>&, const Factorisation&, InverseBoundCache&,
                                              int);

} // namespace isostat
