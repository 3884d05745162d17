#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "verified/inverse_bound.hpp"
#include "verified/norm.hpp"
#include "verified/regularity_prover.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using roundoff::u;
constexpr double slack = 1 + 1e-9; ///< rounding of the norms and of the last operations; exchange.md V8

/// Upper bound of |G_-' - G_-|_2 over the kept rows of the exact matrices: |B|_2^2 <= max (B^T B 1)_j for B =
/// |difference| entry by entry; the entries of both matrices err by 5u, in space 5.51u. Empty when the patterns differ.
std::optional<double> change_of_kept(const sparse::Matrix<double>& before, const sparse::Matrix<double>& after,
                                     int slot, int dimension) {
    const double of_entries = (dimension == plane ? 11 : 12) * u; // 11: exchange.md V8 (11u); 12: exchange.md V8 (12u)
    std::vector<double> difference(after.row.size(), 0.0);
    std::vector<double> row_sum(static_cast<std::size_t>(after.rows), 0.0);
    for (int j = 0; j < after.cols; ++j) {
        const auto c = static_cast<std::size_t>(j);
        if (j == slot) {
            continue;
        }
        auto old = static_cast<std::size_t>(before.start[c]);
        if (before.start[c + 1] - before.start[c] != after.start[c + 1] - after.start[c]) {
            return std::nullopt;
        }
        for (auto e = static_cast<std::size_t>(after.start[c]); e < static_cast<std::size_t>(after.start[c + 1]);
             ++e, ++old) {
            if (before.row[old] != after.row[e]) {
                return std::nullopt;
            }
            difference[e] = std::abs(after.value[e] - before.value[old]) +
                            of_entries * std::max(std::abs(after.value[e]), std::abs(before.value[old]));
            row_sum[static_cast<std::size_t>(after.row[e])] += difference[e];
        }
    }
    double largest = 0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(after.cols); ++c) {
        double sum = 0;
        for (auto e = static_cast<std::size_t>(after.start[c]); e < static_cast<std::size_t>(after.start[c + 1]); ++e) {
            sum += difference[e] * row_sum[static_cast<std::size_t>(after.row[e])]; // 0 in the slot's column
        }
        largest = std::max(largest, sum);
    }
    return std::sqrt(largest) * slack;
}

/// r = G_- v for the kept rows, 0 for the slot. Returns an upper bound of the exact |G_- v|_2.
double residual_of_mechanism(const sparse::Matrix<double>& h, int slot, const std::vector<double>& v,
                             std::vector<double>& r) {
    double square = 0;
    for (std::size_t j = 0; j < r.size(); ++j) {
        double dot = 0;
        double size = 0;
        for (auto e = static_cast<std::size_t>(h.start[j]); e < static_cast<std::size_t>(h.start[j + 1]); ++e) {
            const double term = h.value[e] * v[static_cast<std::size_t>(h.row[e])];
            dot += term;
            size += std::abs(term);
        }
        r[j] = static_cast<int>(j) == slot ? 0.0 : dot;
        // exchange.md V8 (c + 8)
        const double terms = h.start[j + 1] - h.start[j] + 8; // 5u of the entries, the products, the additions
        const double bound = static_cast<int>(j) == slot ? 0.0 : std::abs(dot) + terms * u * size;
        square += bound * bound;
    }
    return std::sqrt(square) * slack;
}

// cost: when the guess is good enough (exchange.md V8)
constexpr double good_enough = 0.02; // a relative loss of the bound
constexpr int max_passes = 4;        // cost: passes

/// Refines a guess, of length about 1, of the motion v with G_- v = 0. Returns an upper bound of its distance from
/// the line of the true motion, which is at most |G_- v| / kept.
double refine_mechanism(const sparse::Matrix<double>& h, int slot, const ApproximateInverse& inverse, double kept,
                        std::vector<double>& mechanism) {
    std::vector<double> r(mechanism.size());
    for (int k = 0;; ++k) {
        const double off = residual_of_mechanism(h, slot, mechanism, r) / kept;
        if (off < good_enough || k == max_passes) {
            return off;
        }
        inverse.velocities(r);
        for (std::size_t i = 0; i < r.size(); ++i) {
            mechanism[i] -= r[i];
        }
    }
}

/// Computes forces z that balance the mechanism approximately. Returns an upper bound of |v - H z|_2.
double balancing_forces(const sparse::Matrix<double>& h, const std::vector<double>& mechanism,
                        const ApproximateInverse& inverse, std::vector<double>& z) {
    z = mechanism;
    inverse.forces(z);
    std::vector<double> r(z.size());
    std::vector<double> size(z.size());
    std::vector<int> terms(z.size());
    for (int k = 0;; ++k) {
        const double open = residual_of_forces(h, mechanism, z, r, size, terms);
        if (open < good_enough || k == max_passes) {
            return open;
        }
        inverse.forces(r);
        for (std::size_t l = 0; l < z.size(); ++l) {
            z[l] += r[l];
        }
    }
}

} // namespace

double residual_of_forces(const sparse::Matrix<double>& h, const std::vector<double>& v, const std::vector<double>& z,
                          std::vector<double>& r, std::vector<double>& size, std::vector<int>& terms) {
    r = v;
    std::fill(terms.begin(), terms.end(), 8); // exchange.md V8 (c + 8)
    for (std::size_t i = 0; i < size.size(); ++i) {
        size[i] = std::abs(v[i]);
    }
    for (std::size_t j = 0; j < z.size(); ++j) {
        for (auto e = static_cast<std::size_t>(h.start[j]); e < static_cast<std::size_t>(h.start[j + 1]); ++e) {
            const auto i = static_cast<std::size_t>(h.row[e]);
            const double term = h.value[e] * z[j];
            r[i] -= term;
            size[i] += std::abs(term);
            ++terms[i];
        }
    }
    double square = 0;
    for (std::size_t i = 0; i < r.size(); ++i) {
        // bounds.md V3
        size[i] = std::abs(r[i]) + terms[i] * (1.001 * u * size[i] + underflow_unit); // a product may underflow
        square += size[i] * size[i];
    }
    return std::max(std::sqrt(square) * slack, norm_above(size)); // of small forces the squares are 0
}

std::optional<ProvedExchange> carry_bound(const IsostaticStructure& before, const InverseBound& bound,
                                          const ExchangedContacts& after, const ApproximateInverse& inverse,
                                          std::vector<double> mechanism, double worth) {
    if (bound.verdict != Verdict::proved || before.size() != after.matrix().cols) {
        return std::nullopt;
    }
    const sparse::Matrix<double>& h = after.matrix();
    const auto change = change_of_kept(before.matrix(), h, after.slot(), before.dofs().layout().dimension);
    const double started_with = bound.carried_from > 0 ? bound.carried_from : bound.sigma_min;
    if (!change || !(bound.sigma_min - *change > worth * started_with)) {
        return std::nullopt;
    }
    // 4: precision.md B1 (last operations)
    const double kept = (bound.sigma_min - *change) * (1 - 4 * u); // of G_-, N - 1 rows
    const double size_of_guess = euclidean_norm(mechanism);
    for (double& c : mechanism) {
        c /= size_of_guess;
    }
    const double off = refine_mechanism(h, after.slot(), inverse, kept, mechanism);
    const double length = euclidean_norm(mechanism);
    if (!(off < 0.1 * length)) { // cost: then given up
        return std::nullopt;
    }
    // exchange.md V8
    const double along = std::sqrt(length * length - off * off) * (1 - 1e-9); // component on the null vector
    std::vector<double> z;
    const double open = balancing_forces(h, mechanism, inverse, z);
    const double lost = (off + open) / along * slack;
    if (!(lost < 0.5)) { // cost: then given up
        return std::nullopt;
    }
    const double inverse_norm = std::hypot(1 / kept, euclidean_norm(z) * slack / along) / (1 - lost) * slack;
    const double sigma = 1 / inverse_norm * (1 - 4 * u);
    if (!(sigma > 0)) {
        return std::nullopt;
    }
    const InverseBound carried{Verdict::proved, sigma, InverseBound::Route::carried, started_with};
    return ProvedExchange{carried, RegularityProver::proof(h, sigma)};
}

} // namespace isostat
