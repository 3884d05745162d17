#include "contact/contact_set.hpp"
#include "contact/separation.hpp"
#include "exact/rank.hpp"
#include "rigidity/strained_matrix.hpp"

#include <isostat/core/result.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/rigidity/counting.hpp>

#include <algorithm>
#include <cassert>
#include <functional>

namespace isostat {

namespace {

using Residue = std::uint64_t;

/// The vectors of which a column is made, in numbers of any type.
template <class Number> struct Arms {
    PerAxis<Number> r;      ///< x_j - x_i + A m
    PerAxis<Number> period; ///< A m
};

template <class Number, class At, class Minus>
Arms<Number> arms_of(const Contact& contact, const Layout& layout, At at, Minus minus) {
    Arms<Number> arms;
    arms.r = Separation(contact, layout).of_disks(at, minus);
    // A disk and its own image are A m apart.
    arms.period = Separation(Contact(ContactKind::disk_disk, 0, 0, contact.image), layout).of_disks(at, minus);
    return arms;
}

/// The packing with its cell held, where only the disks have degrees of freedom.
Packing in_fixed_cell(Packing packing) {
    packing.cell.move(false, false);
    return packing;
}

/// Calls visit(row, entry) for one column, ascending. `product`, `sum` and `negative` compute with the numbers.
template <class Number, class Ring, class Visit>
void for_each_strained_entry(const DofMap& dofs, const Contact& contact, const Arms<Number>& arms, Strain strain,
                             const Ring& ring, Visit visit) {
    for (const bool second : {false, true}) {
        for (std::size_t a = 0; a < dofs.layout().axes() && contact.i != contact.j; ++a) {
            const auto disk = static_cast<std::size_t>(second ? contact.j : contact.i);
            if (const int dof = dofs.dof_of(dofs.layout().axes() * disk + a); dof >= 0) {
                visit(dof, second ? ring.negative(arms.r[a]) : arms.r[a]);
            }
        }
    }
    const int end = dofs.dof_count() + strain_count(strain, dofs.layout().dimension);
    const auto entry = [&](std::size_t a, std::size_t b) {
        return ring.negative(ring.product(arms.r[a], arms.period[b]));
    };
    int row = dofs.dof_count();
    if (row < end) {
        Number trace = ring.zero();
        for (std::size_t a = 0; a < dofs.layout().axes(); ++a) {
            trace = ring.sum(trace, entry(a, a));
        }
        visit(row++, trace);
    }
    for (std::size_t above = 0; above < dofs.layout().axes(); ++above) { // the diagonal, then the lines above it
        for (std::size_t a = above == 0 ? 1 : 0; a + above < dofs.layout().axes() && row < end; ++a) {
            visit(row++, entry(a, a + above));
        }
    }
}

struct ResidueRing {
    static Residue zero() { return 0; }
    static Residue negative(Residue a) { return a == 0 ? 0 : exact::mersenne61 - a; }
    static Residue product(Residue a, Residue b) { return exact::multiply(a, b); }
    static Residue sum(Residue a, Residue b) { return (a + b) % exact::mersenne61; }
    static Residue difference(Residue a, Residue b) { return sum(a, negative(b)); }
};

struct NumberRing {
    using Number = exact::Number;
    static Number zero() { return Number(0); }
    static Number negative(const Number& a) { return -a; }
    static Number product(const Number& a, const Number& b) { return a * b; }
    static Number sum(const Number& a, const Number& b) { return a + b; }
};

Counting counted(int rows, int columns, int rank) {
    Counting counting;
    counting.dof_count = rows;
    counting.contact_count = columns;
    counting.rank = rank;
    counting.rank_exact = rank == std::min(rows, columns) ? Verdict::proved : Verdict::undecided;
    return counting;
}

/// Adds the exact rank where the rank mod p does not decide it and the matrix is small enough for a kernel.
Counting settled(Counting counting, const std::function<exact::NumberMatrix()>& matrix) {
    const bool small =
        static_cast<long long>(counting.dof_count) * counting.contact_count <= exact::KernelLimits().cells;
    if (counting.rank_exact != Verdict::proved && small) {
        const exact::Kernel kernel = exact::kernel(matrix());
        counting.rank = std::max(counting.rank, kernel.rank);
        counting.rank_exact = kernel.exact;
    }
    counting.hyperstaticity = counting.contact_count - counting.rank;
    counting.mechanisms = counting.dof_count - counting.rank;
    return counting;
}

} // namespace

const char* to_string(Strain strain) {
    static constexpr auto words = words_of<Strain>("fixed cell", "isotropic", "diagonal", "full strain");
    return word_of(strain, words);
}

sparse::Matrix<std::uint64_t> exact_strained_matrix(const Packing& packing, const std::vector<Contact>& contacts,
                                                    Strain strain) {
    assert(packing.cell.all());
    const DofMap dofs(in_fixed_cell(packing));
    sparse::Matrix<std::uint64_t> matrix;
    matrix.rows = dofs.dof_count() + strain_count(strain, packing.dimension);
    matrix.cols = static_cast<int>(contacts.size());
    matrix.start.push_back(0);
    for (const Contact& contact : contacts) {
        const auto at = [&](std::size_t k) -> Residue { return exact::residue(packing.q[k]); };
        const auto arms = arms_of<Residue>(contact, packing.layout(), at, ResidueRing::difference);
        for_each_strained_entry(dofs, contact, arms, strain, ResidueRing(), [&](int row, Residue entry) {
            matrix.row.push_back(row);
            matrix.value.push_back(entry);
        });
        matrix.start.push_back(static_cast<int>(matrix.row.size()));
    }
    return matrix;
}

exact::NumberMatrix strained_matrix(const Packing& packing, const std::function<exact::Number(std::size_t)>& at,
                                    const std::vector<Contact>& contacts, Strain strain) {
    assert(packing.cell.all());
    const DofMap dofs(in_fixed_cell(packing));
    exact::NumberMatrix matrix;
    matrix.rows = dofs.dof_count() + strain_count(strain, packing.dimension);
    for (const Contact& contact : contacts) {
        const auto arms = arms_of<exact::Number>(contact, packing.layout(), at, std::minus<>());
        auto& column = matrix.column.emplace_back();
        for_each_strained_entry(dofs, contact, arms, strain, NumberRing(), [&](int row, const exact::Number& entry) {
            if (!entry.is_zero()) {
                column.emplace_back(row, entry);
            }
        });
    }
    return matrix;
}

Counting count_matrix(const exact::NumberMatrix& matrix) {
    return settled(counted(matrix.rows, matrix.cols(), exact::rank_bound(matrix).rank), [&] { return matrix; });
}

StrainCounts count_strains(const Packing& packing, const std::vector<Contact>& contacts) {
    const auto matrix = exact_strained_matrix(packing, contacts, Strain::full);
    const int disks = matrix.rows - strain_count(Strain::full, packing.dimension);
    std::array<int, strains.size()> ends{};
    std::ranges::transform(strains, ends.begin(),
                           [&](Strain strain) { return disks + strain_count(strain, packing.dimension); });
    const std::vector<int> ranks = exact::ranks_of_first_rows(matrix, ends);
    StrainCounts counts;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        counts[k] = settled(counted(ends[k], matrix.cols, ranks[k]), [&] {
            return strained_matrix(
                packing, [&](std::size_t c) { return exact::Number::from_double(packing.q[c]); }, contacts, strains[k]);
        });
    }
    return counts;
}

std::vector<int> untouched(int disks, const std::vector<Contact>& pairs) {
    const std::vector<int> contacts = contacts_per_disk(disks, pairs);
    std::vector<int> out;
    for (int i = 0; i < disks; ++i) {
        if (contacts[static_cast<std::size_t>(i)] == 0) {
            out.push_back(i);
        }
    }
    return out;
}

std::vector<int> rattlers_by_coordination(const Packing& packing, std::vector<Contact> contacts) {
    std::vector<unsigned char> gone(packing.radius.size(), 0);
    for (bool changes = true; changes;) {
        std::erase_if(contacts, [&](const Contact& c) {
            return c.kind == ContactKind::held || gone[static_cast<std::size_t>(c.i)] != 0 ||
                   (c.of_disks() && gone[static_cast<std::size_t>(c.j)] != 0);
        });
        const std::vector<int> count = contacts_per_disk(packing.disk_count(), contacts);
        changes = false;
        for (std::size_t i = 0; i < gone.size(); ++i) {
            const bool few = gone[i] == 0 && !packing.is_fixed(DiskId(i)) && count[i] <= packing.dimension;
            gone[i] = few ? 1 : gone[i];
            changes = changes || few;
        }
    }
    std::vector<int> out;
    for (std::size_t i = 0; i < gone.size(); ++i) {
        if (gone[i] != 0) {
            out.push_back(static_cast<int>(i));
        }
    }
    return out;
}

Packing without_disks(Packing packing, const std::vector<int>& disks) {
    packing.fixed.resize(packing.radius.size(), 0);
    for (const int disk : disks) {
        packing.fixed[static_cast<std::size_t>(disk)] = 1;
    }
    return packing;
}

} // namespace isostat
