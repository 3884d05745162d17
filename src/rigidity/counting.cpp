#include "exact/rank.hpp"
#include "rigidity/isostatic.hpp"
#include "rigidity/strained_matrix.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>
#include <isostat/rigidity/counting.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace isostat {

SparseColumns contact_matrix(const State& state) {
    auto h = contact_matrix(state.packing, DofMap(state.packing), state.contacts);
    return {h.rows, h.cols, std::move(h.start), std::move(h.row), std::move(h.value)};
}

namespace {

/// Throws unless the bars are independent: with a self-stress of the bars h and k would be wrong.
void require_independent_bars(const Packing& packing, std::vector<Contact> contacts) {
    std::erase_if(contacts, [](const Contact& c) { return c.kind != ContactKind::bar; });
    const int rank = exact::rank(exact_contact_matrix(packing, DofMap(packing), contacts));
    if (rank < static_cast<int>(contacts.size())) {
        throw Error(
            ErrorKind::bad_input,
            fmt::format("{} bars, of which {} are independent: expected bodies that are rigid to first order (of "
                        "members on one line a further one off the line, inside another, makes them so)",
                        contacts.size(), rank));
    }
}

} // namespace

Counting count_contacts(const Packing& packing, const std::vector<Contact>& contacts) {
    require_floating_point();
    const DofMap dofs(packing);
    Counting counting;
    counting.dof_count = dofs.dof_count();
    counting.contact_count = static_cast<int>(contacts.size());
    sparse::Matrix<std::uint64_t> matrix = exact_contact_matrix(packing, dofs, contacts);
    // Mostly no coordinate has to be held: the rank tells so at once, in an order of little fill, unlike the columns.
    if (counting.dof_count == counting.contact_count && exact::rank(matrix) == counting.dof_count) {
        counting.rank = counting.dof_count;
        counting.rank_exact = Verdict::proved;
        return without_bars(counting, bar_count(contacts));
    }
    // The identity matrix after H completes the independent columns of H to a basis: the unit columns in the basis
    // are the degrees of freedom to hold.
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
    if (counting.hyperstaticity > 0 && !packing.bars.empty()) {
        require_independent_bars(packing, contacts);
    }
    counting.mechanisms = counting.dof_count - counting.rank;
    if (counting.rank == std::min(counting.dof_count, counting.contact_count)) {
        counting.rank_exact = Verdict::proved;
    }
    return without_bars(counting, bar_count(contacts));
}

Counting without_bars(Counting all, int bars) {
    all.dof_count -= bars;
    all.contact_count -= bars;
    all.rank -= bars;
    return all;
}

int bar_count(const std::vector<Contact>& contacts) {
    return static_cast<int>(
        std::ranges::count_if(contacts, [](const Contact& c) { return c.kind == ContactKind::bar; }));
}

} // namespace isostat
