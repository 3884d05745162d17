#include "checker/singular_value.hpp"

#include "checker/index.hpp"
#include "checker/wide.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <tuple>

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
    int most_periods = 1;     ///< the largest factor of an entry, which multiplies its rounding
    bool usable = false;
    /// The lower triangle of B column by column, rows ascending; times 2^(2 point).
    std::vector<int> start{0};
    std::vector<int> row;
    std::vector<Wide> value;

    explicit Normal(const Problem& problem) {
        if (problem.dofs() > most_rows || !round(problem)) {
            return;
        }
        for (const std::vector<int>& contacts : problem.contacts_of) {
            touching = std::max(touching, contacts.size());
        }
        usable = static_cast<double>(touching) <= largest_square / 2 && // an entry of B is at most that
                 std::ranges::none_of(problem.contacts_of, &std::vector<int>::empty);
        if (usable) {
            multiply(problem);
            arrange();
        }
    }

    /// What entries of a column or row of A are off by together, in units of 2^-point of the scale.
    [[nodiscard]] unsigned long rounding() const { return touching * static_cast<unsigned long>(most_periods); }

    /// B - shift I in double.
    [[nodiscard]] Sparse approximate(double shift) const {
        const auto n = static_cast<Eigen::Index>(start.size()) - 1;
        Sparse b(n, n);
        b.resizeNonZeros(static_cast<Eigen::Index>(row.size()));
        std::copy(start.begin(), start.end(), b.outerIndexPtr());
        std::copy(row.begin(), row.end(), b.innerIndexPtr());
        std::transform(value.begin(), value.end(), b.valuePtr(),
                       [](Wide entry) { return std::ldexp(as_double(entry), -2 * point); });
        b.diagonal().array() -= shift;
        return b;
    }

  private:
    struct Entry {
        int dof;
        std::int64_t value;
    };
    std::vector<Entry> entries_;        ///< row by row
    std::vector<std::size_t> first_{0}; ///< of each row

    [[nodiscard]] std::span<const Entry> entries_of(int contact) const {
        return std::span(entries_).subspan(first_[at(contact)], first_[at(contact) + 1] - first_[at(contact)]);
    }

    /// Entries of A, rounded towards zero by less than `most_periods`. False: a separation is above twice the length at
    /// which some contact is closed.
    bool round(const Problem& problem) {
        scale = problem.weight_bits + 1;
        for (std::size_t l = 0; l < problem.rows.size(); ++l) {
            const Row& contact = problem.rows[l];
            scale = std::max(scale, contact.quadratic ? bits(problem.sum[l]) + 1 : 0);
            for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
                most_periods = std::max(most_periods, std::abs(contact.sign[k]));
            }
        }
        const long factors = std::bit_width(static_cast<unsigned>(most_periods - 1));
        scale += factors;
        Integer entry;
        for (const Row& contact : problem.rows) {
            std::array<std::int64_t, most_axes> separation{};
            for (std::size_t a = 0; a < most_axes; ++a) {
                if (contact.quadratic) {
                    contact.separate(problem.stored, a, entry);
                } else {
                    entry = problem.weight();
                }
                if (bits(entry) > scale - factors) {
                    return false;
                }
                if (scale <= point) {
                    mpz_mul_2exp(entry.get_mpz_t(), entry.get_mpz_t(), static_cast<mp_bitcnt_t>(point - scale));
                } else {
                    mpz_tdiv_q_2exp(entry.get_mpz_t(), entry.get_mpz_t(), static_cast<mp_bitcnt_t>(scale - point));
                }
                separation[a] = entry.get_si();
            }
            for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
                if (const int dof = problem.dof_of[at(contact.coordinate[k])]; dof >= 0) {
                    entries_.push_back({dof, contact.sign[k] * separation[contact.axis[k]]});
                }
            }
            touching = std::max(touching, entries_.size() - first_.back());
            first_.push_back(entries_.size());
        }
        return true;
    }

    /// B in the order of the degrees of freedom.
    void multiply(const Problem& problem) {
        const int n = problem.dofs();
        std::vector<Wide> sum(at(n), 0);
        std::vector<int> rows;
        for (int j = 0; j < n; ++j) {
            rows.clear();
            for (const int l : problem.contacts_of[at(j)]) {
                std::int64_t own = 0;
                for (const Entry& e : entries_of(l)) {
                    own = e.dof == j ? e.value : own;
                }
                for (const Entry& e : entries_of(l)) {
                    if (e.dof >= j) {
                        sum[at(e.dof)] += static_cast<Wide>(e.value) * own;
                        rows.push_back(e.dof);
                    }
                }
            }
            std::sort(rows.begin(), rows.end());
            rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
            for (const int i : rows) {
                row.push_back(i);
                value.push_back(std::exchange(sum[at(i)], 0));
            }
            start.push_back(static_cast<int>(row.size()));
        }
    }

    /// Puts B in an order that fills little.
    void arrange() {
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
        Eigen::AMDOrdering<int>()(approximate(0).selfadjointView<Eigen::Lower>(), order);
        const std::size_t n = start.size() - 1;
        std::vector<int> place(n);
        for (std::size_t k = 0; k < n; ++k) {
            place[at(order.indices()[static_cast<Eigen::Index>(k)])] = static_cast<int>(k);
        }
        struct Moved {
            int column, row;
            Wide value;
        };
        std::vector<Moved> moved;
        moved.reserve(row.size());
        for (std::size_t j = 0; j < n; ++j) {
            for (std::size_t p = at(start[j]); p < at(start[j + 1]); ++p) {
                const auto [column, below] = std::minmax(place[j], place[at(row[p])]);
                moved.push_back({column, below, value[p]});
            }
        }
        std::sort(moved.begin(), moved.end(),
                  [](const Moved& a, const Moved& b) { return std::tie(a.column, a.row) < std::tie(b.column, b.row); });
        start.assign(n + 1, 0);
        for (std::size_t p = 0; p < moved.size(); ++p) {
            start[at(moved[p].column) + 1] = static_cast<int>(p) + 1; // the last of them stays
            row[p] = moved[p].row;
            value[p] = moved[p].value;
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

/// Whether all products of entries of a column of L, and the column of B, lie where the columns of L have entries: what
/// is left of a column k below its first entry p off the diagonal lies in column p, and so on from column to column.
bool closed_under_products(const Normal& b, const Factor& l) {
    const auto rows_of = [](const auto& matrix, std::size_t j, std::size_t skipped) {
        return std::span(matrix.row)
            .subspan(static_cast<std::size_t>(matrix.start[j]) + skipped,
                     static_cast<std::size_t>(matrix.start[j + 1] - matrix.start[j]) - skipped);
    };
    for (std::size_t j = 0; j + 1 < l.start.size(); ++j) {
        const auto own = rows_of(l, j, 0);
        if (own.empty() || own[0] != static_cast<int>(j) || !std::ranges::includes(own, rows_of(b, j, 0)) ||
            (own.size() > 1 && !std::ranges::includes(rows_of(l, at(own[1]), 0), rows_of(l, j, 1)))) {
            return false;
        }
    }
    return true;
}

/// Largest row sum of magnitudes of B - L L^T - shift I, times 2^(2 point), exact; nothing when an entry is too large.
std::optional<Integer> residual_norm(const Normal& b, const Factor& l, Wide shift) {
    if (!closed_under_products(b, l)) {
        return std::nullopt;
    }
    const std::size_t n = b.start.size() - 1;
    std::vector<WideMagnitude> row_sum(n, 0);
    std::vector<Wide> w(n, 0); // of the column; 0 again afterwards
    // Columns k of L with an entry in row j, linked; `next_entry[k]` is the position of that entry.
    std::vector<int> first(n, -1);
    std::vector<int> next(n, -1);
    std::vector<std::size_t> next_entry(n);
    const auto subtract_column = [&](std::size_t k, std::size_t entry) {
        const Wide factor = l.value[entry]; // in row j
        for (std::size_t p = entry; p < l.start[k + 1]; ++p) {
            w[at(l.row[p])] -= factor * l.value[p];
        }
        next_entry[k] = entry + 1; // the column waits until the row of its next entry
        if (entry + 1 < l.start[k + 1]) {
            next[k] = std::exchange(first[at(l.row[entry + 1])], static_cast<int>(k));
        }
    };
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t p = at(b.start[j]); p < at(b.start[j + 1]); ++p) {
            w[at(b.row[p])] = b.value[p];
        }
        w[j] -= shift;
        for (int k = first[j]; k >= 0;) {
            const std::size_t column = at(k);
            k = next[column];
            subtract_column(column, next_entry[column]);
        }
        subtract_column(j, l.start[j]);
        for (std::size_t p = l.start[j]; p < l.start[j + 1]; ++p) {
            const auto i = at(l.row[p]);
            const WideMagnitude size = magnitude(std::exchange(w[i], 0));
            if (size >> residual_bits != 0) {
                return std::nullopt;
            }
            row_sum[j] += size;
            row_sum[i] += i != j ? size : 0;
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
        const Integer rounding(normal.rounding());
        const Integer sigma = sqrt(square) - rounding;
        if (sigma > 0) {
            return Rational(sigma) * power_of_two(normal.scale + problem.fine - point);
        }
    }
    return std::nullopt;
}

} // namespace isostat::checker
