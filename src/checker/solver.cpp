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

Solver::Solver(const Problem& problem) {
    const int n = problem.dofs();
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<std::pair<int, Integer>> exact;
    std::vector<int> row_of_entry;
    for (int l = 0; l < problem.contacts(); ++l) {
        const Row& row = problem.rows[static_cast<std::size_t>(l)];
        for (int k = 0; k < row.count; ++k) {
            const int dof = problem.dof_of[static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)])];
            if (dof >= 0) {
                exact.emplace_back(dof, problem.entry(l, k, problem.stored));
                row_of_entry.push_back(l);
                scale_ = std::max(scale_, bits(exact.back().second));
            }
        }
    }
    for (std::size_t k = 0; k < exact.size(); ++k) {
        entries.emplace_back(row_of_entry[k], exact[k].first, approximate(exact[k].second, -scale_));
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    lu_.compute(matrix);
    usable_ = lu_.info() == Eigen::Success;
}

} // namespace isostat::checker
