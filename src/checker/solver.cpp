#include "checker/solver.hpp"

#include "checker/index.hpp"
#include "checker/inverse.hpp"
#include "checker/normal_factor.hpp"

#include <klu.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace isostat::checker {

void add_scaled(Integer& target, double value, long shift) {
    if (!std::isfinite(value)) {
        return;
    }
    static thread_local Integer part; // called millions of times, so memory is allocated once
    int exponent = 0;
    part = static_cast<long>(std::ldexp(std::frexp(value, &exponent), 53)); // 53: exact: bits of a double
    const long left = exponent - 53 + shift;
    if (left >= 0) {
        mpz_mul_2exp(part.get_mpz_t(), part.get_mpz_t(), static_cast<mp_bitcnt_t>(left));
    } else {
        mpz_tdiv_q_2exp(part.get_mpz_t(), part.get_mpz_t(), static_cast<mp_bitcnt_t>(-left));
    }
    target += part;
}

/// The factors of A^T in KLU, which keeps nothing of the matrix, or of A^T A.
struct Solver::Factors {
    klu_common common{};
    klu_symbolic* symbolic = nullptr;
    klu_numeric* numeric = nullptr;
    int size = 0;

    std::unique_ptr<NormalFactor> normal; ///< null: they are those of KLU
    std::vector<int> order;               ///< for A^T A
    int kept = 0;                         ///< how many lists before this one had these orders
    int entries = 0;                      ///< in the factors that had new orders

    /// `like`: has orders that may serve, or null. `quick`: of A^T A, if its Cholesky factor exists.
    Factors(const Structure& structure, SparseRows<double> a, const Factors* like, bool quick)
        : size(static_cast<int>(structure.rows.size())) {
        constexpr int longest = 16;        // cost: lists with the same orders
        constexpr double most_fill = 1.25; // cost: fill of kept orders
        const bool known = like != nullptr && like->size == size && like->kept < longest &&
                           like->normal->entries() <= most_fill * like->entries;
        order = known ? like->order : order_of_normal(structure);
        kept = known ? like->kept + 1 : 0;
        if (quick) {
            normal = normal_factor(structure.layout.dimension, a, order);
            entries = known ? like->entries : normal->entries();
            normal = normal->compute(0) ? std::move(normal) : nullptr;
        }
        if (!normal) { // KLU takes rows for columns
            std::vector<int> start(a.first.begin(), a.first.end());
            klu_defaults(&common);
            symbolic = klu_analyze(size, start.data(), a.column.data(), &common);
            if (symbolic != nullptr) {
                numeric = klu_factor(start.data(), a.column.data(), a.value.data(), symbolic, &common);
            }
        }
    }
    ~Factors() {
        klu_free_numeric(&numeric, &common);
        klu_free_symbolic(&symbolic, &common);
    }
    Factors(const Factors&) = delete;
    Factors& operator=(const Factors&) = delete;

    /// KLU solves in a workspace of the factors, so each thread uses its own.
    template <class Solve> [[nodiscard]] Eigen::MatrixXd solved(Eigen::MatrixXd b, Solve solve) const {
        static thread_local std::vector<double> work;
        // exact: right-hand sides that KLU solves at once
        work.resize(std::max(work.size(), 4 * static_cast<std::size_t>(size)));
        klu_numeric own = *numeric;
        own.Xwork = work.data();
        klu_common status = common;
        solve(symbolic, &own, size, static_cast<int>(b.cols()), b.data(), &status);
        return b;
    }
};

Eigen::MatrixXd Solver::solve(Eigen::MatrixXd b) const {
    if (factors_->normal) {
        for (Eigen::Index k = 0; k < b.cols(); ++k) {
            b.col(k) = factors_->normal->solve(b.col(k));
        }
        return b;
    }
    return factors_->solved(std::move(b), [](auto... arguments) { klu_tsolve(arguments...); });
}

Eigen::MatrixXd Solver::solve_transposed(Eigen::MatrixXd b, int steps) const {
    if (factors_->normal) {
        for (Eigen::Index k = 0; k < b.cols(); ++k) {
            b.col(k) = factors_->normal->solve_transposed(b.col(k), steps);
        }
        return b;
    }
    return factors_->solved(std::move(b), [](auto... arguments) { klu_solve(arguments...); });
}

Solver::Solver(const Problem& problem, const Solver* like) : Solver(problem, problem.stored.near(problem.fine), like) {}

Solver::Solver(const Structure& structure, const std::vector<double>& q, const Solver* like, bool quick) {
    SparseRows<double> a;
    double largest = 0;
    for (const Row& row : structure.rows) {
        for (std::size_t k = 0; k < at(row.count); ++k) {
            const std::size_t own = at(row.coordinate[k]);
            if (structure.dof_of[own] < 0) {
                continue;
            }
            double entry = std::ldexp(row.sign[k], structure.wall_exponent);
            if (row.quadratic) {
                row.separate(q, row.axis[k], entry);
                entry *= row.sign[k];
            }
            largest = std::max(largest, std::abs(entry));
            a.column.push_back(structure.dof_of[own]);
            a.value.push_back(entry);
        }
        a.first.push_back(a.column.size());
    }
    if (!(largest > 0) || !std::isfinite(largest) || structure.rows.size() != structure.coordinate_of.size()) {
        return;
    }
    std::frexp(largest, &exponent_);
    for (double& entry : a.value) {
        entry = times_power(entry, -exponent_);
    }
    const bool known = like != nullptr && like->factors_ != nullptr && like->factors_->normal != nullptr;
    auto factors =
        std::make_shared<const Factors>(structure, std::move(a), known ? like->factors_.get() : nullptr, quick);
    if (factors->normal != nullptr || factors->numeric != nullptr) {
        factors_ = std::move(factors);
    }
}

const std::vector<int>& Solver::order() const {
    static const std::vector<int> none;
    return factors_ ? factors_->order : none;
}

} // namespace isostat::checker
