#include "certificate/averages.hpp"
#include "linear/factorisation.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <span>

namespace isostat {

std::vector<double> smallest_singular_values(const IsostaticStructure& structure, int count) {
    // guess: values for people, not proved
    constexpr int further = 10;          // vectors: the wanted ones converge as the ratio to theirs
    constexpr int most_iterations = 200; // cost: of iterations
    const Eigen::Index size = structure.size();
    const int width = static_cast<int>(std::min<Eigen::Index>(size, count + further));
    const Eigen::Index wanted = std::min(count, width);
    const Factorisation factors(structure);
    std::srand(1); // of Eigen's random start: the same answer on every run
    Eigen::MatrixXd x = Eigen::MatrixXd::Random(size, width);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(wanted);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        x = Eigen::HouseholderQR<Eigen::MatrixXd>(x).householderQ() * Eigen::MatrixXd::Identity(size, width);
        const std::span<double> columns(x.data(), static_cast<std::size_t>(x.size()));
        factors.solve_velocities(columns, width); // H^-T x: its singular values are those of H^-1 on this subspace
        const Eigen::MatrixXd r =
            Eigen::HouseholderQR<Eigen::MatrixXd>(x).matrixQR().topRows(width).triangularView<Eigen::Upper>();
        const Eigen::VectorXd inverse =
            Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner>(r).singularValues().head(wanted);
        const Eigen::VectorXd now = inverse.cwiseInverse();
        // guess: values for people, not proved
        const bool settled = ((now - values).cwiseAbs().array() <= 1e-4 * now.array()).all();
        values = now;
        if (settled) {
            break;
        }
        factors.solve_forces(columns, width);
    }
    return {values.begin(), values.end()};
}

} // namespace isostat
