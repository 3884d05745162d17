#include "checker/solver.hpp"

namespace isostat::checker {

Integer scaled_integer(double value, long shift) {
    if (!std::isfinite(value)) {
        return 0;
    }
    int exponent = 0;
    const Integer mantissa(std::ldexp(std::frexp(value, &exponent), 53));
    const long left = exponent - 53 + shift;
    if (left >= 0) {
        return shifted_left(mantissa, left);
    }
    Integer result;
    mpz_tdiv_q_2exp(result.get_mpz_t(), mantissa.get_mpz_t(), static_cast<mp_bitcnt_t>(-left));
    return result;
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
            const double entry = row.quadratic ? q[own] - q[static_cast<std::size_t>(row.coordinate[(k + 2) % 4])]
                                               : std::ldexp(row.sign[k], structure.wall_exponent);
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
    lu_.compute(matrix);
    usable_ = lu_.info() == Eigen::Success;
}

} // namespace isostat::checker
