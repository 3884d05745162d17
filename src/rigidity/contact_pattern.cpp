#include "rigidity/contact_pattern.hpp"

#include "contact/contact_set.hpp"
#include "contact/separation.hpp"
#include "core/roundoff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

namespace isostat {

namespace {

/// A coordinate that a disk has at every true vertex: `value`, or for `upper` that much below the upper wall. Two
/// disks with equal levels have the same coordinate along `axis`.
struct Level {
    int axis;
    std::optional<std::size_t> from; ///< none: from 0
    double value;
    friend bool operator<(const Level& a, const Level& b) {
        return std::tie(a.value, a.axis, a.from) < std::tie(b.value, b.axis, b.from); // the value mostly decides
    }
    friend bool operator==(const Level& a, const Level& b) = default;
};

/// Per coordinate of the disks: 0, or the number of its level. Empty when no two disks share one. Held coordinates of
/// clumps have no level: each may hold a free motion, which must be free wherever it is held (U2), not only there.
std::vector<int> shared_levels(const Packing& packing, const std::vector<Contact>& contacts) {
    std::vector<std::pair<Level, int>> held; // with its coordinate
    const int disks = packing.disk_count();
    for (const Contact& contact : contacts) {
        if (contact.of_disks()) {
            continue;
        }
        const auto i = static_cast<std::size_t>(contact.i);
        if (contact.is_wall()) {
            held.push_back(
                {{contact.j, wall_coordinate(contact, packing.layout()), -contact.wall().side * packing.radius[i]},
                 packing.dimension * contact.i + contact.j});
        } else if (packing.bars.empty() && contact.i < packing.dimension * disks) {
            held.push_back({{contact.i % packing.dimension, {}, packing.q[i]}, contact.i});
        }
    }
    for (int k = 0; k < packing.dimension * disks && !packing.fixed.empty(); ++k) {
        if (packing.is_fixed(DiskId(k / packing.dimension))) {
            held.push_back({{k % packing.dimension, {}, packing.q[static_cast<std::size_t>(k)]}, k});
        }
    }
    std::ranges::sort(held);
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

/// Whether the image of the second disk may be displaced along an axis, by a period or by a tilt of a later period.
bool is_displaced(const Contact& contact, int axis) {
    return std::any_of(contact.image.m.begin() + axis, contact.image.m.end(), [](std::int8_t m) { return m != 0; });
}

/// The row of a coordinate when another disk is pinned than in `dofs`: the forces of finite loads are the same
/// (proofs/cells.md, C1), and while a rattler is pinned no pattern tells that the rest does not press on the rattler.
class Repinned {
  public:
    Repinned(const Packing& packing, const DofMap& dofs, const std::vector<Contact>& contacts)
        : packing_(packing), dofs_(dofs) {
        for (int i = 0; i < packing.disk_count() && packing.cell.any() && was_ < 0; ++i) {
            was_ = is_pinned(i) ? i : -1;
        }
        is_ = was_ < 0 ? -1 : most_held(packing.disk_count(), contacts);
    }
    [[nodiscard]] bool changes() const { return is_ >= 0 && is_ != was_; }
    /// The row of the formerly pinned disk along the axis of a held
    /// coordinate, which is held relative to that disk; -1: no row.
    [[nodiscard]] int row_against(const Contact& held) const {
        const std::size_t axis = static_cast<std::size_t>(held.i) % packing_.axes();
        const bool of_disk = held.i < packing_.dimension * packing_.disk_count();
        return changes() && of_disk && packing_.cell.periodic[axis] ? row(packing_.layout().of_disk(was_) + axis) : -1;
    }
    /// The row of a coordinate; -1: no row.
    [[nodiscard]] int row(std::size_t coordinate) const {
        const int disk = static_cast<int>(coordinate) / packing_.dimension;
        const std::size_t axis = coordinate % packing_.axes();
        if (!changes() || disk >= packing_.disk_count() || !packing_.cell.periodic[axis]) {
            return dofs_.dof_of(coordinate);
        }
        return disk == is_    ? -1
               : disk == was_ ? dofs_.dof_of(packing_.layout().of_disk(is_) + axis)
                              : dofs_.dof_of(coordinate);
    }

  private:
    [[nodiscard]] bool is_pinned(int disk) const {
        for (std::size_t a = 0; a < packing_.axes(); ++a) {
            if (packing_.cell.periodic[a] && dofs_.dof_of(packing_.layout().of_disk(disk) + a) < 0) {
                return true;
            }
        }
        return false;
    }
    const Packing& packing_;
    const DofMap& dofs_;
    int was_ = -1;
    int is_ = -1;
};

/// The axis along which a degree of freedom moves a disk or a wall; `most_axes`: it moves a period or a tilt.
std::size_t axis_of(const DofMap& dofs, int row) {
    const Layout& layout = dofs.layout();
    const auto coordinate = static_cast<std::size_t>(dofs.coordinate_of(row));
    const std::size_t axis = coordinate % layout.axes();
    const bool wall = coordinate >= layout.of_length(0);
    return wall && (coordinate >= layout.of_length(layout.axes()) || dofs.is_periodic(axis)) ? most_axes : axis;
}

} // namespace

std::vector<int> touched_rows(const DofMap& dofs, const Contact& contact) {
    std::vector<int> rows;
    Separation(contact, dofs.layout()).for_each_coordinate([&](std::size_t coordinate, std::size_t, int) {
        if (const int dof = dofs.dof_of(coordinate); dof >= 0) {
            rows.push_back(dof);
        }
    });
    return rows;
}

ContactPattern::ContactPattern(const Packing& packing, const DofMap& dofs, const std::vector<Contact>& contacts,
                               const sparse::Matrix<double>& matrix, const std::vector<int>& matching, bool perturbed)
    : start_(&matrix.start), row_(&matrix.row), matched_(&matching) {
    const std::vector<int> level = perturbed ? std::vector<int>() : shared_levels(packing, contacts);
    const Repinned pinned(packing, dofs, contacts);
    if (level.empty() && !pinned.changes()) {
        return;
    }
    Parts parts;
    for (const Contact& contact : contacts) {
        const auto of = [&](int disk, int axis) {
            return level[packing.layout().of_disk(disk) + static_cast<std::size_t>(axis)];
        };
        const auto vanishes = [&](int axis) {
            return contact.of_disks() && !level.empty() && of(contact.i, axis) != 0 &&
                   of(contact.i, axis) == of(contact.j, axis) && !is_displaced(contact, axis);
        };
        Separation(contact, packing.layout()).for_each_coordinate([&](std::size_t coordinate, std::size_t axis, int) {
            const int mu = pinned.row(coordinate);
            if (mu >= 0 && !vanishes(static_cast<int>(axis))) {
                parts.row.push_back(mu);
            }
        });
        if (const int mu = contact.kind == ContactKind::held ? pinned.row_against(contact) : -1; mu >= 0) {
            parts.row.push_back(mu);
        }
        parts.start.push_back(static_cast<int>(parts.row.size()));
    }
    if (pinned.changes() || parts.row.size() < matrix.row.size()) {
        parts.matched = sparse::perfect_matching(matrix.rows, parts.start, parts.row);
        if (!parts.matched.empty()) { // else no vertex with these contacts is regular, so no force is decided
            own_ = std::move(parts);
            for (int mu = 0; pinned.changes() && mu < matrix.rows; ++mu) {
                rows_of_disks_ += dofs.coordinate_of(mu) < packing.dimension * packing.disk_count() ? 1 : 0;
            }
        }
    }
}

ContactPattern::View ContactPattern::for_load(std::span<const int> rows) const {
    const bool on_disks = std::ranges::any_of(rows, [this](int row) { return row < rows_of_disks_; });
    return own_ && !on_disks ? View{own_->start, own_->row, own_->matched} : View{*start_, *row_, *matched_};
}

std::vector<unsigned char> ContactPattern::carrying(std::span<const int> rows,
                                                    std::vector<unsigned char> reached) const {
    const View pattern = for_load(rows);
    if (own_ && pattern.start.data() != own_->start.data()) {
        reached.clear(); // `reached` was searched with the other pinned disk
    }
    return sparse::structural_nonzeros(pattern.start, pattern.row, pattern.matched, rows, std::move(reached));
}

std::vector<unsigned char> ContactPattern::carrying_without(ContactId opens, std::span<const int> rows,
                                                            std::span<const int> other_rows) const {
    const View pattern = for_load(other_rows); // `rows` are of walls, or of the cell
    const std::span<const int> all_start = pattern.start;
    const std::span<const int> all_row = pattern.row;
    const std::size_t size = pattern.matched.size();
    std::vector<int> replaced_start{0};
    std::vector<int> replaced_row;
    for (std::size_t l = 0; l < size; ++l) {
        if (l == opens.index()) {
            replaced_row.insert(replaced_row.end(), rows.begin(), rows.end());
        } else {
            replaced_row.insert(replaced_row.end(), all_row.begin() + all_start[l], all_row.begin() + all_start[l + 1]);
        }
        replaced_start.push_back(static_cast<int>(replaced_row.size()));
    }
    const std::vector<int> repaired =
        sparse::repaired_matching(pattern.matched, replaced_start, replaced_row, static_cast<int>(opens.index()));
    return repaired.empty() ? std::vector<unsigned char>(size, 1)
                            : sparse::structural_nonzeros(replaced_start, replaced_row, repaired, other_rows);
}

std::vector<unsigned char> ContactPattern::carrying_by_sums(const DofMap& dofs, std::span<const int> rows,
                                                            std::span<const double> sizes) const {
    const View pattern = for_load(rows);
    std::array<int, most_axes + 1> replaced{-1, -1, -1, -1};
    std::array<double, most_axes + 1> largest{-1, -1, -1, roundoff::infinity};
    for (const int row : rows) {
        largest[axis_of(dofs, row)] = roundoff::infinity; // the sum is loaded too: nothing is gained
    }
    const auto for_each_entry = [&](std::size_t l, const auto& visit) {
        for (int k = pattern.start[l]; k < pattern.start[l + 1]; ++k) {
            const int row = pattern.row[static_cast<std::size_t>(k)];
            visit(row, axis_of(dofs, row));
        }
    };
    for (std::size_t l = 0; l < sizes.size(); ++l) {
        for_each_entry(l, [&](int row, std::size_t axis) {
            if (std::abs(sizes[l]) > largest[axis]) {
                largest[axis] = std::abs(sizes[l]);
                replaced[axis] = row;
            }
        });
    }
    Parts sums;
    for (std::size_t l = 0; l < sizes.size(); ++l) {
        std::array<int, most_axes + 1> entries{};
        for_each_entry(l, [&](int row, std::size_t axis) {
            ++entries[axis];
            if (row != replaced[axis]) {
                sums.row.push_back(row);
            }
        });
        for (std::size_t axis = 0; axis < most_axes; ++axis) {
            if (entries[axis] == 1 && replaced[axis] >= 0) { // two entries are opposite, and cancel in the sum
                sums.row.push_back(replaced[axis]);
            }
        }
        sums.start.push_back(static_cast<int>(sums.row.size()));
    }
    sums.matched = sparse::perfect_matching(static_cast<int>(sizes.size()), sums.start, sums.row);
    std::vector<unsigned char> nonzero = carrying(rows);
    if (!sums.matched.empty()) {
        const auto by_sums = sparse::structural_nonzeros(sums.start, sums.row, sums.matched, rows);
        std::ranges::transform(by_sums, nonzero, nonzero.begin(), std::bit_and<>());
    }
    return nonzero;
}

} // namespace isostat
