#include "checker/solver.hpp"

#include "checker/singular_value.hpp"

#include <Eigen/SparseCore>
#include <klu.h>

#include <algorithm>
#include <vector>

namespace isostat::checker {

void add_scaled(Integer& target, double value, long shift) {
    if (!std::isfinite(value)) {
        return;
    }
    static thread_local Integer part; // called millions of times, so memory is allocated once
    int exponent = 0;
    part = static_cast<long>(std::ldexp(std::frexp(value, &exponent), 53));
    const long left = exponent - 53 + shift;
    if (left >= 0) {
        mpz_mul_2exp(part.get_mpz_t(), part.get_mpz_t(), static_cast<mp_bitcnt_t>(left));
    } else {
        mpz_tdiv_q_2exp(part.get_mpz_t(), part.get_mpz_t(), static_cast<mp_bitcnt_t>(-left));
    }
    target += part;
}

/// The factors of KLU, which keeps nothing of the matrix.
struct Solver::Factors {
    klu_common common{};
    klu_symbolic* symbolic = nullptr;
    klu_numeric* numeric = nullptr;
    int size = 0;

    std::vector<int> order; ///< for A^T A
    int kept = 0;           ///< how many lists before this one had these orders
    int entries = 0;        ///< in the factors that had new orders

    /// `like`: has orders that may serve, or null.
    Factors(const Structure& structure, Eigen::SparseMatrix<double>& matrix, const Factors* like)
        : size(static_cast<int>(matrix.rows())) {
        constexpr int longest = 16;
        constexpr double most_fill = 1.25;
        klu_defaults(&common);
        if (like != nullptr && like->size == size && like->kept < longest &&
            like->filled() <= most_fill * like->entries) {
            common.btf = 0; // a contact more may connect the blocks
            symbolic = klu_analyze_given(size, matrix.outerIndexPtr(), matrix.innerIndexPtr(), like->numeric->Pnum,
                                         like->symbolic->Q, &common);
            order = like->order;
            kept = like->kept + 1;
            entries = like->entries;
        } else {
            symbolic = klu_analyze(size, matrix.outerIndexPtr(), matrix.innerIndexPtr(), &common);
            order = order_of_normal(structure);
        }
        if (symbolic != nullptr) {
            numeric = klu_factor(matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr(), symbolic, &common);
        }
        if (kept == 0 && numeric != nullptr) {
            entries = filled();
        }
    }
    [[nodiscard]] int filled() const { return numeric->lnz + numeric->unz + numeric->nzoff; }
    ~Factors() {
        klu_free_numeric(&numeric, &common);
        klu_free_symbolic(&symbolic, &common);
    }
    Factors(const Factors&) = delete;
    Factors& operator=(const Factors&) = delete;

    /// KLU solves in a workspace of the factors, so each thread uses its own.
    template <class Solve> [[nodiscard]] Eigen::MatrixXd solved(Eigen::MatrixXd b, Solve solve) const {
        static thread_local std::vector<double> work;
        work.resize(std::max(work.size(), 4 * static_cast<std::size_t>(size))); // four right-hand sides at once
        klu_numeric own = *numeric;
        own.Xwork = work.data();
        klu_common status = common;
        solve(symbolic, &own, size, static_cast<int>(b.cols()), b.data(), &status);
        return b;
    }
};

Eigen::MatrixXd Solver::solve(Eigen::MatrixXd b) const {
    return factors_->solved(std::move(b), [](auto... arguments) { klu_solve(arguments...); });
}

Eigen::MatrixXd Solver::solve_transposed(Eigen::MatrixXd b) const {
    return factors_->solved(std::move(b), [](auto... arguments) { klu_tsolve(arguments...); });
}

Solver::Solver(const Problem& problem, const Solver* like) : Solver(problem, problem.stored.near(problem.fine), like) {}

Solver::Solver(const Structure& structure, const std::vector<double>& q, const Solver* like) {
    std::vector<Eigen::Triplet<double>> entries;
    double largest = 0;
    for (std::size_t l = 0; l < structure.rows.size(); ++l) {
        const Row& row = structure.rows[l];
        for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
            const auto own = static_cast<std::size_t>(row.coordinate[k]);
            if (structure.dof_of[own] < 0) {
                continue;
            }
            double entry = std::ldexp(row.sign[k], structure.wall_exponent);
            if (row.quadratic) {
                row.separate(q, row.axis[k], entry);
                entry *= row.sign[k];
            }
            largest = std::max(largest, std::abs(entry));
            entries.emplace_back(static_cast<int>(l), structure.dof_of[own], entry);
        }
    }
    const auto n = static_cast<int>(structure.coordinate_of.size());
    if (!(largest > 0) || !std::isfinite(largest) || structure.rows.size() != structure.coordinate_of.size()) {
        return;
    }
    std::frexp(largest, &exponent_);
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    matrix *= std::ldexp(1.0, -exponent_);
    const Factors* known = like != nullptr ? like->factors_.get() : nullptr;
    auto factors = std::make_shared<const Factors>(structure, matrix, known);
    if (factors->numeric == nullptr && factors->kept > 0) {
        factors = std::make_shared<const Factors>(structure, matrix, nullptr);
    }
    if (factors->numeric != nullptr) {
        factors_ = std::move(factors);
    }
}

const std::vector<int>& Solver::order() const {
    static const std::vector<int> none;
    return factors_ ? factors_->order : none;
}

} // namespace isostat::checker
