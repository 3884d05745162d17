#include "exact/reduction.hpp"
#include "exact/terms.hpp"

#include <isostat/exact/number.hpp>

#include <algorithm>
#include <optional>

namespace isostat::exact {

namespace {

std::vector<const Number*> entries(const NumberMatrix& matrix) {
    std::vector<const Number*> out;
    for (const auto& column : matrix.column) {
        for (const auto& [row, value] : column) {
            out.push_back(&value);
        }
    }
    return out;
}

/// Reduced echelon form mod p of the dense image, row by row.
struct Echelon {
    std::vector<int> pivots;
    std::vector<std::vector<std::uint64_t>> row; // row r belongs to pivots[r]
};

Echelon echelon(const NumberMatrix& matrix, const Reduction& reduction, unsigned signs) {
    const PrimeField& field = reduction.field();
    const auto cols = static_cast<std::size_t>(matrix.cols());
    std::vector<std::vector<std::uint64_t>> a(static_cast<std::size_t>(matrix.rows),
                                              std::vector<std::uint64_t>(cols, 0));
    for (std::size_t j = 0; j < cols; ++j) {
        for (const auto& [i, value] : matrix.column[j]) {
            a[static_cast<std::size_t>(i)][j] = reduction.residue(value, signs);
        }
    }
    Echelon out;
    std::size_t done = 0;
    for (std::size_t j = 0; j < cols && done < a.size(); ++j) {
        std::size_t r = done;
        while (r < a.size() && a[r][j] == 0) {
            ++r;
        }
        if (r == a.size()) {
            continue;
        }
        std::swap(a[r], a[done]);
        const std::uint64_t scale = field.inverse(a[done][j]);
        for (std::size_t c = j; c < cols; ++c) {
            a[done][c] = field.multiply(a[done][c], scale);
        }
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (i != done && a[i][j] != 0) {
                const std::uint64_t factor = field.prime() - a[i][j];
                for (std::size_t c = j; c < cols; ++c) {
                    if (a[done][c] != 0) {
                        a[i][c] = field.add(a[i][c], field.multiply(factor, a[done][c]));
                    }
                }
            }
        }
        out.pivots.push_back(static_cast<int>(j));
        ++done;
    }
    a.resize(done);
    out.row = std::move(a);
    return out;
}

/// The fraction n / d with |n|, d <= sqrt(modulus / 2) that is
/// congruent to `residue`, if one exists; there is at most one.
std::optional<mpq_class> reconstruct(const mpz_class& residue, const mpz_class& modulus) {
    const mpz_class bound = ::sqrt(mpz_class(modulus / 2));
    mpz_class r0 = modulus, r1 = residue, t0 = 0, t1 = 1;
    while (r1 > bound) {
        const mpz_class q = r0 / r1;
        mpz_class next = r0 - q * r1;
        r0 = std::move(r1);
        r1 = std::move(next);
        next = t0 - q * t1;
        t0 = std::move(t1);
        t1 = std::move(next);
    }
    if (t1 == 0 || abs(t1) > bound || gcd(r1, t1) != 1) {
        return std::nullopt;
    }
    mpq_class out(r1, t1);
    out.canonicalize();
    return out;
}

/// Collects the kernel mod p over primes and choices of signs, and lifts it to exact numbers.
class Lifting {
  public:
    Lifting(const NumberMatrix& matrix, const KernelLimits& limits)
        : matrix_(matrix), limits_(limits), entries_(entries(matrix)) {}

    Kernel run() {
        int next_trial = 1;
        std::uint64_t below = largest_prime_bound;
        for (int index = 0; index < limits_.primes; ++index) {
            const Reduction reduction = Reduction::suitable(entries_, below);
            below = reduction.field().prime();
            if (reduction.root_count() > 6) { // more than 64 choices of signs: only the lower bound is given
                const Echelon image = echelon(matrix_, reduction, 0);
                out_.pivots = image.pivots;
                break;
            }
            absorb(reduction);
            ++out_.primes;
            if (used_ >= next_trial) {
                next_trial = 2 * used_;
                if (lift(reduction)) {
                    break;
                }
            }
        }
        out_.rank = static_cast<int>(out_.pivots.size());
        if (out_.exact != Verdict::proved) {
            out_.basis.clear();
            out_.free = complement(out_.pivots);
        }
        return std::move(out_);
    }

  private:
    [[nodiscard]] std::vector<int> complement(const std::vector<int>& pivots) const {
        std::vector<int> out;
        for (int j = 0; j < matrix_.cols(); ++j) {
            if (!std::ranges::binary_search(pivots, j)) {
                out.push_back(j);
            }
        }
        return out;
    }

    /// The true pivots have the highest rank, and are lexicographically
    /// first among such: a prime can only lose pivots.
    static bool better(const std::vector<int>& a, const std::vector<int>& b) {
        return a.size() != b.size() ? a.size() > b.size() : a < b;
    }

    void absorb(const Reduction& reduction) {
        const unsigned choices = 1u << reduction.root_count();
        std::vector<Echelon> images;
        for (unsigned signs = 0; signs < choices; ++signs) {
            images.push_back(echelon(matrix_, reduction, signs));
            if (images.back().pivots != images.front().pivots) {
                // One of the two primes is unlucky; the better of the two ranks is a proved lower bound in any case.
                if (better(images.back().pivots, images.front().pivots)) {
                    std::swap(images.front(), images.back());
                }
                if (!known_ || better(images.front().pivots, out_.pivots)) {
                    restart(images.front().pivots);
                }
                return;
            }
        }
        const std::vector<int>& pivots = images.front().pivots;
        if (known_ && better(out_.pivots, pivots)) {
            return;
        }
        if (!known_ || better(pivots, out_.pivots)) {
            restart(pivots);
        }
        combine(reduction, images);
    }

    void restart(const std::vector<int>& pivots) {
        out_.pivots = pivots;
        out_.free = complement(pivots);
        known_ = true;
        used_ = 0;
        modulus_ = 1;
        coefficient_.clear();
    }

    /// Coefficients of the products of roots, by inverting value(signs) = sum over subsets S of c_S prod_{i in S}
    /// (+-root_i) with characters.
    void combine(const Reduction& reduction, const std::vector<Echelon>& images) {
        const PrimeField& field = reduction.field();
        const auto choices = static_cast<unsigned>(images.size());
        const std::size_t count = out_.free.size() * out_.pivots.size() * choices;
        coefficient_.resize(count);
        std::vector<std::uint64_t> weight(choices);
        for (unsigned subset = 0; subset < choices; ++subset) {
            std::uint64_t roots = choices;
            for (int i = 0; i < reduction.root_count(); ++i) {
                roots = ((subset >> i) & 1u) != 0 ? field.multiply(roots, reduction.root(i)) : roots;
            }
            weight[subset] = field.inverse(roots);
        }
        const mpz_class prime(reduction.field().prime());
        mpz_class lift_factor = 1; // modulus^-1 mod p
        if (used_ > 0) {
            mpz_invert(lift_factor.get_mpz_t(), modulus_.get_mpz_t(), prime.get_mpz_t());
        }
        std::size_t at = 0;
        for (const int j : out_.free) {
            for (std::size_t r = 0; r < out_.pivots.size(); ++r) {
                for (unsigned subset = 0; subset < choices; ++subset, ++at) {
                    std::uint64_t sum = 0;
                    for (unsigned signs = 0; signs < choices; ++signs) {
                        const std::uint64_t value = images[signs].row[r][static_cast<std::size_t>(j)];
                        sum =
                            __builtin_parity(signs & subset) != 0 ? field.subtract(sum, value) : field.add(sum, value);
                    }
                    // The kernel vector carries minus the echelon entry.
                    const std::uint64_t image = field.subtract(0, field.multiply(sum, weight[subset]));
                    mpz_class step = (mpz_class(image) - coefficient_[at]) * lift_factor;
                    mpz_fdiv_r(step.get_mpz_t(), step.get_mpz_t(), prime.get_mpz_t());
                    coefficient_[at] += step * modulus_;
                }
            }
        }
        modulus_ *= prime;
        ++used_;
    }

    bool lift(const Reduction& reduction) {
        const unsigned choices = 1u << reduction.root_count();
        std::vector<Number> product_of_roots(choices);
        for (unsigned subset = 0; subset < choices; ++subset) {
            Number product_ = 1;
            for (int i = 0; i < reduction.root_count(); ++i) {
                if (((subset >> i) & 1u) != 0) {
                    product_ *= make_number({{mpz_class(reduction.base()[static_cast<std::size_t>(i)]), 1}});
                }
            }
            product_of_roots[subset] = product_;
        }
        std::vector<std::vector<Number>> basis;
        std::size_t at = 0;
        for (const int j : out_.free) {
            std::vector<Number> vector(static_cast<std::size_t>(matrix_.cols()));
            vector[static_cast<std::size_t>(j)] = 1;
            for (const int pivot : out_.pivots) {
                Number value;
                for (unsigned subset = 0; subset < choices; ++subset, ++at) {
                    if (coefficient_[at] != 0) {
                        const auto fraction = reconstruct(coefficient_[at], modulus_);
                        if (!fraction) {
                            return false;
                        }
                        value += make_rational(*fraction) * product_of_roots[subset];
                    }
                }
                vector[static_cast<std::size_t>(pivot)] = value;
            }
            for (const Number& entry : product(matrix_, vector)) {
                if (!entry.is_zero()) {
                    return false;
                }
            }
            basis.push_back(std::move(vector));
        }
        out_.basis = std::move(basis);
        out_.exact = Verdict::proved;
        return true;
    }

    const NumberMatrix& matrix_;
    const KernelLimits& limits_;
    std::vector<const Number*> entries_;
    Kernel out_;
    bool known_ = false;
    int used_ = 0; // number of primes in modulus_
    mpz_class modulus_ = 1;
    std::vector<mpz_class> coefficient_;
};

} // namespace

NumberMatrix transposed(const NumberMatrix& matrix) {
    NumberMatrix out;
    out.rows = matrix.cols();
    out.column.resize(static_cast<std::size_t>(matrix.rows));
    for (int j = 0; j < matrix.cols(); ++j) {
        for (const auto& [i, value] : matrix.column[static_cast<std::size_t>(j)]) {
            out.column[static_cast<std::size_t>(i)].emplace_back(j, value);
        }
    }
    return out;
}

std::vector<Number> product(const NumberMatrix& matrix, const std::vector<Number>& x) {
    std::vector<Number> out(static_cast<std::size_t>(matrix.rows));
    for (std::size_t j = 0; j < matrix.column.size(); ++j) {
        if (!x[j].is_zero()) {
            for (const auto& [i, value] : matrix.column[j]) {
                out[static_cast<std::size_t>(i)] += value * x[j];
            }
        }
    }
    return out;
}

RankBound rank_bound(const NumberMatrix& matrix) {
    const Reduction reduction = Reduction::suitable(entries(matrix));
    const PrimeField& field = reduction.field();
    const auto rows = static_cast<std::size_t>(matrix.rows);
    using Entries = std::vector<std::pair<int, std::uint64_t>>;
    std::vector<Entries> pivot(rows); // by leading row, with leading value 1
    std::vector<std::uint64_t> work(rows, 0);
    RankBound out{0, field.prime(), {}, {}};
    const int full = std::min(matrix.rows, matrix.cols());
    for (int number = 0; number < matrix.cols() && out.rank < full; ++number) {
        const auto& column = matrix.column[static_cast<std::size_t>(number)];
        int first = matrix.rows, last = -1;
        for (const auto& [i, value] : column) {
            work[static_cast<std::size_t>(i)] = reduction.residue(value);
            first = std::min(first, i);
            last = std::max(last, i);
        }
        bool placed = false;
        for (int i = first; i <= last; ++i) {
            const std::uint64_t lead = work[static_cast<std::size_t>(i)];
            if (lead == 0 || placed) {
                continue;
            }
            Entries& known = pivot[static_cast<std::size_t>(i)];
            if (known.empty()) {
                const std::uint64_t scale = field.inverse(lead);
                for (int k = i; k <= last; ++k) {
                    if (const std::uint64_t value = work[static_cast<std::size_t>(k)]; value != 0) {
                        known.emplace_back(k, field.multiply(value, scale));
                    }
                }
                ++out.rank;
                out.columns.push_back(number);
                placed = true;
                continue;
            }
            const std::uint64_t factor = field.prime() - lead;
            for (const auto& [k, value] : known) {
                auto& x = work[static_cast<std::size_t>(k)];
                x = field.add(x, field.multiply(factor, value));
            }
            last = std::max(last, known.back().first);
        }
        for (int i = std::max(first, 0); i <= last; ++i) {
            work[static_cast<std::size_t>(i)] = 0;
        }
    }
    for (int i = 0; i < matrix.rows; ++i) {
        if (pivot[static_cast<std::size_t>(i)].empty()) {
            out.free_rows.push_back(i);
        }
    }
    return out;
}

Kernel kernel(const NumberMatrix& matrix, const KernelLimits& limits) {
    if (static_cast<long long>(matrix.rows) * matrix.cols() > limits.cells) {
        Kernel out;
        out.rank = rank_bound(matrix).rank;
        return out;
    }
    return Lifting(matrix, limits).run();
}

} // namespace isostat::exact
