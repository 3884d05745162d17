#include <isostat/verified/index_pattern.hpp>

#include <algorithm>

namespace isostat {

template <int Dim> std::vector<int> touched_rows(const DofMap<Dim>& dofs, int disks, const Contact& contact) {
    std::vector<int> rows;
    const auto add = [&](int coordinate) {
        const int dof = dofs.dof_of(static_cast<std::size_t>(coordinate));
        if (dof >= 0) {
            rows.push_back(dof);
        }
    };
    switch (contact.kind) {
    case ContactKind::disk_disk:
        for (int a = 0; a < Dim; ++a) {
            add(Dim * contact.i + a);
            add(Dim * contact.j + a);
        }
        break;
    case ContactKind::upper_wall: add(Dim * disks + contact.j); [[fallthrough]];
    case ContactKind::lower_wall: add(Dim * contact.i + contact.j); break;
    case ContactKind::held: add(contact.i); break;
    }
    std::sort(rows.begin(), rows.end());
    return rows;
}

template <int Dim> IndexPattern index_pattern(const IsostaticStructure<Dim>& structure) {
    const DofMap<Dim>& dofs = structure.dofs();
    IndexPattern pattern;
    pattern.start.push_back(0);
    const int disks = dofs.coordinate_count() / Dim - 1; // those of the upper walls come last
    for (const Contact& contact : structure.contacts()) {
        const std::vector<int> rows = touched_rows(dofs, disks, contact);
        pattern.row.insert(pattern.row.end(), rows.begin(), rows.end());
        pattern.start.push_back(static_cast<int>(pattern.row.size()));
    }
    pattern.matched = sparse::perfect_matching(structure.size(), pattern.start, pattern.row);
    return pattern;
}

template IndexPattern index_pattern<2>(const IsostaticStructure<2>&);
template std::vector<int> touched_rows<2>(const DofMap<2>&, int, const Contact&);

} // namespace isostat
