#pragma once
// One packing in a periodic cell, described otherwise.

#include "support/cells.hpp"
#include "support/same_sequence.hpp"

namespace cells {

using ::crafted::Disguised;

/// Disk i stored in another period, shift[i] periods further: the same packing.
inline Disguised shifted(const State& start, const std::vector<Image>& shift) {
    State state = with_other_representatives(start, shift);
    snap_to_grid(state.packing);
    const auto back = [shift](const Contact& c) {
        if (c.kind != isostat::ContactKind::disk_disk) {
            return c;
        }
        const auto& i = shift[static_cast<std::size_t>(c.i)].m;
        const auto& j = shift[static_cast<std::size_t>(c.j)].m;
        return across(c.i, c.j, c.image.m[0] - (i[0] - j[0]), c.image.m[1] - (i[1] - j[1]));
    };
    return {std::move(state), back};
}

/// Disks in the opposite order.
inline Disguised reversed(const State& start) {
    std::vector<int> label(start.packing.radius.size());
    std::iota(label.rbegin(), label.rend(), 0);
    Disguised other = ::crafted::with_labels(start, label);
    other.state.packing.cell.pin = start.packing.disk_count() - 1 - start.packing.cell.pin;
    return other;
}

/// x and y exchanged. \pre no tilt
inline Disguised transposed(const State& start) {
    Disguised other = ::crafted::exchanged(start);
    State& state = other.state;
    const auto swap_axes = [](auto& pair) { std::swap(pair[0], pair[1]); };
    swap_axes(state.packing.cell.periodic);
    swap_axes(state.packing.cell.period_moves);
    swap_axes(state.packing.walls.lower);
    swap_axes(state.packing.walls.upper);
    state.contacts = start.contacts;
    const auto exchange = [](const Contact& c) {
        return c.kind == isostat::ContactKind::disk_disk ? across(c.i, c.j, c.image.m[1], c.image.m[0])
                                                         : Contact{c.kind, c.i, 1 - c.j};
    };
    return ::crafted::disguised(std::move(state), exchange, exchange);
}

/// Period vectors a and b + times a instead of a and b. \pre the tilt moves, no shear stress
inline Disguised in_other_basis(const State& start, int times) {
    State state = start;
    state.packing.q[state.packing.tilt_at(0, 1)] += times * start.packing.length(0);
    const auto moved = [](int by) {
        return [by](const Contact& c) { return across(c.i, c.j, c.image.m[0] - by * c.image.m[1], c.image.m[1]); };
    };
    return ::crafted::disguised(std::move(state), moved(times), moved(-times));
}

} // namespace cells
