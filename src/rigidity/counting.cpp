#include "exact/independent_columns.hpp"
#include "exact/rank.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/rigidity/counting.hpp>

#include <algorithm>

namespace isostat {

Counting count_contacts(const Packing& packing, const std::vector<Contact>& contacts) {
    require_floating_point();
    const DofMap dofs(packing);
    Counting counting;
    counting.dof_count = dofs.dof_count();
    counting.contact_count = static_cast<int>(contacts.size());
    sparse::Matrix<std::uint64_t> matrix = exact_contact_matrix(packing, dofs, contacts);
    // Mostly there is nothing to hold: seen at once with an order of little fill, which the search for columns has not.
    if (counting.dof_count == counting.contact_count && exact::rank(matrix) == counting.dof_count) {
        counting.rank = counting.dof_count;
        counting.rank_exact = Verdict::proved;
        return counting;
    }
    // The identity behind H completes its independent columns to a basis: the unit columns used are the degrees of
    // freedom to hold.
    for (int mu = 0; mu < counting.dof_count; ++mu) {
        matrix.row.push_back(mu);
        matrix.value.push_back(1);
        matrix.start.push_back(static_cast<int>(matrix.row.size()));
    }
    matrix.cols += counting.dof_count;
    for (const int column : exact::independent_columns(matrix)) {
        if (column < counting.contact_count) {
            ++counting.rank;
        } else {
            counting.free_dofs.push_back(column - counting.contact_count);
        }
    }
    counting.hyperstaticity = counting.contact_count - counting.rank;
    counting.mechanisms = counting.dof_count - counting.rank;
    if (counting.rank == std::min(counting.dof_count, counting.contact_count)) {
        counting.rank_exact = Verdict::proved;
    }
    return counting;
}

} // namespace isostat
