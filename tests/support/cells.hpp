#pragma once
// Small packings in periodic cells with closed-form answers. Dead forces F1, F2 on the periods and T on the tilt:
// reference lengths 1, so that stress and force have the same number.

#include "support/crafted.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/io/state_file.hpp>

namespace cells {

using ::crafted::DiskAt;
using isostat::Contact;
using isostat::Image;
using isostat::State;

inline Image image(int x, int y) {
    return {{static_cast<std::int8_t>(x), static_cast<std::int8_t>(y), 0}};
}
inline Contact across(int i, int j, int x, int y) {
    return isostat::pair_of(i, j, image(x, y));
}

/// Lx, Ly and the tilt of a cell with both axes periodic.
struct Periods {
    double x, y, tilt;
};

/// Rectangular: both periods move. With `tilts` the tilt too.
inline State in_cell(const std::vector<DiskAt>& disks, const Periods& periods, bool tilts, double f1, double f2,
                     std::vector<Contact> contacts) {
    State state;
    for (const DiskAt& d : disks) {
        state.packing.radius.push_back(d.radius);
        state.packing.q.insert(state.packing.q.end(), {d.x, d.y});
    }
    state.packing.q.insert(state.packing.q.end(), {periods.x, periods.y, periods.tilt});
    state.packing.walls = isostat::Walls::none();
    state.packing.cell = {{true, true}, {true, true}, {tilts}, 0};
    state.load.stress = {f1, f2};
    state.load.reference_length = {1, 1};
    state.contacts = std::move(contacts);
    return state;
}

/// Periodic along x, between a fixed wall below and a movable one above.
inline State in_channel(const std::vector<DiskAt>& disks, double period, double height, double f1, double f2,
                        std::vector<Contact> contacts) {
    State state = in_cell(disks, {period, height, 0}, false, f1, f2, std::move(contacts));
    state.packing.cell = {{true, false}, {true, false}, {false}, 0};
    state.packing.walls.lower[1] = isostat::WallKind::fixed;
    state.packing.walls.upper[1] = isostat::WallKind::movable;
    return state;
}

/// One disk of radius 1 that touches its image and both walls.
inline State channel_disk() {
    return in_channel({{1, 0.5, 1}}, 2, 2, 2, 3, {across(0, 0, 1, 0), ::crafted::bottom(0), ::crafted::top(0)});
}

/// Disks of radii R1 > R2 on the bottom of a channel, the second between the first and its image.
inline State between_images(double large, double small) {
    const double width = 2 * std::sqrt(large * small);
    return in_channel(
        {{large, 0, large}, {small, width, small}}, 2 * width, 2 * large, 1, 1,
        {::crafted::bottom(0), ::crafted::top(0), ::crafted::bottom(1), across(0, 1, 0, 0), across(0, 1, -1, 0)});
}

/// A small disk that rests on another one and an image of it, under an infinitesimal force; there is room for it below
/// the next images up to a radius of sqrt 2 - 1.
inline State with_a_rattler(double radius) {
    State state = in_cell({{1, 0, 0}, {radius, 1, std::sqrt((2 + radius) * radius)}}, {2, 2, 0}, false, 2, 3,
                          {across(0, 0, 0, 1), across(0, 0, 1, 0), across(0, 1, 0, 0), across(0, 1, -1, 0)});
    state.load.infinitesimal = {0, 1, 0, -1};
    return state;
}

/// One disk of radius 1 that touches its images along x and y.
inline State one_disk(double f1, double f2) {
    return in_cell({{1, 0.25, 0.5}}, {2, 2, 0}, false, f1, f2, {across(0, 0, 0, 1), across(0, 0, 1, 0)});
}

/// One disk of radius 1 in the triangular lattice, under a shear force t.
inline State one_tilted_disk(double f1, double f2, double t) {
    State state = in_cell({{1, 0.25, 0.5}}, {2, std::sqrt(3.0), 1}, true, f1, f2,
                          {across(0, 0, 0, 1), across(0, 0, 1, -1), across(0, 0, 1, 0)});
    state.load.shear = {t};
    return state;
}

/// Radii 1.2 and 0.8, the second in the centre of a rectangle 2 x 1.2 by 2 x 1.6, touching four images of the first.
inline State two_disks(bool tilts, double f1, double f2) {
    return in_cell({{1.2, 0, 0}, {0.8, 1.2, 1.6}}, {2.4, 3.2, 0}, tilts, f1, f2,
                   {across(0, 1, 0, 0), across(0, 1, -1, 0), across(0, 1, 0, -1), across(0, 1, -1, -1)});
}

/// With closed forms, each certified and verified in every arithmetic.
inline std::vector<State> small() {
    return {one_disk(2, 3), one_tilted_disk(2, 1, 0.25), channel_disk(), with_a_rattler(0.3)};
}

/// m x m disks of diameter 1 in a square.
inline State square_lattice(int m, bool tilts) {
    std::vector<DiskAt> disks;
    std::vector<Contact> contacts;
    const auto index = [m](int x, int y) { return m * (y % m) + x % m; };
    for (int y = 0; y < m; ++y) {
        for (int x = 0; x < m; ++x) {
            disks.push_back({0.5, static_cast<double>(x), static_cast<double>(y)});
            contacts.push_back(across(index(x, y), index(x + 1, y), x + 1 == m ? 1 : 0, 0));
            contacts.push_back(across(index(x, y), index(x, y + 1), 0, y + 1 == m ? 1 : 0));
        }
    }
    const double length = m;
    return in_cell(disks, {length, length, 0}, tilts, 1, 1, contacts);
}

/// a columns and 2 b rows of the triangular lattice, disks of diameter 1.
inline State triangular_lattice(int a, int b, bool tilts) {
    std::vector<DiskAt> disks;
    std::vector<Contact> contacts;
    const int rows = 2 * b;
    const double height = std::sqrt(0.75);
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < a; ++x) {
            disks.push_back({0.5, x + 0.5 * (y % 2), height * y});
            const int here = a * y + x;
            const int up = a * ((y + 1) % rows);
            const int over = y + 1 == rows ? 1 : 0;
            const int right = x + (y % 2); // of the two above, the right one when x counts from the left
            contacts.push_back(across(here, a * y + (x + 1) % a, x + 1 == a ? 1 : 0, 0));
            contacts.push_back(across(here, up + right % a, right / a, over));
            contacts.push_back(across(here, up + (right + a - 1) % a, (right + a - 1) / a - 1, over));
        }
    }
    return in_cell(disks, {static_cast<double>(a), height * rows, 0}, tilts, 1, 1, contacts);
}

/// A packing of an independent program (tests/data/cells), another disk pinned or not.
inline State of_file(const std::string& name, std::optional<int> pin = {}) {
    State state = isostat::read_any_state(std::string(ISOSTAT_TEST_DATA) + "/cells/" + name + ".json").state;
    if (pin) {
        state.packing.cell.pin = *pin;
        snap_to_grid(state.packing);
    }
    return state;
}

/// Loads that balance, and coordinates on the grid: a run may start from it.
inline State with_infinitesimal_loads(State state) {
    state.load.infinitesimal = isostat::generic_infinitesimal(state.packing.radius, 7);
    balance(state.load.infinitesimal, state.packing.cell);
    snap_to_grid(state.packing);
    return state;
}

/// Its cell moved by other representatives: disk i shifted by `shift[i]` periods, the same contacts.
inline State with_other_representatives(State state, const std::vector<Image>& shift) {
    const isostat::Packing packing = state.packing;
    const std::size_t axes = packing.axes();
    for (std::size_t i = 0; i < shift.size(); ++i) {
        for (std::size_t a = 0; a < axes; ++a) {
            for (std::size_t b = a; b < axes; ++b) {
                state.packing.q[axes * i + a] += shift[i].m[b] == 0 ? 0 : shift[i].m[b] * packing.lattice(a, b);
            }
        }
    }
    for (Contact& c : state.contacts) {
        if (c.kind == isostat::ContactKind::disk_disk) {
            Image m = c.image;
            for (std::size_t a = 0; a < axes; ++a) {
                m.m[a] = static_cast<std::int8_t>(m.m[a] + shift[static_cast<std::size_t>(c.i)].m[a] -
                                                  shift[static_cast<std::size_t>(c.j)].m[a]);
            }
            c = isostat::pair_of(c.i, c.j, m);
        }
    }
    return state;
}

} // namespace cells
