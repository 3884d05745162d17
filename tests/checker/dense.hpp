#pragma once
// The matrix of the checker, dense, for oracles.

#include "checker/maker.hpp"
#include "checker/problem.hpp"

namespace dense {

namespace checker = isostat::checker;

/// The derivative at the stored coordinates, walls with their weight, in real lengths.
inline maker::Matrix derivative(const checker::Problem& problem) {
    maker::Matrix a = maker::Matrix::Zero(problem.contacts(), problem.dofs());
    for (int l = 0; l < problem.contacts(); ++l) {
        const checker::Row& row = problem.rows[static_cast<std::size_t>(l)];
        for (int k = 0; k < row.count; ++k) {
            const int dof = problem.dof_of[static_cast<std::size_t>(row.coordinate[static_cast<std::size_t>(k)])];
            if (dof >= 0) {
                a(l, dof) = problem.length(problem.entry(l, k, problem.stored)).get_d();
            }
        }
    }
    return a;
}

} // namespace dense
