#include "checker/bounds.hpp"
#include "checker/index.hpp"
#include "checker/inverse.hpp"
#include "checker/normal_factor.hpp"
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
constexpr long point = 54; // checker.md K15
/// Sums of magnitudes of products stay below 2^125 (K15).
constexpr double largest_square = 0x1p16; // checker.md K15
/// Entries of the residual, of which up to 2^24 are added.
constexpr long residual_bits = 100; // checker.md K15
constexpr int most_rows = 1 << 24;  // checker.md K15

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

/// The entries of A, row by row, as they are read. `Value`: integers, or doubles.
template <class Value> struct Entries : SparseRows<Value> {
    using SparseRows<Value>::first, SparseRows<Value>::column, SparseRows<Value>::value;
    long scale = 0;           ///< A is below 2^scale units of the problem
    std::size_t touching = 1; ///< most entries in a column or row of A
    int most_periods = 1;     ///< the largest factor of an entry, which multiplies its rounding

    /// What entries of a column or row are off by together, in units of what one separation is.
    [[nodiscard]] unsigned long rounding() const { return touching * static_cast<unsigned long>(most_periods); }

    /// `places`: columns of the degrees of freedom, or empty. `rounded(separation, scale)`: as a number. False: a
    /// separation is above twice the length at which some contact is closed.
    template <class Number, class Rounded>
    bool read(const Problem& problem, const std::vector<int>& places, const Rounded& rounded) {
        scale = problem.weight_bits + 1;
        const std::vector<Number>& sum = problem.sum.in<Number>();
        for (std::size_t l = 0; l < problem.rows.size(); ++l) {
            const Row& contact = problem.rows[l];
            scale = std::max(scale, contact.quadratic ? bits(sum[l]) + 1 : 0);
            for (std::size_t k = 0; k < at(contact.count); ++k) {
                most_periods = std::max(most_periods, std::abs(contact.sign[k]));
            }
        }
        const long factors = std::bit_width(static_cast<unsigned>(most_periods - 1));
        scale += factors;
        column.reserve(4 * problem.rows.size()); // cost: memory
        value.reserve(column.capacity());
        touching = std::max(touching, problem.contacts_of.lengths().second);
        Number entry;
        for (const Row& contact : problem.rows) {
            std::array<Value, most_axes> separation{};
            for (std::size_t a = 0; a < problem.layout.axes(); ++a) {
                if (contact.quadratic) {
                    contact.separate(problem.stored.in<Number>(), a, entry);
                } else {
                    entry = number<Number>(problem.weight());
                }
                if (bits(entry) > scale - factors) {
                    return false;
                }
                separation[a] = rounded(entry, scale);
            }
            for (std::size_t k = 0; k < at(contact.count); ++k) {
                if (const int dof = problem.dof_of[at(contact.coordinate[k])]; dof >= 0) {
                    column.push_back(places.empty() ? dof : places[at(dof)]);
                    value.push_back(contact.sign[k] * separation[contact.axis[k]]);
                }
            }
            touching = std::max(touching, column.size() - first.back());
            first.push_back(column.size());
        }
        return true;
    }
};

/// A rounded to fixed point, and B = A^T A of what is left, in a given order of the degrees of freedom.
struct Normal : Entries<std::int64_t> {
    bool usable = false;
    /// The lower triangle of B row by row, its columns `below` in any order; times 2^(2 point).
    std::vector<std::size_t> start{0};
    std::vector<int> below;
    std::vector<Wide> product;

    Normal(const Problem& problem, const std::vector<int>& order) {
        std::vector<int> places(order.size());
        for (std::size_t k = 0; k < order.size(); ++k) {
            places[at(order[k])] = static_cast<int>(k);
        }
        const auto whole = [](const auto& entry, long exponent) { return whole_part(entry, point - exponent); };
        if (problem.dofs() > most_rows ||
            !(problem.stored.narrow() ? read<Wide>(problem, places, whole) : read<Integer>(problem, places, whole))) {
            return;
        }
        usable = static_cast<double>(touching) <= largest_square && // an entry of B is at most that
                 problem.contacts_of.lengths().first > 0;
        if (usable) {
            multiply(problem, order);
        }
    }

  private:
    void multiply(const Problem& problem, const std::vector<int>& order) {
        std::vector<Wide> sum(order.size(), 0);
        std::vector<int> last(order.size(), -1); // the row in which a column was met last
        for (int i = 0; at(i) < order.size(); ++i) {
            for (const int l : problem.contacts_of[at(order[at(i)])]) {
                std::size_t mine = first[at(l)];
                while (column[mine] != i) {
                    ++mine;
                }
                for (std::size_t e = first[at(l)]; e < first[at(l) + 1]; ++e) {
                    const int k = column[e];
                    if (k > i) {
                        continue;
                    }
                    if (std::exchange(last[at(k)], i) != i) {
                        below.push_back(k);
                    }
                    sum[at(k)] += static_cast<Wide>(value[mine]) * value[e];
                }
            }
            for (std::size_t p = start.back(); p < below.size(); ++p) {
                product.push_back(std::exchange(sum[at(below[p])], 0));
            }
            start.push_back(below.size());
        }
    }
};

/// A lower triangular matrix L of integers times 2^-point, and what B - L L^T - shift I is, which is exact.
class Factor {
  public:
    explicit Factor(const Normal& b)
        : b_(b), n_(b.start.size() - 1),
          pattern_(n_,
                   [&b](int i, const auto& visit) {
                       std::for_each_n(b.below.begin() + static_cast<std::ptrdiff_t>(b.start[at(i)]),
                                       b.start[at(i) + 1] - b.start[at(i)], visit);
                   }),
          row_(pattern_.column.size()), value_(row_.size()), diagonal_(n_), row_sum_(n_), x_(n_, 0) {}

    /// Row by row. False: the matrix is not positive definite as far as is seen, or an entry is too large.
    bool compute(Wide shift) {
        std::fill(row_sum_.begin(), row_sum_.end(), 0);
        std::fill(x_.begin(), x_.end(), 0);
        end_.assign(pattern_.start.begin(), pattern_.start.end() - 1);
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
        constexpr int steps = 8; // guess: iterations
        Eigen::VectorXd x(static_cast<Eigen::Index>(n_));
        std::uint32_t state = 1;
        for (double& component : x) {                               // any vector serves, but always the same one
            state = 1664525U * state + 1013904223U;                 // guess: random numbers
            component = static_cast<double>(state) * 0x1p-32 - 0.5; // guess: start of the iteration
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
    bool compute_row(int i, Wide shift) {
        for (std::size_t p = b_.start[at(i)]; p < b_.start[at(i) + 1]; ++p) {
            x_[at(b_.below[p])] = b_.product[p];
        }
        Wide square = std::exchange(x_[at(i)], 0) - shift; // of the diagonal entry, in the end
        for (std::size_t c = pattern_.first[at(i)]; c < pattern_.first[at(i) + 1]; ++c) {
            const int k = pattern_.column[c];
            const Wide sought = std::exchange(x_[at(k)], 0);
            const double quotient = as_double(sought) / static_cast<double>(diagonal_[at(k)]);
            if (!(std::abs(quotient) < 0x1p62)) { // checker.md K15 (quotients)
                return false;
            }
            const auto entry = static_cast<std::int64_t>(quotient);
            square -= static_cast<Wide>(entry) * entry;
            if (square <= 0 || !add_residual(i, k, sought - static_cast<Wide>(entry) * diagonal_[at(k)])) {
                return false;
            }
            for (std::size_t p = pattern_.start[at(k)]; p < end_[at(k)]; ++p) {
                x_[at(row_[p])] -= static_cast<Wide>(entry) * value_[p];
            }
            row_[end_[at(k)]] = i;
            value_[end_[at(k)]++] = entry;
        }
        diagonal_[at(i)] = square > 0 ? static_cast<std::int64_t>(std::sqrt(as_double(square))) : 0;
        return diagonal_[at(i)] > 0 &&
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
            for (std::size_t p = pattern_.start[k]; p < end_[k]; ++p) {
                component(row_[p]) -= entry(value_[p]) * component(k);
            }
        }
        for (std::size_t k = n_; k-- > 0;) {
            for (std::size_t p = pattern_.start[k]; p < end_[k]; ++p) {
                component(k) -= entry(value_[p]) * component(row_[p]);
            }
            component(k) /= entry(diagonal_[k]);
        }
    }

    const Normal& b_;
    std::size_t n_;
    FactorPattern pattern_;
    std::vector<std::size_t> end_; ///< of what was computed of each column
    std::vector<int> row_;         ///< below the diagonal, column by column: rows ascend
    std::vector<std::int64_t> value_;
    std::vector<std::int64_t> diagonal_;
    std::vector<WideMagnitude> row_sum_; ///< of the residual
    std::vector<Wide> x_;                ///< the row that is computed; 0 elsewhere
};

/// The bound from doubles (K30); nothing: they show none, or lengths have more than 128 bits.
std::optional<Rational> bound_in_double(const Problem& problem, const std::vector<int>& order, double shift) {
    Entries<double> a;
    const auto rounded = [](Wide separation, long exponent) { return approximate(Broad(separation), -exponent); };
    if (!problem.stored.narrow() || !a.read<Wide>(problem, {}, rounded)) {
        return {};
    }
    const auto factor = normal_factor(problem.layout.dimension, a, order);
    if (!factor->compute(shift)) {
        return {};
    }
    const double square = next_below(shift - factor->residual(shift));
    if (!(square > 0)) {
        return {};
    }
    // checker.md K30 (rounding of an entry)
    const Rational bound = Rational(next_below(std::sqrt(square))) - dyadic(a.rounding(), -51);
    return bound > 0 ? std::optional<Rational>(bound * power_of_two(a.scale + problem.fine)) : std::nullopt;
}

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
    const std::vector<int> sought = order.size() == problem.coordinate_of.size() ? order : order_of_normal(problem);
    if (enough > 0) {
        if (auto bound = bound_in_double(problem, sought, enough * enough)) {
            return bound;
        }
    }
    const Normal normal(problem, sought);
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
    for (int attempt = 0; attempt < 3; ++attempt) { // cost: shifts tried
        shift *= attempt == 0 ? 0.7 : 0.2;          // 0.7: guess: shift (checker.md K15); 0.2: guess: shift
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
