#include <isostat/rigidity/isostatic.hpp>

#include <isostat/exact/rank.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

/// Entries of one column, sorted by row; used for both the rounded and the exact matrix so that their patterns agree.
template <class Value> struct Column {
    int count = 0;
    std::array<std::pair<int, Value>, 8> entry;
    void add(int row, Value value) {
        int k = count++;
        for (; k > 0 && entry[static_cast<std::size_t>(k - 1)].first > row; --k) {
            entry[static_cast<std::size_t>(k)] = entry[static_cast<std::size_t>(k - 1)];
        }
        entry[static_cast<std::size_t>(k)] = {row, value};
    }
};

template <class Value> void append(sparse::Matrix<Value>& matrix, const Column<Value>& column) {
    for (int k = 0; k < column.count; ++k) {
        matrix.row.push_back(column.entry[static_cast<std::size_t>(k)].first);
        matrix.value.push_back(column.entry[static_cast<std::size_t>(k)].second);
    }
    matrix.start.push_back(static_cast<int>(matrix.row.size()));
}

template <class Value> sparse::Matrix<Value> empty_matrix(int rows, std::size_t cols) {
    sparse::Matrix<Value> matrix;
    matrix.rows = rows;
    matrix.cols = static_cast<int>(cols);
    matrix.start.reserve(cols + 1);
    matrix.start.push_back(0);
    matrix.row.reserve(4 * cols);
    matrix.value.reserve(4 * cols);
    return matrix;
}

} // namespace

template <int Dim>
sparse::Matrix<double> contact_matrix(const Packing<Dim>& packing, const DofMap<Dim>& dofs,
                                      const std::vector<Contact>& contacts) {
    auto matrix = empty_matrix<double>(dofs.dof_count(), contacts.size());
    for (const Contact& contact : contacts) {
        const GapGradient<Dim> g = gap_gradient(packing, contact);
        Column<double> column;
        for (int k = 0; k < g.count; ++k) {
            const auto e = static_cast<std::size_t>(k);
            const int dof = dofs.dof_of(static_cast<std::size_t>(g.coordinate[e]));
            if (dof >= 0 && g.value[e] != 0) {
                column.add(dof, -g.value[e]);
            }
        }
        append(matrix, column);
    }
    return matrix;
}

template <int Dim>
sparse::Matrix<std::uint64_t> exact_contact_matrix(const Packing<Dim>& packing, const DofMap<Dim>& dofs,
                                                   const std::vector<Contact>& contacts) {
    std::vector<std::uint64_t> residue(packing.q.size());
    for (std::size_t k = 0; k < residue.size(); ++k) {
        residue[k] = exact::residue(packing.q[k]);
    }
    constexpr std::uint64_t one = 1;
    constexpr std::uint64_t minus_one = exact::mersenne61 - 1;
    auto matrix = empty_matrix<std::uint64_t>(dofs.dof_count(), contacts.size());
    for (const Contact& contact : contacts) {
        Column<std::uint64_t> column;
        const auto add = [&](int coordinate, std::uint64_t value) {
            const int dof = dofs.dof_of(static_cast<std::size_t>(coordinate));
            if (dof >= 0) {
                column.add(dof, value);
            }
        };
        switch (contact.kind) {
        case ContactKind::disk_disk:
            for (int a = 0; a < Dim; ++a) {
                const int ki = Dim * contact.i + a;
                const int kj = Dim * contact.j + a;
                const auto i = static_cast<std::size_t>(ki);
                const auto j = static_cast<std::size_t>(kj);
                if (packing.q[i] != packing.q[j]) { // the pattern of contact_matrix; a difference of p would stay as 0
                    add(ki, exact::subtract(residue[j], residue[i]));
                    add(kj, exact::subtract(residue[i], residue[j]));
                }
            }
            break;
        case ContactKind::lower_wall: add(Dim * contact.i + contact.j, minus_one); break;
        case ContactKind::upper_wall:
            add(Dim * contact.i + contact.j, one);
            add(Dim * packing.disk_count() + contact.j, minus_one);
            break;
        case ContactKind::held: add(contact.i, minus_one); break;
        }
        append(matrix, column);
    }
    return matrix;
}

template <int Dim>
Result<IsostaticStructure<Dim>> IsostaticStructure<Dim>::prove(const Packing<Dim>& packing,
                                                               std::vector<Contact> contacts) {
    IsostaticStructure structure;
    structure.dofs_ = std::make_shared<const DofMap<Dim>>(packing);
    const int dof_count = structure.dofs_->dof_count();
    const int contact_count = static_cast<int>(contacts.size());
    if (dof_count != contact_count) {
        return Failure{FailureKind::not_isostatic,
                       fmt::format("N_f = {} degrees of freedom and N = {} contacts: an isostatic structure has N = N_f",
                                   dof_count, contact_count)};
    }
    structure.matrix_ = contact_matrix(packing, *structure.dofs_, contacts);
    const auto residues = exact_contact_matrix(packing, *structure.dofs_, contacts);
    auto ordering = std::make_shared<const sparse::Ordering>(residues);
    if (!ordering->structurally_regular()) {
        return Failure{FailureKind::not_isostatic,
                       fmt::format("the contact matrix is structurally singular: N_f = N = {}, structural rank {}",
                                   dof_count, ordering->structural_rank())};
    }
    const int rank = exact::rank(residues, *ordering);
    if (rank != dof_count) {
        return Failure{FailureKind::not_isostatic,
                       fmt::format("the rank of the contact matrix mod 2^61-1 is {}, N_f = N = {}: not proved regular",
                                   rank, dof_count)};
    }
    structure.contacts_ = std::move(contacts);
    structure.ordering_ = std::move(ordering);
    return structure;
}

template sparse::Matrix<double> contact_matrix<2>(const Packing<2>&, const DofMap<2>&, const std::vector<Contact>&);
template sparse::Matrix<std::uint64_t> exact_contact_matrix<2>(const Packing<2>&, const DofMap<2>&,
                                                               const std::vector<Contact>&);
template class IsostaticStructure<2>;

} // namespace isostat
