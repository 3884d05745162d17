#include "checker/singular_value.hpp"

#include "checker/index.hpp"
#include "checker/wide.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <span>

namespace isostat::checker {

namespace {

/// Entries of A and of the factor are integers times 2^-point, in units of a power of two above all of A.
constexpr long point = 54;
/// Sums of magnitudes of products stay below 2^125 (K15).
constexpr double largest_square = 0x1p16;
/// Entries of the residual, of which up to 2^24 are added.
constexpr long residual_bits = 100;
constexpr int most_rows = 1 << 24;

/// value * 2^shift, rounded towards zero. \pre it fits.
std::int64_t whole_part(const Integer& value, long shift) {
    Integer result;
    if (shift >= 0) {
        mpz_mul_2exp(result.get_mpz_t(), value.get_mpz_t(), static_cast<mp_bitcnt_t>(shift));
    } else {
        mpz_tdiv_q_2exp(result.get_mpz_t(), value.get_mpz_t(), static_cast<mp_bitcnt_t>(-shift));
    }
    return result.get_si();
}
std::int64_t whole_part(Wide value, long shift) {
    if (shift >= 0) {
        return static_cast<std::int64_t>(value << static_cast<unsigned long>(shift));
    }
    const auto size = static_cast<std::int64_t>(magnitude(value) >> static_cast<unsigned long>(-shift));
    return value < 0 ? -size : size;
}

/// A rounded to fixed point, and B = A^T A of what is left, in a given order of the degrees of freedom.
struct Normal {
    long scale = 0;           ///< A is below 2^scale units of the problem
    std::size_t touching = 1; ///< most entries in a column or row of A
    int most_periods = 1;     ///< the largest factor of an entry, which multiplies its rounding
    bool usable = false;
    /// The lower triangle of B row by row, columns in any order; times 2^(2 point).
    std::vector<std::size_t> start{0};
    std::vector<int> column;
    std::vector<Wide> value;

    Normal(const Problem& problem, const std::vector<int>& order) : place_(order.size()) {
        for (std::size_t k = 0; k < order.size(); ++k) {
            place_[at(order[k])] = static_cast<int>(k);
        }
        if (problem.dofs() > most_rows || !(problem.stored.narrow() ? round<Wide>(problem) : round<Integer>(problem))) {
            return;
        }
        for (const std::vector<int>& contacts : problem.contacts_of) {
            touching = std::max(touching, contacts.size());
        }
        usable = static_cast<double>(touching) <= largest_square && // an entry of B is at most that
                 std::ranges::none_of(problem.contacts_of, &std::vector<int>::empty);
        if (usable) {
            multiply(problem, order);
        }
    }

    /// What entries of a column or row of A are off by together, in units of 2^-point of the scale.
    [[nodiscard]] unsigned long rounding() const { return touching * static_cast<unsigned long>(most_periods); }

  private:
    struct Entry {
        int place;
        std::int64_t value;
    };
    std::vector<int> place_;            ///< of each degree of freedom in the order
    std::vector<Entry> entries_;        ///< row by row
    std::vector<std::size_t> first_{0}; ///< of each row

    [[nodiscard]] std::span<const Entry> entries_of(int contact) const {
        return std::span(entries_).subspan(first_[at(contact)], first_[at(contact) + 1] - first_[at(contact)]);
    }

    /// Entries of A, rounded towards zero by less than `most_periods`. False: a separation is above twice the length at
    /// which some contact is closed.
    template <class Number> bool round(const Problem& problem) {
        scale = problem.weight_bits + 1;
        entries_.reserve(4 * problem.rows.size());
        first_.reserve(problem.rows.size() + 1);
        const std::vector<Number>& sum = problem.sum.in<Number>();
        const std::vector<Number>& stored = problem.stored.in<Number>();
        for (std::size_t l = 0; l < problem.rows.size(); ++l) {
            const Row& contact = problem.rows[l];
            scale = std::max(scale, contact.quadratic ? bits(sum[l]) + 1 : 0);
            for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
                most_periods = std::max(most_periods, std::abs(contact.sign[k]));
            }
        }
        const long factors = std::bit_width(static_cast<unsigned>(most_periods - 1));
        scale += factors;
        Number entry;
        for (const Row& contact : problem.rows) {
            std::array<std::int64_t, most_axes> separation{};
            for (std::size_t a = 0; a < problem.layout.axes(); ++a) {
                if (contact.quadratic) {
                    contact.separate(stored, a, entry);
                } else {
                    entry = number<Number>(problem.weight());
                }
                if (bits(entry) > scale - factors) {
                    return false;
                }
                separation[a] = whole_part(entry, point - scale);
            }
            for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
                if (const int dof = problem.dof_of[at(contact.coordinate[k])]; dof >= 0) {
                    entries_.push_back({place_[at(dof)], contact.sign[k] * separation[contact.axis[k]]});
                }
            }
            touching = std::max(touching, entries_.size() - first_.back());
            first_.push_back(entries_.size());
        }
        return true;
    }

    void multiply(const Problem& problem, const std::vector<int>& order) {
        std::vector<Wide> sum(order.size(), 0);
        std::vector<int> last(order.size(), -1); // the row in which a column was met last
        for (int i = 0; at(i) < order.size(); ++i) {
            for (const int l : problem.contacts_of[at(order[at(i)])]) {
                const auto entries = entries_of(l);
                const Wide own = std::ranges::find(entries, i, &Entry::place)->value;
                for (const Entry& e : entries) {
                    if (e.place > i) {
                        continue;
                    }
                    if (std::exchange(last[at(e.place)], i) != i) {
                        column.push_back(e.place);
                    }
                    sum[at(e.place)] += own * e.value;
                }
            }
            for (std::size_t p = start.back(); p < column.size(); ++p) {
                value.push_back(std::exchange(sum[at(column[p])], 0));
            }
            start.push_back(column.size());
        }
    }
};

/// A lower triangular matrix L of integers times 2^-point, and what B - L L^T - shift I is, which is exact.
class Factor {
  public:
    explicit Factor(const Normal& b)
        : b_(b), n_(b.start.size() - 1), parent_(n_, -1), met_(n_, -1), diagonal_(n_), row_sum_(n_), x_(n_, 0) {
        find_parents();
        std::vector<std::size_t> count(n_, 0);
        for (int i = 0; at(i) < n_; ++i) {
            for (const int k : columns_of(i)) {
                ++count[at(k)];
                column_.push_back(k);
            }
            first_.push_back(column_.size());
        }
        start_.resize(n_ + 1, 0);
        std::partial_sum(count.begin(), count.end(), start_.begin() + 1);
        row_.resize(start_.back());
        value_.resize(start_.back());
    }

    /// Row by row. False: the matrix is not positive definite as far as is seen, or an entry is too large.
    bool compute(Wide shift) {
        std::fill(row_sum_.begin(), row_sum_.end(), 0);
        std::fill(x_.begin(), x_.end(), 0);
        end_.assign(start_.begin(), start_.end() - 1);
        for (int i = 0; at(i) < n_; ++i) {
            if (!compute_row(i, shift)) {
                return false;
            }
        }
        return true;
    }

    /// Largest row sum of magnitudes of B - L L^T - shift I, times 2^(2 point).
    [[nodiscard]] Integer residual_norm() const {
        return integer_of(static_cast<Wide>(*std::ranges::max_element(row_sum_)));
    }

    /// An estimate of the smallest eigenvalue of L L^T by some inverse iterations, seldom much above it.
    [[nodiscard]] double smallest_eigenvalue() const {
        constexpr int steps = 8;
        Eigen::VectorXd x(static_cast<Eigen::Index>(n_));
        std::uint32_t state = 1;
        for (double& component : x) { // any vector serves, but always the same one
            state = 1664525U * state + 1013904223U;
            component = static_cast<double>(state) * 0x1p-32 - 0.5;
        }
        double eigenvalue = 0;
        for (int step = 0; step < steps; ++step) {
            x /= x.norm();
            Eigen::VectorXd y = x;
            solve(y);
            eigenvalue = 1 / x.dot(y);
            x = y;
        }
        return eigenvalue;
    }

  private:
    /// The columns of row i, each before its parent.
    std::span<const int> columns_of(int i) {
        reach_.resize(n_);
        std::size_t top = n_;
        met_[at(i)] = i;
        for (std::size_t p = b_.start[at(i)]; p < b_.start[at(i) + 1]; ++p) {
            std::size_t length = 0;
            for (int k = b_.column[p]; met_[at(k)] != i; k = parent_[at(k)]) {
                if (parent_[at(k)] < 0) {
                    leads_ = false;
                    break;
                }
                met_[at(k)] = i;
                reach_[length++] = k;
            }
            while (length > 0) {
                reach_[--top] = reach_[--length];
            }
        }
        return std::span(reach_).subspan(top);
    }

    /// Of each column the first row below the diagonal (Liu), with ancestors as shortcuts.
    void find_parents() {
        std::vector<int> ancestor(n_, -1);
        for (int i = 0; at(i) < n_; ++i) {
            for (std::size_t p = b_.start[at(i)]; p < b_.start[at(i) + 1]; ++p) {
                for (int k = b_.column[p]; k >= 0 && k < i;) {
                    const int next = std::exchange(ancestor[at(k)], i);
                    if (next < 0) {
                        parent_[at(k)] = i;
                    }
                    k = next;
                }
            }
        }
    }

    bool compute_row(int i, Wide shift) {
        for (std::size_t p = b_.start[at(i)]; p < b_.start[at(i) + 1]; ++p) {
            x_[at(b_.column[p])] = b_.value[p];
        }
        Wide square = std::exchange(x_[at(i)], 0) - shift; // of the diagonal entry, in the end
        for (std::size_t c = first_[at(i)]; c < first_[at(i) + 1]; ++c) {
            const int k = column_[c];
            const Wide sought = std::exchange(x_[at(k)], 0);
            const double quotient = as_double(sought) / static_cast<double>(diagonal_[at(k)]);
            if (!(std::abs(quotient) < 0x1p62)) {
                return false;
            }
            const auto entry = static_cast<std::int64_t>(quotient);
            square -= static_cast<Wide>(entry) * entry;
            if (square <= 0 || !add_residual(i, k, sought - static_cast<Wide>(entry) * diagonal_[at(k)])) {
                return false;
            }
            for (std::size_t p = start_[at(k)]; p < end_[at(k)]; ++p) {
                x_[at(row_[p])] -= static_cast<Wide>(entry) * value_[p];
            }
            row_[end_[at(k)]] = i;
            value_[end_[at(k)]++] = entry;
        }
        diagonal_[at(i)] = square > 0 ? static_cast<std::int64_t>(std::sqrt(as_double(square))) : 0;
        return leads_ && diagonal_[at(i)] > 0 &&
               add_residual(i, i, square - static_cast<Wide>(diagonal_[at(i)]) * diagonal_[at(i)]);
    }

    bool add_residual(int i, int k, Wide residual) {
        const WideMagnitude size = magnitude(residual);
        row_sum_[at(i)] += size;
        row_sum_[at(k)] += i != k ? size : 0;
        return size >> residual_bits == 0;
    }

    /// x becomes (L L^T)^-1 x.
    void solve(Eigen::VectorXd& x) const {
        const auto entry = [](std::int64_t value) { return std::ldexp(static_cast<double>(value), -point); };
        const auto component = [&x](auto k) -> double& { return x(static_cast<Eigen::Index>(k)); };
        for (std::size_t k = 0; k < n_; ++k) {
            component(k) /= entry(diagonal_[k]);
            for (std::size_t p = start_[k]; p < end_[k]; ++p) {
                component(row_[p]) -= entry(value_[p]) * component(k);
            }
        }
        for (std::size_t k = n_; k-- > 0;) {
            for (std::size_t p = start_[k]; p < end_[k]; ++p) {
                component(k) -= entry(value_[p]) * component(row_[p]);
            }
            component(k) /= entry(diagonal_[k]);
        }
    }

    const Normal& b_;
    std::size_t n_;
    std::vector<int> parent_; ///< above its column
    bool leads_ = true;       ///< all paths along parents that were gone led to their row
    std::vector<int> met_;    ///< the last row whose columns were sought
    std::vector<int> reach_;
    std::vector<std::size_t> first_{0}; ///< of row i in the list of columns, each before its parent
    std::vector<int> column_;
    std::vector<std::size_t> start_, end_; ///< of the columns below the diagonal: rows ascend
    std::vector<int> row_;
    std::vector<std::int64_t> value_;
    std::vector<std::int64_t> diagonal_;
    std::vector<WideMagnitude> row_sum_; ///< of the residual
    std::vector<Wide> x_;                ///< the row that is computed; 0 elsewhere
};

/// The bound from factors for a shift that is a part of 1; nothing: they show none.
std::optional<Rational> bound_of(const Problem& problem, const Normal& normal, Factor& factor, double shift) {
    const Wide exact_shift = static_cast<Wide>(std::ldexp(shift, 2 * point)); // towards zero
    if (!factor.compute(exact_shift)) {
        return std::nullopt;
    }
    // sigma^2 of the rounded matrix in units of 2^-(2 point), and the rounding of each entry of A.
    const Integer square = integer_of(exact_shift) - factor.residual_norm();
    if (square <= 0) {
        return std::nullopt;
    }
    const Integer sigma = sqrt(square) - Integer(normal.rounding());
    return sigma > 0 ? std::optional(Rational(sigma) * power_of_two(normal.scale + problem.fine - point))
                     : std::nullopt;
}

} // namespace

std::vector<int> order_of_normal(const Structure& structure) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t l = 0; l < structure.rows.size(); ++l) {
        for (int k = 0; k < structure.rows[l].count; ++k) {
            if (const int dof = structure.dof_of[at(structure.rows[l].coordinate[at(k)])]; dof >= 0) {
                entries.emplace_back(static_cast<int>(l), dof, 1);
            }
        }
    }
    const auto n = static_cast<Eigen::Index>(structure.coordinate_of.size());
    Eigen::SparseMatrix<double> a(static_cast<Eigen::Index>(structure.rows.size()), n);
    a.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SparseMatrix<double> b = a.transpose() * a;
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(b, order);
    return {order.indices().begin(), order.indices().end()};
}

std::optional<Rational> smallest_singular_value(const Problem& problem, const std::vector<int>& order, double enough) {
    const Normal normal(problem, order.size() == problem.coordinate_of.size() ? order : order_of_normal(problem));
    if (!normal.usable) {
        return std::nullopt;
    }
    Factor factor(normal);
    if (enough > 0) {
        if (auto bound = bound_of(problem, normal, factor, enough * enough)) {
            return bound;
        }
    }
    if (!factor.compute(0)) {
        return std::nullopt;
    }
    double shift = factor.smallest_eigenvalue();
    for (int attempt = 0; attempt < 3; ++attempt) {
        shift *= attempt == 0 ? 0.7 : 0.2;
        if (!(shift > 0 && shift < 1)) {
            return std::nullopt;
        }
        if (auto bound = bound_of(problem, normal, factor, shift)) {
            return bound;
        }
    }
    return std::nullopt;
}

} // namespace isostat::checker
