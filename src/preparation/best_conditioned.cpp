#include "contact/candidates.hpp"
#include "preparation/polish.hpp"

#include <Eigen/QR>

#include <algorithm>

namespace isostat::preparation {

std::optional<std::vector<Contact>> best_conditioned(const Packing& packing) {
    constexpr int most = 2000;           // degrees of freedom; more take longer than seconds
    constexpr double touching = 1e-6;    // of the smallest radius: above the gaps of nearly dependent contacts
    constexpr double independent = 1e-6; // of the largest pivot
    const DofMap dofs(packing);
    const int n = dofs.dof_count();
    if (n > most) {
        return std::nullopt;
    }
    std::vector<Contact> pairs = find_candidates(packing, pivot_reach).contacts;
    std::erase_if(pairs, [&](const Contact& c) { return gap(packing, c) > touching * packing.min_radius(); });
    const auto count = static_cast<Eigen::Index>(pairs.size());
    if (count < n) {
        return std::nullopt;
    }
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, count);
    for (Eigen::Index l = 0; l < count; ++l) {
        gap_gradient(packing, pairs[static_cast<std::size_t>(l)])
            .for_each_dof(dofs,
                          [&](std::size_t dof, double value) { columns(static_cast<Eigen::Index>(dof), l) += value; });
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(columns);
    const auto diagonal = [&](Eigen::Index k) { return std::abs(factors.matrixQR()(k, k)); };
    if (!(diagonal(n - 1) > independent * diagonal(0))) {
        return std::nullopt;
    }
    std::vector<Contact> kept;
    for (Eigen::Index k = 0; k < n; ++k) {
        kept.push_back(pairs[static_cast<std::size_t>(factors.colsPermutation().indices()(k))]);
    }
    std::ranges::sort(kept);
    return kept;
}

} // namespace isostat::preparation
