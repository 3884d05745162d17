// Which coordinates to hold where contacts leave free motions.
#include "rigidity/isostatic.hpp"

#include <isostat/certificate/certify.hpp>

#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

constexpr double shift = 0x1p-36; // guess: shift of the inverse iteration for the motions that keep all contacts
constexpr int iterations = 4;     // guess: steps of the inverse iteration
using Sparse = Eigen::SparseMatrix<double>;

/// k degrees of freedom that move far in the motions that keep all contacts: the rows of an orthonormal basis of these
/// that a factorisation with pivots takes first. The basis by inverse iteration. A guess: whether the list with them is
/// regular is proved later. Cost: a factorisation, and some solves for each.
std::vector<int> farthest_moving(const Packing& packing, const std::vector<Contact>& contacts, int k) {
    const DofMap dofs(packing);
    const sparse::Matrix<double> h = contact_matrix(packing, dofs, contacts);
    const Eigen::Map<const Sparse> matrix(h.rows, h.cols, static_cast<Eigen::Index>(h.row.size()), h.start.data(),
                                          h.row.data(), h.value.data());
    const Sparse form = matrix * matrix.transpose(); // 0 on these motions
    Eigen::SimplicialLDLT<Sparse> factors;
    factors.setShift(shift * form.diagonal().maxCoeff());
    factors.compute(form);
    if (factors.info() != Eigen::Success) {
        return {};
    }
    Eigen::MatrixXd motions = Eigen::MatrixXd::NullaryExpr(
        h.rows, k, [](Eigen::Index i, Eigen::Index j) { return std::sin(static_cast<double>(1 + i * (j + 1))); });
    for (int i = 0; i < iterations; ++i) {
        const Eigen::HouseholderQR<Eigen::MatrixXd> basis(factors.solve(motions).eval());
        motions = basis.householderQ() * Eigen::MatrixXd::Identity(h.rows, k);
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> pivots(motions.transpose());
    const auto& order = pivots.colsPermutation().indices();
    std::vector<int> rows(order.data(), order.data() + k);
    std::ranges::sort(rows);
    return rows;
}

} // namespace

State with_free_motions_held(State state) {
    const bool held = std::ranges::any_of(state.contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
    if (state.packing.bars.empty() || held) {
        return state;
    }
    const Counting counting = count_contacts(state.packing, state.contacts);
    if (counting.hyperstaticity > 0 || counting.mechanisms == 0) {
        return state;
    }
    std::vector<int> rows = farthest_moving(state.packing, state.contacts, counting.mechanisms);
    const DofMap dofs(state.packing);
    for (const int dof : rows.empty() ? counting.free_dofs : rows) {
        state.contacts.push_back({ContactKind::held, dofs.coordinate_of(dof), 0});
    }
    return state;
}

} // namespace isostat
