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
    State state = start;
    const int n = start.packing.disk_count();
    for (int i = 0; i < n; ++i) {
        const auto to = static_cast<std::size_t>(n - 1 - i);
        const auto from = static_cast<std::size_t>(i);
        state.packing.radius[to] = start.packing.radius[from];
        for (std::size_t a = 0; a < 2; ++a) {
            state.packing.q[2 * to + a] = start.packing.q[2 * from + a];
            state.load.infinitesimal[2 * to + a] = start.load.infinitesimal[2 * from + a];
        }
    }
    state.packing.cell.pin = n - 1 - start.packing.cell.pin;
    const auto rename = [n](const Contact& c) {
        return c.kind == isostat::ContactKind::disk_disk ? isostat::pair_of(n - 1 - c.i, n - 1 - c.j, c.image)
                                                         : Contact{c.kind, n - 1 - c.i, c.j};
    };
    return ::crafted::disguised(std::move(state), rename, rename);
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
