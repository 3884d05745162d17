#include "rigidity/contact_pattern.hpp"

#include "contact/separation.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace isostat {

namespace {

/// Where a coordinate of a disk is known to be at every true vertex: `value`, or for `upper` that much below the upper
/// wall. Two disks with the same have the same coordinate along `axis`.
struct Level {
    int axis;
    bool upper;
    double value;
    friend bool operator<(const Level& a, const Level& b) {
        return std::tie(a.axis, a.upper, a.value) < std::tie(b.axis, b.upper, b.value);
    }
    friend bool operator==(const Level& a, const Level& b) = default;
};

/// Per coordinate of the disks: 0, or the number of the level that it is at. Empty when no two disks share one.
template <int Dim> std::vector<int> shared_levels(const Packing<Dim>& packing, const std::vector<Contact>& contacts) {
    std::vector<std::pair<Level, int>> held; // with the coordinate
    const int disks = packing.disk_count();
    for (const Contact& contact : contacts) {
        const auto i = static_cast<std::size_t>(contact.i);
        if (contact.kind == ContactKind::lower_wall || contact.kind == ContactKind::upper_wall) {
            held.push_back(
                {{contact.j, contact.kind == ContactKind::upper_wall, packing.radius[i]}, Dim * contact.i + contact.j});
        } else if (contact.kind == ContactKind::held && contact.i < Dim * disks) {
            held.push_back({{contact.i % Dim, false, packing.q[i]}, contact.i});
        }
    }
    for (int k = 0; k < Dim * disks && !packing.fixed.empty(); ++k) {
        if (packing.is_fixed(DiskId(k / Dim))) {
            held.push_back({{k % Dim, false, packing.q[static_cast<std::size_t>(k)]}, k});
        }
    }
    std::sort(held.begin(), held.end());
    std::vector<int> level;
    for (std::size_t first = 0, last = 0; first < held.size(); first = last) {
        for (last = first; last < held.size() && held[last].first == held[first].first; ++last) {
        }
        for (std::size_t k = first; k < last && last - first > 1; ++k) {
            level.resize(packing.q.size(), 0);
            level[static_cast<std::size_t>(held[k].second)] = static_cast<int>(last);
        }
    }
    return level;
}

/// Whether the image of the second disk may be displaced along an axis: by a period, or by a tilt of a later one.
bool is_displaced(const Contact& contact, int axis) {
    return std::any_of(contact.image.m.begin() + axis, contact.image.m.end(), [](std::int8_t m) { return m != 0; });
}

} // namespace

template <int Dim> std::vector<int> touched_rows(const DofMap<Dim>& dofs, const Contact& contact) {
    std::vector<int> rows;
    Separation<Dim>(contact, dofs.disk_count()).for_each_coordinate([&](std::size_t coordinate, std::size_t, int) {
        if (const int dof = dofs.dof_of(coordinate); dof >= 0) {
            rows.push_back(dof);
        }
    });
    return rows;
}

template <int Dim>
ContactPattern::ContactPattern(const Packing<Dim>& packing, const DofMap<Dim>& dofs,
                               const std::vector<Contact>& contacts, const sparse::Matrix<double>& matrix,
                               const std::vector<int>& matching, bool perturbed)
    : start_(&matrix.start), row_(&matrix.row), matched_(&matching) {
    const std::vector<int> level = perturbed ? std::vector<int>() : shared_levels(packing, contacts);
    if (level.empty()) {
        return;
    }
    Parts parts;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& contact = contacts[l];
        for (int e = matrix.start[l]; e < matrix.start[l + 1]; ++e) {
            const int mu = matrix.row[static_cast<std::size_t>(e)];
            const int axis = dofs.coordinate_of(mu) % Dim; // of a tilt: 0, what it moves along (Dim = 2)
            const auto of = [&](int disk) { return level[static_cast<std::size_t>(Dim * disk + axis)]; };
            if (contact.kind != ContactKind::disk_disk || of(contact.i) == 0 || of(contact.i) != of(contact.j) ||
                is_displaced(contact, axis)) {
                parts.row.push_back(mu);
            }
        }
        parts.start.push_back(static_cast<int>(parts.row.size()));
    }
    if (parts.row.size() < matrix.row.size()) {
        parts.matched = sparse::perfect_matching(matrix.rows, parts.start, parts.row);
        if (!parts.matched.empty()) { // else no vertex with these contacts is regular, and nothing will be said of one
            own_ = std::move(parts);
        }
    }
}

std::vector<unsigned char> ContactPattern::carrying(std::span<const int> rows) const {
    return sparse::structural_nonzeros(start(), row(), matched(), rows);
}

std::vector<unsigned char> ContactPattern::carrying_without(ContactId opens, int row_of_load,
                                                            std::span<const int> other_rows) const {
    const std::span<const int> all_start = start();
    const std::span<const int> all_row = row();
    const std::size_t size = matched().size();
    std::vector<int> replaced_start{0};
    std::vector<int> replaced_row;
    for (std::size_t l = 0; l < size; ++l) {
        if (l == opens.index()) {
            replaced_row.push_back(row_of_load);
        } else {
            replaced_row.insert(replaced_row.end(), all_row.begin() + all_start[l], all_row.begin() + all_start[l + 1]);
        }
        replaced_start.push_back(static_cast<int>(replaced_row.size()));
    }
    const std::vector<int> repaired =
        sparse::repaired_matching(matched(), replaced_start, replaced_row, static_cast<int>(opens.index()));
    return repaired.empty() ? std::vector<unsigned char>(size, 1)
                            : sparse::structural_nonzeros(replaced_start, replaced_row, repaired, other_rows);
}

template std::vector<int> touched_rows<2>(const DofMap<2>&, const Contact&);
template ContactPattern::ContactPattern(const Packing<2>&, const DofMap<2>&, const std::vector<Contact>&,
                                        const sparse::Matrix<double>&, const std::vector<int>&, bool);

} // namespace isostat
