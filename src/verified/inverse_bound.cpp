#include "verified/inverse_bound.hpp"

#include "core/dot.hpp"
#include "core/parallel.hpp"
#include "core/roundoff.hpp"
#include "core/work.hpp"
#include "verified/block_cholesky.hpp"
#include "verified/extended_cholesky.hpp"
#include "verified/regularity_prover.hpp"
#include "verified/row_scales.hpp"
#include "verified/singular_value.hpp"

#include <isostat/core/machine.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace isostat {

namespace {

using roundoff::gamma;
using roundoff::u;

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

InverseBound by_rows(const sparse::Matrix<double>& h, int dimension, const Factorisation& factorisation) {
    const auto n = static_cast<std::size_t>(h.rows);
    std::vector<double> column_sum_r(n, 0.0);
    std::vector<double> column_sum_e(n, 0.0);
    double row_sum_r = 0;
    double row_sum_e = 0;
    std::vector<double> r(n);
    for (std::size_t i = 0; i < n; ++i) {
        // Row i of R ~ H^-1 solves H^T r = e_i.
        std::fill(r.begin(), r.end(), 0.0);
        r[i] = 1;
        factorisation.solve_velocities(r);
        double sum_r = 0;
        double sum_e = 0;
        for (std::size_t k = 0; k < n; ++k) {
            sum_r += std::abs(r[k]);
            column_sum_r[k] += std::abs(r[k]);
        }
        for (std::size_t j = 0; j < n; ++j) {
            double dot = i == j ? -1.0 : 0.0;
            double size = std::abs(dot);
            for (int e = h.start[j]; e < h.start[j + 1]; ++e) {
                const auto s = static_cast<std::size_t>(e);
                const double term = r[static_cast<std::size_t>(h.row[s])] * h.value[s];
                dot += term;
                size += std::abs(term);
            }
            const double terms = h.start[j + 1] - h.start[j] + 2;
            // The last term covers the error of the entries of fl(H).
            const double error = std::abs(dot) + gamma(terms) * size + roundoff::entry_units(dimension) * u * size;
            sum_e += error;
            column_sum_e[j] += error;
        }
        row_sum_r = std::max(row_sum_r, sum_r);
        row_sum_e = std::max(row_sum_e, sum_e);
        if (!(sum_e < 1)) {
            return {};
        }
    }
    const double above = 1 + gamma(4.0 * static_cast<double>(n));
    const double col_e = *std::max_element(column_sum_e.begin(), column_sum_e.end()) * above;
    const double col_r = *std::max_element(column_sum_r.begin(), column_sum_r.end()) * above;
    row_sum_e *= above;
    row_sum_r *= above;
    if (!(col_e < 1) || !(row_sum_e < 1)) {
        return {};
    }
    const double bound = std::sqrt(col_r / (1 - col_e) * (row_sum_r / (1 - row_sum_e))) * (1 + 1e-12);
    if (!std::isfinite(bound)) {
        return {};
    }
    return {Verdict::proved, 1 / bound * (1 - 1e-15), InverseBound::Route::rows};
}

/// Outcome of the first route, with the numbers that the other routes need.
struct CholeskyOutcome {
    InverseBound bound;
    double estimated = 0;   ///< sigma_min^2, from above, not proved
    double entry_error = 0; ///< |H - fl(H)|
};

CholeskyOutcome by_cholesky(const sparse::Matrix<double>& unscaled, int dimension, const ApproximateInverse& inverse,
                            InverseBoundCache& cache) {
    const auto n = static_cast<std::size_t>(unscaled.rows);
    sparse::Matrix<double> h = unscaled;
    const std::vector<double> scale = row_scales(h);
    for (std::size_t e = 0; e < h.row.size(); ++e) {
        h.value[e] *= scale[static_cast<std::size_t>(h.row[e])]; // exact: sigma_min(S H) <= sigma_min(H) for S <= 1
    }
    int iterations = 1; // from a good guess; a shift that is too large only costs a second factorisation
    if (cache.vector.size() != n || !std::isfinite(euclidean_norm(cache.vector)) || euclidean_norm(cache.vector) == 0) {
        cache.vector.resize(n);
        std::mt19937_64 random(12345);
        for (double& c : cache.vector) {
            c = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
        }
        iterations = 8;
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
        for (int attempt = 0; attempt < 4; ++attempt) {
            if (!cholesky.factorise(shift)) {
                shift /= 8;
                continue;
            }
            const double square = shift - cholesky.error_bound(shift);
            // A bound that lost more than half to rounding is left to the next attempt, which is in double-double.
            const double sigma = smallest_singular_value(square, outcome.entry_error);
            if (square > 0.25 * shift && sigma > 0) {
                outcome.bound = {Verdict::proved, sigma, InverseBound::Route::cholesky};
            }
            break;
        }
    }
    return outcome;
}

} // namespace

InverseBound bound_inverse(const IsostaticStructure& structure, const Factorisation& factorisation,
                           InverseBoundCache& cache, const std::function<bool()>& worth_more, int row_limit) {
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
    const double estimated = first.estimated;
    const double entry_error = first.entry_error;
    double square = 0.5 * estimated;
    while (square > 1e-24 && std::isfinite(square)) {
        const double proved = shifted_cholesky_double_double(h, square);
        const double sigma = smallest_singular_value(proved, entry_error);
        if (sigma > 0) {
            return {Verdict::proved, sigma, InverseBound::Route::double_double};
        }
        if (proved > 0) {
            break; // the entries have too large errors
        }
        square /= 64;
    }
    return h.rows <= row_limit ? by_rows(h, dimension, factorisation) : InverseBound{};
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
