#include "checker/inverse.hpp"

#include "checker/elimination.hpp"
#include "checker/wide.hpp"

#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

namespace isostat::checker {

namespace {

/// A column by column (one per degree of freedom), in units of the stored coordinates: 2^(fine + spare).
template <class Number> struct Columns {
    std::vector<std::size_t> start{0};
    std::vector<int> contact;
    std::vector<Number> value;
};

Columns<Integer> columns_of(const Problem& problem) {
    Columns<Integer> columns;
    for (int j = 0; j < problem.dofs(); ++j) {
        const int coordinate = problem.coordinate_of[static_cast<std::size_t>(j)];
        for (const int l : problem.contacts_of[static_cast<std::size_t>(j)]) {
            const Row& row = problem.rows[static_cast<std::size_t>(l)];
            int k = 0;
            while (row.coordinate[static_cast<std::size_t>(k)] != coordinate) {
                ++k;
            }
            Integer value;
            mpz_tdiv_q_2exp(value.get_mpz_t(), problem.entry(l, k, problem.stored).get_mpz_t(),
                            static_cast<mp_bitcnt_t>(problem.spare)); // exact
            columns.contact.push_back(l);
            columns.value.push_back(value);
        }
        columns.start.push_back(columns.contact.size());
    }
    return columns;
}

/// Sums of magnitudes in double: one rounding for each term and one for each addition, so the exact sum is at most
/// `inflation` times the computed one (K3). Values are in units that keep them far from over- and underflow.
struct Sums {
    explicit Sums(int size)
        // 8: checker.md K3; 8.0: checker.md K3; 0x1p-53: exact: u, the unit of rounding
        : inflation(1 + 8 * (size + 8.0) * 0x1p-53), column(static_cast<std::size_t>(size)),
          residual_column(static_cast<std::size_t>(size)) {}
    double inflation;
    double row = 0;
    double quadratic = 0;
    double residual_row = 0;
    std::vector<double> column;
    std::vector<double> residual_column;

    [[nodiscard]] InverseBound bound(const Problem& problem, const char* arithmetic) const {
        const auto up = [this](double sum) -> Rational { return Rational(sum) * Rational(inflation); };
        const Rational per_length = power_of_two(-(problem.fine + problem.spare));
        InverseBound result;
        const auto finite = [](double sum) { return std::isfinite(sum); };
        if (!finite(row) || !finite(residual_row) || !std::all_of(column.begin(), column.end(), finite) ||
            !std::all_of(residual_column.begin(), residual_column.end(), finite)) {
            return result;
        }
        result.arithmetic = arithmetic;
        result.residual_row = up(residual_row);
        result.residual_column = up(*std::max_element(residual_column.begin(), residual_column.end()));
        result.row_sum = up(row) * per_length;
        result.quadratic_sum = up(quadratic) * per_length;
        for (const double sum : column) {
            result.column_sum.push_back(up(sum) * per_length);
        }
        result.column_sum_max = *std::max_element(result.column_sum.begin(), result.column_sum.end());
        result.found = result.residual_row < 1 && result.residual_column < 1;
        if (result.quadratic_sum != 0) {
            result.regular_within = (1 - result.residual_row) / (problem.row_curvature() * result.quadratic_sum);
        }
        return result;
    }
};

long bits_of_count(int count) {
    return bits(Integer(count));
}

/// The columns in 64 bits, and the bits of their largest entry; nothing: an entry has more than 60.
std::optional<std::pair<Columns<std::int64_t>, long>> narrow(const Columns<Integer>& exact) {
    Columns<std::int64_t> a;
    a.start = exact.start;
    a.contact = exact.contact;
    long entry_bits = 1;
    for (const Integer& value : exact.value) {
        entry_bits = std::max(entry_bits, bits(value));
        if (entry_bits > 60) { // cost: then longer rows
            return {};
        }
        a.value.push_back(value.get_si());
    }
    return {{std::move(a), entry_bits}};
}

/// Rows of R as 64-bit integers times 2^-t, t chosen row by row so that no product or sum leaves 128 bits.
class Fixed64Rows {
  public:
    /// `rescale`: x of the solver is R in units of 2^rescale.
    Fixed64Rows(const Problem& problem, const Columns<std::int64_t>& columns, long entry_bits, long rescale)
        : problem_(problem), columns_(columns), rescale_(rescale),
          // 62: checker.md K3 (64-bit entries); 124: checker.md K3
          row_bits_(std::min(62L, 124 - entry_bits - bits_of_count(problem.dofs()))),
          // checker.md K3
          largest_shift_(125 - bits_of_count(problem.dofs())), r_(static_cast<std::size_t>(problem.dofs())),
          sums_(problem.dofs()) {}

    /// |r_l| < 2^row_bits, |a| < 2^entry_bits, at most n terms
    /// and the identity: below 2^126. False: r has too few bits.
    [[nodiscard]] bool fits() const { return row_bits_ >= 30; } // cost: then longer rows
    [[nodiscard]] InverseBound bound() const { return sums_.bound(problem_, "64-bit integers"); }

    /// Adds a row as the solver found it. False: the row is not finite, or its residual reaches 1.
    template <class Row> bool add(int row, const Row& x) {
        const double largest = x.template lpNorm<Eigen::Infinity>();
        if (!(largest > 0) || !x.allFinite()) {
            return false;
        }
        const long shift = std::min(row_bits_ - 1 - std::ilogb(largest) - rescale_, largest_shift_);
        if (shift < 1) {
            return false;
        }
        const double factor = std::ldexp(1.0, static_cast<int>(shift + rescale_));
        const double down = std::ldexp(1.0, static_cast<int>(-shift));
        WideMagnitude row_sum = 0;
        WideMagnitude quadratic_sum = 0;
        for (std::size_t l = 0; l < r_.size(); ++l) {
            r_[l] = std::llrint(x(static_cast<Eigen::Index>(l)) * factor);
            const WideMagnitude size = magnitude(r_[l]);
            row_sum += size;
            quadratic_sum += problem_.rows[l].quadratic ? size : 0;
            sums_.column[l] += static_cast<double>(std::abs(r_[l])) * down;
        }
        sums_.row = std::max(sums_.row, static_cast<double>(row_sum) * down);
        sums_.quadratic = std::max(sums_.quadratic, static_cast<double>(quadratic_sum) * down);
        return add_residual(row, shift, down);
    }

  private:
    /// 2^shift e_row - r A. False: an entry reaches 2^shift.
    bool add_residual(int row, long shift, double down) {
        const WideMagnitude one = static_cast<WideMagnitude>(1) << static_cast<unsigned>(shift);
        WideMagnitude sum = 0;
        for (std::size_t j = 0; j < r_.size(); ++j) {
            Wide s = j == static_cast<std::size_t>(row) ? -static_cast<Wide>(one) : 0;
            for (std::size_t p = columns_.start[j]; p < columns_.start[j + 1]; ++p) {
                s += static_cast<Wide>(r_[static_cast<std::size_t>(columns_.contact[p])]) * columns_.value[p];
            }
            const WideMagnitude size = magnitude(s);
            if (size >= one) {
                return false;
            }
            sum += size;
            sums_.residual_column[j] += static_cast<double>(size) * down;
        }
        sums_.residual_row = std::max(sums_.residual_row, static_cast<double>(sum) * down);
        return true;
    }

    const Problem& problem_;
    const Columns<std::int64_t>& columns_;
    long rescale_, row_bits_, largest_shift_;
    std::vector<std::int64_t> r_; ///< the current row
    Sums sums_;
};

InverseBound bound_fixed64(const Problem& problem, const Solver& solver, const Columns<Integer>& exact) {
    const int n = problem.dofs();
    const auto narrowed = narrow(exact);
    if (!narrowed) {
        return {};
    }
    // x of the solver is (A / 2^scale)^-1 in units of `fine`; in the units here the entries of A are 2^-spare as large.
    Fixed64Rows sums(problem, narrowed->first, narrowed->second, problem.spare - solver.scale(problem));
    if (!sums.fits()) {
        return {};
    }
    constexpr int block = 16; // cost: rows at a time
    for (int first = 0; first < n; first += block) {
        const int width = std::min(block, n - first);
        Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(n, width);
        for (int k = 0; k < width; ++k) {
            unit(first + k, k) = 1;
        }
        const Eigen::MatrixXd rows = solver.solve_transposed(unit);
        for (int k = 0; k < width; ++k) {
            if (!sums.add(first + k, rows.col(k))) {
                return {};
            }
        }
    }
    return sums.bound();
}

/// Rows of R as GMP integers times 2^-shift.
class GmpRows {
  public:
    GmpRows(const Problem& problem, const Columns<Integer>& columns)
        : problem_(problem), columns_(columns), sums_(problem.dofs()) {
        for (const Integer& value : columns.value) {
            entry_bits_ = std::max(entry_bits_, bits(value));
        }
        shift_ = entry_bits_ + 2 * bits_of_count(problem.dofs()) + 64; // cost: bits of the rows
    }
    [[nodiscard]] long shift() const { return shift_; }
    [[nodiscard]] InverseBound bound(const char* arithmetic) const { return sums_.bound(problem_, arithmetic); }

    /// 2^shift e_row - r A.
    [[nodiscard]] std::vector<Integer> residual(int row, const std::vector<Integer>& r) const {
        std::vector<Integer> result(r.size());
        for (std::size_t j = 0; j < r.size(); ++j) {
            Integer s = j == static_cast<std::size_t>(row) ? shifted_left(1, shift_) : Integer(0);
            for (std::size_t p = columns_.start[j]; p < columns_.start[j + 1]; ++p) {
                s -= r[static_cast<std::size_t>(columns_.contact[p])] * columns_.value[p];
            }
            result[j] = s;
        }
        return result;
    }
    void add(const std::vector<Integer>& r, const std::vector<Integer>& residual) {
        Integer row;
        Integer quadratic;
        Integer error;
        for (std::size_t l = 0; l < r.size(); ++l) {
            const Integer size = abs(r[l]);
            row += size;
            quadratic += problem_.rows[l].quadratic ? size : Integer(0);
            sums_.column[l] += up(size);
        }
        for (std::size_t j = 0; j < r.size(); ++j) {
            const Integer size = abs(residual[j]);
            error += size;
            sums_.residual_column[j] += up(size);
        }
        sums_.row = std::max(sums_.row, up(row));
        sums_.quadratic = std::max(sums_.quadratic, up(quadratic));
        sums_.residual_row = std::max(sums_.residual_row, up(error));
    }

  private:
    /// Rounded down by less than one part in 2^52; tiny numbers must not vanish.
    [[nodiscard]] double up(const Integer& size) const {
        return size == 0 ? 0 : std::max(approximate(size, -shift_), 0x1p-900); // checker.md K3 (never 0)
    }
    const Problem& problem_;
    const Columns<Integer>& columns_;
    Sums sums_;
    long entry_bits_ = 1;
    long shift_ = 0;
};

/// Row by row, refined with exact residuals.
InverseBound bound_gmp(const Problem& problem, const Solver& solver, const Columns<Integer>& columns) {
    const int n = problem.dofs();
    GmpRows rows(problem, columns);
    const long to_row = rows.shift() + problem.spare - solver.scale(problem);
    const long good = rows.shift() - bits_of_count(n) - 20; // 20: guess: refinements
    for (int k = 0; k < n; ++k) {
        std::vector<Integer> r(static_cast<std::size_t>(n));
        std::vector<Integer> residual = rows.residual(k, r);
        long size = rows.shift() + 1;
        for (int step = 0; step < 20 && size > good; ++step) {
            Eigen::MatrixXd b(n, 1);
            for (int j = 0; j < n; ++j) {
                b(j, 0) = approximate(residual[static_cast<std::size_t>(j)], -rows.shift());
            }
            const Eigen::MatrixXd x = solver.solve_transposed(b);
            for (int l = 0; l < n; ++l) {
                add_scaled(r[static_cast<std::size_t>(l)], x(l, 0), to_row);
            }
            residual = rows.residual(k, r);
            long now = 0;
            for (const Integer& s : residual) {
                now = std::max(now, bits(s));
            }
            if (step > 1 && now >= size) {
                break;
            }
            size = now;
        }
        if (size >= rows.shift()) {
            return {};
        }
        rows.add(r, residual);
    }
    return rows.bound("GMP integers");
}

/// The exact inverse, rounded to fixed point.
InverseBound bound_rational(const Problem& problem, const Columns<Integer>& columns) {
    const int n = problem.dofs();
    if (n > largest_exact_matrix) {
        return {};
    }
    Matrix a(n, n);
    for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j) {
        for (std::size_t p = columns.start[j]; p < columns.start[j + 1]; ++p) {
            a.at(columns.contact[p], static_cast<int>(j)) = columns.value[p];
        }
    }
    Integer determinant;
    const Matrix adjugate = inverse_times_determinant(a, determinant);
    if (determinant == 0) {
        return {};
    }
    GmpRows rows(problem, columns);
    for (int k = 0; k < n; ++k) {
        std::vector<Integer> r;
        for (int l = 0; l < n; ++l) {
            r.emplace_back(shifted_left(adjugate.at(k, l), rows.shift()) / determinant);
        }
        rows.add(r, rows.residual(k, r));
    }
    return rows.bound("exact elimination");
}

/// An upper bound of the square root, by less than 2^-20.
Rational root(unsigned long value) {
    // 20: checker.md K15 (roots of integers); 40: checker.md K15 (roots of integers)
    return Rational(sqrt(shifted_left(Integer(value), 40)) + 1) * power_of_two(-20);
}

/// Bounds the inverse by the smallest singular value, when R is the inverse.
InverseBound bound_by_singular_value(const Problem& problem, const Solver& solver, bool roughly) {
    // choice: a bound that does at the vertices of a run (checker.md K15, K30)
    const std::optional<Rational> sigma = smallest_singular_value(problem, solver.order(), roughly ? 0x1p-18 : 0);
    if (!sigma) {
        return {};
    }
    InverseBound bound;
    bound.found = true;
    bound.arithmetic = roughly ? "double or 64-bit integers" : "64-bit integers";
    bound.singular_value = *sigma;
    const auto size = static_cast<unsigned long>(problem.dofs());
    bound.row_sum = short_above(root(size) / *sigma);
    bound.column_sum_max = bound.row_sum;
    if (problem.column_curvature() > 0) {
        bound.quadratic_sum = bound.row_sum;
        bound.regular_within = *sigma / root(problem.row_curvature() * problem.column_curvature());
    }
    return bound;
}

} // namespace

InverseBound bound_inverse(const Problem& problem, const Solver& solver, CheckerArithmetic arithmetic, bool roughly) {
    InverseBound bound;
    if (arithmetic == CheckerArithmetic::automatic || arithmetic == CheckerArithmetic::singular_value) {
        bound = bound_by_singular_value(problem, solver, roughly);
    }
    if (bound.found || arithmetic == CheckerArithmetic::singular_value) {
        return bound;
    }
    const Columns<Integer> columns = columns_of(problem);
    const auto allowed = [arithmetic](CheckerArithmetic kind) {
        return arithmetic == CheckerArithmetic::automatic || arithmetic == CheckerArithmetic::rows ||
               arithmetic == kind;
    };
    if (allowed(CheckerArithmetic::fixed64) && solver.usable()) {
        bound = bound_fixed64(problem, solver, columns);
    }
    if (!bound.found && allowed(CheckerArithmetic::gmp) && solver.usable()) {
        bound = bound_gmp(problem, solver, columns);
    }
    if (!bound.found && allowed(CheckerArithmetic::rational)) {
        bound = bound_rational(problem, columns);
    }
    return bound;
}

} // namespace isostat::checker
