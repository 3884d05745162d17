#include "certificate/exact_counting.hpp"

#include <isostat/exact/kernel.hpp>

#include <algorithm>
#include <map>

namespace isostat {

namespace {

/// Columns x_j - x_i of the stored doubles, without rounding: those of H up to a positive factor each.
template <int Dim> exact::NumberMatrix exact_matrix(const State<Dim>& state) {
    const DofMap<Dim> dofs(state.packing);
    exact::NumberMatrix matrix;
    matrix.rows = dofs.dof_count();
    for (const Contact& contact : state.contacts) {
        std::map<int, exact::Number> column; // rows increasing
        const auto add = [&](int coordinate, const exact::Number& value) {
            const int dof = dofs.dof_of(static_cast<std::size_t>(coordinate));
            if (dof >= 0 && !value.is_zero()) {
                column[dof] = value;
            }
        };
        switch (contact.kind) {
        case ContactKind::disk_disk:
            for (int a = 0; a < Dim; ++a) {
                const exact::Number d = exact::Number::from_double(state.packing.coordinate(DiskId(contact.j), a)) -
                                        exact::Number::from_double(state.packing.coordinate(DiskId(contact.i), a));
                add(Dim * contact.i + a, d);
                add(Dim * contact.j + a, -d);
            }
            break;
        case ContactKind::lower_wall: add(Dim * contact.i + contact.j, -1); break;
        case ContactKind::upper_wall:
            add(Dim * contact.i + contact.j, 1);
            add(Dim * state.packing.disk_count() + contact.j, -1);
            break;
        case ContactKind::held: add(contact.i, -1); break;
        }
        matrix.column.emplace_back(column.begin(), column.end());
    }
    return matrix;
}

} // namespace

template <int Dim> Counting exact_counting(const State<Dim>& state) {
    Counting counting = count_contacts(state.packing, state.contacts);
    if (counting.rank_exact == Verdict::proved) {
        return counting;
    }
    const exact::Kernel kernel = exact::kernel(exact_matrix(state));
    if (kernel.exact == Verdict::proved) {
        counting.rank = kernel.rank;
        counting.hyperstaticity = counting.contact_count - kernel.rank;
        counting.mechanisms = counting.dof_count - kernel.rank;
        counting.rank_exact = Verdict::proved;
    }
    return counting;
}

template Counting exact_counting<2>(const State<2>&);

} // namespace isostat
