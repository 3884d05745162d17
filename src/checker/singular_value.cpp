#include "checker/singular_value.hpp"

#include "checker/index.hpp"
#include "checker/wide.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cstdint>

namespace isostat::checker {

namespace {

/// Entries of A and of the factor are integers times 2^-point, in units of a power of two above all of A.
constexpr long point = 54;
/// Sums of magnitudes of products stay below 2^126 (K15).
constexpr double largest_square = 0x1p17;
/// Entries of the residual, of which up to 2^24 are added.
constexpr long residual_bits = 100;
constexpr int most_rows = 1 << 24;

using Sparse = Eigen::SparseMatrix<double>;
using Cholesky = Eigen::SimplicialLLT<Sparse, Eigen::Lower, Eigen::NaturalOrdering<int>>;

double as_double(Wide value) {
    return static_cast<double>(value);
}

Integer integer_of(WideMagnitude value) {
    constexpr unsigned half = 64;
    return shifted_left(Integer(static_cast<unsigned long>(value >> half)), half) +
           Integer(static_cast<unsigned long>(value & ~std::uint64_t{0}));
}

/// A rounded to fixed point, and B = A^T A of what is left, in an order that fills little.
struct Normal {
    long scale = 0;           ///< A is below 2^scale units of the problem
    std::size_t touching = 1; ///< most entries in a column or row of A
    bool usable = false;
    std::vector<int> place; ///< position of each degree of freedom
    /// The lower triangle of B column by column, rows ascending; times 2^(2 point).
    std::vector<std::size_t> start{0};
    std::vector<int> row;
    std::vector<Wide> value;

    explicit Normal(const Problem& problem) {
        const int n = problem.dofs();
        if (n > most_rows) {
            return;
        }
        std::vector<std::array<Integer, Row::most>> exact(problem.rows.size());
        for (int l = 0; l < n; ++l) {
            for (int k = 0; k < problem.rows[at(l)].count; ++k) {
                exact[at(l)][at(k)] = problem.entry(l, k, problem.stored);
                scale = std::max(scale, bits(exact[at(l)][at(k)]));
            }
        }
        entries_.resize(problem.rows.size());
        for (int l = 0; l < n; ++l) {
            const Row& contact = problem.rows[at(l)];
            for (int k = 0; k < contact.count; ++k) {
                const int dof = problem.dof_of[at(contact.coordinate[at(k)])];
                if (dof >= 0) {
                    entries_[at(l)].push_back({dof, fixed_point(exact[at(l)][at(k)])});
                }
            }
            touching = std::max(touching, entries_[at(l)].size());
        }
        for (const std::vector<int>& contacts : problem.contacts_of) {
            touching = std::max(touching, contacts.size());
        }
        usable = static_cast<double>(touching) <= largest_square / 2; // an entry of B is at most that
        if (usable) {
            choose_order(n);
            multiply(problem);
        }
    }

    /// B - shift I in double.
    [[nodiscard]] Sparse approximate(double shift) const {
        const auto n = static_cast<Eigen::Index>(start.size()) - 1;
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(row.size());
        for (Eigen::Index j = 0; j < n; ++j) {
            for (std::size_t p = start[static_cast<std::size_t>(j)]; p < start[static_cast<std::size_t>(j) + 1]; ++p) {
                const double b = std::ldexp(as_double(value[p]), -2 * point);
                entries.emplace_back(row[p], static_cast<int>(j), row[p] == j ? b - shift : b);
            }
        }
        Sparse b(n, n);
        b.setFromTriplets(entries.begin(), entries.end());
        return b;
    }

  private:
    struct Entry {
        int dof;
        std::int64_t value;
    };
    std::vector<std::vector<Entry>> entries_; ///< of each row

    /// Rounded towards zero, by less than one.
    [[nodiscard]] std::int64_t fixed_point(const Integer& exact) const {
        if (scale <= point) {
            return shifted_left(exact, point - scale).get_si();
        }
        Integer result;
        mpz_tdiv_q_2exp(result.get_mpz_t(), exact.get_mpz_t(), static_cast<mp_bitcnt_t>(scale - point));
        return result.get_si();
    }

    void choose_order(int n) {
        std::vector<Eigen::Triplet<double>> pattern;
        for (const std::vector<Entry>& contact : entries_) {
            for (const Entry& a : contact) {
                for (const Entry& b : contact) {
                    pattern.emplace_back(a.dof, b.dof, 1.0);
                }
            }
        }
        Sparse b(n, n);
        b.setFromTriplets(pattern.begin(), pattern.end());
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
        Eigen::AMDOrdering<int>()(b, order);
        place.resize(static_cast<std::size_t>(n));
        for (int k = 0; k < n; ++k) {
            place[at(order.indices()[k])] = k;
        }
    }

    void multiply(const Problem& problem) {
        const std::size_t n = place.size();
        std::vector<int> dof_at(n);
        for (std::size_t dof = 0; dof < n; ++dof) {
            dof_at[at(place[dof])] = static_cast<int>(dof);
        }
        std::vector<Wide> sum(n, 0);
        std::vector<int> met(n, -1);
        std::vector<int> rows;
        for (int j = 0; j < static_cast<int>(n); ++j) {
            rows.clear();
            for (const int l : problem.contacts_of[at(dof_at[at(j)])]) {
                std::int64_t own = 0;
                for (const Entry& e : entries_[at(l)]) {
                    own = e.dof == dof_at[at(j)] ? e.value : own;
                }
                for (const Entry& e : entries_[at(l)]) {
                    const int i = place[at(e.dof)];
                    if (i < j) {
                        continue;
                    }
                    if (std::exchange(met[at(i)], j) != j) {
                        sum[at(i)] = 0;
                        rows.push_back(i);
                    }
                    sum[at(i)] += static_cast<Wide>(e.value) * own;
                }
            }
            std::sort(rows.begin(), rows.end());
            for (const int i : rows) {
                row.push_back(i);
                value.push_back(sum[at(i)]);
            }
            start.push_back(row.size());
        }
    }
};

/// An estimate of the smallest eigenvalue of B by some inverse iterations, seldom much above it.
double smallest_eigenvalue(const Cholesky& factors, Eigen::Index n) {
    constexpr int steps = 8;
    Eigen::VectorXd x(n);
    std::uint32_t state = 1;
    for (Eigen::Index k = 0; k < n; ++k) { // any vector serves, but always the same one
        state = 1664525U * state + 1013904223U;
        x[k] = static_cast<double>(state) * 0x1p-32 - 0.5;
    }
    double eigenvalue = 0;
    for (int step = 0; step < steps; ++step) {
        x /= x.norm();
        const Eigen::VectorXd y = factors.solve(x);
        eigenvalue = 1 / x.dot(y);
        x = y;
    }
    return eigenvalue;
}

/// A lower triangular matrix of integers times 2^-point.
struct Factor {
    std::vector<std::size_t> start{0};
    std::vector<int> row;
    std::vector<std::int64_t> value;
    bool usable = true;

    explicit Factor(const Sparse& l) {
        std::vector<double> square(static_cast<std::size_t>(l.rows()), 0.0);
        row.reserve(static_cast<std::size_t>(l.nonZeros()));
        value.reserve(static_cast<std::size_t>(l.nonZeros()));
        for (Eigen::Index j = 0; j < l.cols(); ++j) {
            for (Sparse::InnerIterator e(l, j); e; ++e) {
                const bool in_order = row.size() == start.back() || row.back() < e.row();
                if (!(std::abs(e.value()) < 0x1p8) || !in_order) {
                    usable = false;
                    return;
                }
                row.push_back(static_cast<int>(e.row()));
                value.push_back(std::llrint(std::ldexp(e.value(), point)));
                square[static_cast<std::size_t>(e.row())] += e.value() * e.value();
            }
            start.push_back(row.size());
        }
        usable = std::all_of(square.begin(), square.end(), [](double s) { return s < largest_square / 2; });
    }
};

/// Largest row sum of magnitudes of B - L L^T - shift I, times 2^(2 point), exact; nothing when an entry is too large.
std::optional<Integer> residual_norm(const Normal& b, const Factor& l, Wide shift) {
    const std::size_t n = b.start.size() - 1;
    std::vector<WideMagnitude> row_sum(n, 0);
    std::vector<Wide> w(n, 0);
    // Columns k of L with an entry in row j, linked; `next_entry[k]` is the position of that entry.
    std::vector<int> first(n, -1);
    std::vector<int> next(n, -1);
    std::vector<std::size_t> next_entry(n);
    std::vector<int> met(n, -1);
    std::vector<int> rows;
    for (std::size_t j = 0; j < n; ++j) {
        rows.clear();
        const auto add = [&](int i, Wide value) {
            if (std::exchange(met[static_cast<std::size_t>(i)], static_cast<int>(j)) != static_cast<int>(j)) {
                w[static_cast<std::size_t>(i)] = 0;
                rows.push_back(i);
            }
            w[static_cast<std::size_t>(i)] += value;
        };
        for (std::size_t p = b.start[j]; p < b.start[j + 1]; ++p) {
            add(b.row[p], b.value[p] - (b.row[p] == static_cast<int>(j) ? shift : 0));
        }
        const auto subtract_column = [&](std::size_t from, std::size_t end) {
            const Wide factor = l.value[from]; // in row j
            for (std::size_t p = from; p < end; ++p) {
                add(l.row[p], -factor * l.value[p]);
            }
        };
        const auto wait = [&](std::size_t k, std::size_t entry) { // until the row of this entry
            next_entry[k] = entry;
            if (entry < l.start[k + 1]) {
                int& list = first[static_cast<std::size_t>(l.row[entry])];
                next[k] = std::exchange(list, static_cast<int>(k));
            }
        };
        for (int k = first[j]; k >= 0;) {
            const auto column = static_cast<std::size_t>(k);
            k = next[column];
            subtract_column(next_entry[column], l.start[column + 1]);
            wait(column, next_entry[column] + 1);
        }
        if (l.start[j] < l.start[j + 1] && l.row[l.start[j]] == static_cast<int>(j)) {
            subtract_column(l.start[j], l.start[j + 1]);
            wait(j, l.start[j] + 1);
        } else {
            return std::nullopt;
        }
        for (const int i : rows) {
            const WideMagnitude size = magnitude(w[static_cast<std::size_t>(i)]);
            if (size >> residual_bits != 0) {
                return std::nullopt;
            }
            row_sum[j] += size;
            row_sum[static_cast<std::size_t>(i)] += static_cast<std::size_t>(i) != j ? size : 0;
        }
    }
    return integer_of(*std::max_element(row_sum.begin(), row_sum.end()));
}

} // namespace

std::optional<Rational> smallest_singular_value(const Problem& problem) {
    const Normal normal(problem);
    if (!normal.usable) {
        return std::nullopt;
    }
    Cholesky factors;
    const Sparse b = normal.approximate(0);
    factors.compute(b);
    if (factors.info() != Eigen::Success) {
        return std::nullopt;
    }
    double shift = smallest_eigenvalue(factors, b.rows());
    for (int attempt = 0; attempt < 3; ++attempt) {
        shift *= attempt == 0 ? 0.7 : 0.2;
        if (!(shift > 0 && shift < 1)) {
            return std::nullopt;
        }
        factors.factorize(normal.approximate(shift));
        if (factors.info() != Eigen::Success) {
            continue;
        }
        const Factor l(Sparse(factors.matrixL()));
        if (!l.usable) {
            return std::nullopt;
        }
        const Wide exact_shift = static_cast<Wide>(std::ldexp(shift, 2 * point)); // towards zero
        const auto residual = residual_norm(normal, l, exact_shift);
        if (!residual) {
            return std::nullopt;
        }
        // sigma^2 of the rounded matrix in units of 2^-(2 point), and the rounding of each entry of A.
        const Integer square = integer_of(magnitude(exact_shift)) - *residual;
        if (square <= 0) {
            continue;
        }
        const Integer rounding(static_cast<unsigned long>(normal.touching));
        const Integer sigma = sqrt(square) - rounding;
        if (sigma > 0) {
            return Rational(sigma) * power_of_two(normal.scale + problem.fine - point);
        }
    }
    return std::nullopt;
}

} // namespace isostat::checker
