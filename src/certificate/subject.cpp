#include "certificate/subject.hpp"

#include <algorithm>

namespace isostat {

namespace {

/// Per coordinate of the disks: 0, or a number that is common to all disks of one radius that one wall holds there.
template <int Dim> std::vector<std::pair<int, double>> held_by_walls(const State<Dim>& state) {
    std::vector<std::pair<int, double>> hold(state.packing.q.size(), {0, 0.0});
    for (const Contact& contact : state.contacts) {
        if (contact.kind == ContactKind::lower_wall || contact.kind == ContactKind::upper_wall) {
            hold[static_cast<std::size_t>(Dim * contact.i + contact.j)] = {
                contact.kind == ContactKind::lower_wall ? -1 : +1,
                state.packing.radius[static_cast<std::size_t>(contact.i)]};
        }
    }
    return hold;
}

template <int Dim> ContactPattern pattern_of(const State<Dim>& state, const DofMap<Dim>& dofs, bool exact) {
    const auto hold = held_by_walls(state);
    ContactPattern pattern;
    for (const Contact& contact : state.contacts) {
        const std::size_t begin = pattern.row.size();
        const auto touch = [&](int coordinate) {
            const int dof = dofs.dof_of(static_cast<std::size_t>(coordinate));
            if (dof >= 0) {
                pattern.row.push_back(dof);
            }
        };
        if (contact.kind == ContactKind::disk_disk) {
            for (int a = 0; a < Dim; ++a) {
                const auto& at_i = hold[static_cast<std::size_t>(Dim * contact.i + a)];
                const auto& at_j = hold[static_cast<std::size_t>(Dim * contact.j + a)];
                if (!exact || at_i.first == 0 || at_i != at_j) {
                    touch(Dim * contact.i + a);
                    touch(Dim * contact.j + a);
                }
            }
        } else {
            touch(Dim * contact.i + contact.j);
            if (contact.kind == ContactKind::upper_wall) {
                touch(Dim * state.packing.disk_count() + contact.j);
            }
        }
        std::sort(pattern.row.begin() + static_cast<std::ptrdiff_t>(begin), pattern.row.end());
        pattern.start.push_back(static_cast<int>(pattern.row.size()));
    }
    pattern.matched = sparse::perfect_matching(dofs.dof_count(), pattern.start, pattern.row);
    return pattern;
}

std::vector<unsigned char> zeros(const ContactPattern& pattern, const std::vector<int>& loaded) {
    if (pattern.matched.empty()) {
        return std::vector<unsigned char>(pattern.start.size() - 1, 0); // no true vertex is regular: nothing is known
    }
    std::vector<unsigned char> zero = sparse::structural_nonzeros(pattern.start, pattern.row, pattern.matched, loaded);
    for (unsigned char& z : zero) {
        z = z == 0 ? 1 : 0;
    }
    return zero;
}

} // namespace

template <int Dim>
Subject<Dim>::Subject(const State<Dim>& s)
    : state(s), dofs(s.packing), touched(pattern_of(s, dofs, false)), exact(pattern_of(s, dofs, true)) {
    const std::vector<double> force = s.load.fixed_force(s.packing);
    for (std::size_t k = 0; k < force.size(); ++k) {
        if (force[k] != 0 && dofs.dof_of(k) >= 0) {
            loaded_rows.push_back(dofs.dof_of(k));
        }
    }
    wall_row = dofs.dof_of(static_cast<std::size_t>(Dim * s.packing.disk_count() + s.load.loaded_axis));
    std::vector<int> all = loaded_rows;
    if (wall_row >= 0) {
        all.push_back(wall_row); // also when its stress is 0 now
    }
    zero = zeros(touched, all);
    zero_slope = wall_row < 0 ? std::vector<unsigned char>(s.contacts.size(), 1) : zeros(exact, {wall_row});
}

template <int Dim> std::vector<int> Subject<Dim>::vanish_with(int opens) const {
    ContactPattern replaced;
    for (int l = 0; l < size(); ++l) {
        const auto k = static_cast<std::size_t>(l);
        if (l == opens) {
            replaced.row.push_back(wall_row);
        } else {
            replaced.row.insert(replaced.row.end(), exact.row.begin() + exact.start[k],
                                exact.row.begin() + exact.start[k + 1]);
        }
        replaced.start.push_back(static_cast<int>(replaced.row.size()));
    }
    replaced.matched = sparse::perfect_matching(dofs.dof_count(), replaced.start, replaced.row);
    std::vector<int> members;
    if (replaced.matched.empty()) {
        return members; // cannot happen when the slope of `opens` is not zero; then nothing is claimed to vanish
    }
    const std::vector<unsigned char> vanishes = zeros(replaced, loaded_rows);
    for (int l = 0; l < size(); ++l) {
        const auto k = static_cast<std::size_t>(l);
        if (l != opens && vanishes[k] != 0 && zero[k] == 0) {
            members.push_back(l);
        }
    }
    return members;
}

template class Subject<2>;

} // namespace isostat
