#include "certificate/parts.hpp"
#include "contact/separation.hpp"

#include <isostat/exact/number.hpp>

#include <functional>

namespace isostat {

namespace {

/// Columns x_j - x_i of the stored doubles, without rounding: those of H up to a positive factor each.
exact::NumberMatrix exact_matrix(const State& state) {
    const DofMap dofs(state.packing);
    exact::NumberMatrix matrix;
    matrix.rows = dofs.dof_count();
    for (const Contact& contact : state.contacts) {
        const Separation separation(contact, state.packing.layout());
        PerAxis<exact::Number> r;
        if (contact.of_disks()) {
            r = separation.of_disks([&](std::size_t k) { return exact::Number::from_double(state.packing.q[k]); },
                                    std::minus<>());
        }
        auto& column = matrix.column.emplace_back();
        separation.for_each_entry(dofs, r, [&](int dof, const exact::Number& entry) {
            if (!entry.is_zero()) {
                column.emplace_back(dof, entry);
            }
        });
    }
    return matrix;
}

} // namespace

Counting exact_counting(const State& state) {
    Counting counting = count_contacts(state.packing, state.contacts);
    if (counting.rank_exact == Verdict::proved) {
        return counting;
    }
    const exact::Kernel kernel = exact::kernel(exact_matrix(state));
    if (kernel.exact == Verdict::proved) {
        counting.rank = kernel.rank - bar_count(state.contacts);
        counting.hyperstaticity = counting.contact_count - counting.rank;
        counting.mechanisms = counting.dof_count - counting.rank;
        counting.rank_exact = Verdict::proved;
    }
    return counting;
}

} // namespace isostat
