#include "checker/solver.hpp"

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

    explicit Factors(Eigen::SparseMatrix<double>& matrix) : size(static_cast<int>(matrix.rows())) {
        klu_defaults(&common);
        symbolic = klu_analyze(size, matrix.outerIndexPtr(), matrix.innerIndexPtr(), &common);
        if (symbolic != nullptr) {
            numeric = klu_factor(matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr(), symbolic, &common);
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

namespace {

std::vector<double> as_doubles(const Problem& problem) {
    std::vector<double> q;
    for (const Integer& x : problem.stored) {
        q.push_back(approximate(x, problem.fine));
    }
    return q;
}

} // namespace

Solver::Solver(const Problem& problem) : Solver(problem, as_doubles(problem)) {}

Solver::Solver(const Structure& structure, const std::vector<double>& q) {
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
    auto factors = std::make_shared<const Factors>(matrix);
    if (factors->numeric != nullptr) {
        factors_ = std::move(factors);
    }
}

} // namespace isostat::checker
