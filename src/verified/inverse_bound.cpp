#include "verified/inverse_bound.hpp"

#include "core/dot.hpp"
#include "core/parallel.hpp"
#include "core/work.hpp"
#include "verified/block_cholesky.hpp"
#include "verified/regularity_prover.hpp"
#include "verified/singular_value.hpp"

#include <isostat/core/machine.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace isostat {

namespace {

/// Estimates sigma_min^2 from above by inverse iteration; improves the guess x as well.
double estimate(const ApproximateInverse& inverse, std::vector<double>& x, int iterations) {
    double lambda = 0;
    for (int k = 0; k < iterations; ++k) {
        const double before = euclidean_norm(x);
        for (double& c : x) {
            c /= before;
        }
        inverse.forces(x);
        inverse.velocities(x);
        lambda = euclidean_norm(x);
    }
    return 1 / lambda;
}

/// S H, which is exact: sigma_min(S H) <= sigma_min(H) for S <= 1.
sparse::Matrix<double> scaled(sparse::Matrix<double> h) {
    const std::vector<double> scale = row_scales(h);
    for (std::size_t e = 0; e < h.row.size(); ++e) {
        h.value[e] *= scale[static_cast<std::size_t>(h.row[e])];
    }
    return h;
}

/// Outcome of the first route, with the numbers that the second route needs.
struct CholeskyOutcome {
    InverseBound bound;
    double estimated = 0;   ///< sigma_min^2, from above, not proved
    double entry_error = 0; ///< |H - fl(H)|
};

CholeskyOutcome by_cholesky(const sparse::Matrix<double>& unscaled, int dimension, const ApproximateInverse& inverse,
                            InverseBoundCache& cache) {
    const auto n = static_cast<std::size_t>(unscaled.rows);
    const sparse::Matrix<double> h = scaled(unscaled);
    int iterations = 1; // from a good guess; a shift that is too large only costs a second factorisation
    if (cache.vector.size() != n || !std::isfinite(euclidean_norm(cache.vector)) || euclidean_norm(cache.vector) == 0) {
        cache.vector.resize(n);
        std::mt19937_64 random(12345); // guess: random numbers
        for (double& c : cache.vector) {
            // 11: guess: random numbers; 0x1p-53: guess: random numbers; 0.5: guess: shift
            c = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
        }
        iterations = 8; // 8: guess: iterations and shift
    }
    count_work(Work::inverse_bounds);
    CholeskyOutcome outcome;
    outcome.entry_error = rounding_of_entries(unscaled, dimension); // scaling makes this smaller
    if (cache.workspace == nullptr) {
        cache.workspace = std::make_shared<BlockCholesky>();
    }
    BlockCholesky& cholesky = *cache.workspace;
    Task set([&] { cholesky.set(h, cache.order); });
    outcome.estimated = estimate(inverse, cache.vector, iterations);
    set.finish();
    double shift = 0.5 * outcome.estimated;
    if (std::isfinite(shift) && shift > 0) {
        for (int attempt = 0; attempt < 4; ++attempt) { // cost: shifts tried, and the next one
            if (!cholesky.factorise(shift)) {
                shift /= 8;
                continue;
            }
            const double square = shift - cholesky.error_bound(shift);
            // A bound that lost more than half to rounding is left to the next attempt, which is in double-double.
            const double sigma = smallest_singular_value(square, outcome.entry_error);
            if (square > 0.25 * shift && sigma > 0) { // cost: then in double-double
                outcome.bound = {Verdict::proved, sigma, InverseBound::Route::cholesky};
            }
            break;
        }
    }
    return outcome;
}

} // namespace

InverseBound bound_inverse(const IsostaticStructure& structure, const Factorisation& factorisation,
                           InverseBoundCache& cache, const std::function<bool()>& worth_more) {
    require_floating_point();
    const sparse::Matrix<double>& h = structure.matrix();
    const int dimension = structure.dofs().layout().dimension;
    const CholeskyOutcome first = by_cholesky(h, dimension, factorisation.approximate(), cache);
    if (first.bound.verdict == Verdict::proved) {
        return first.bound;
    }
    if (worth_more && !worth_more()) {
        return {};
    }
    double square = 0.5 * first.estimated;            // guess: shift
    while (square > 1e-28 && std::isfinite(square)) { // cost: smaller shifts are not tried (bounds.md V1)
        const double proved = shifted_cholesky_double_double(h, square);
        const double sigma = smallest_singular_value(proved, first.entry_error);
        if (sigma > 0) {
            return {Verdict::proved, sigma, InverseBound::Route::double_double};
        }
        if (proved > 0) {
            break; // the entries have too large errors
        }
        square /= 64; // guess: shift
    }
    return {};
}

double smallest_row_singular_value(const sparse::Matrix<double>& h, int dimension) {
    BlockCholesky cholesky;
    FillOrder order;
    const sparse::Matrix<double> rows = scaled(h);
    cholesky.set(rows, order);
    // 4: cost: shifts tried, and the next one; 1e-12: cost: smaller singular values are not sought
    for (double shift = 1; shift > 1e-12; shift /= 4) {
        if (cholesky.factorise(shift)) {
            return std::max(
                0.0, smallest_singular_value(shift - cholesky.error_bound(shift), rounding_of_entries(h, dimension)));
        }
    }
    return 0;
}

std::optional<ProvedExchange> bound_exchanged(const ExchangedContacts& contacts, const ApproximateInverse& inverse,
                                              InverseBoundCache& cache) {
    const int dimension = contacts.dofs().layout().dimension;
    const InverseBound bound = by_cholesky(contacts.matrix(), dimension, inverse, cache).bound;
    if (bound.verdict != Verdict::proved) {
        return std::nullopt;
    }
    return ProvedExchange{bound, RegularityProver::proof(contacts.matrix(), bound.sigma_min)};
}

} // namespace isostat
