#pragma once
// Small packings with closed-form answers, built by hand. Box with fixed lower walls and movable upper walls, dead wall
// forces F1 (right wall) and F2 (top wall): reference lengths 1, so that stress and force have the same number.

#include "support/recorder.hpp"
#include "support/test.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/trajectory/trajectory.hpp>

namespace crafted {

using isostat::Contact;
using isostat::ContactKind;
using isostat::State;

inline Contact pair(int i, int j) {
    return {ContactKind::disk_disk, std::min(i, j), std::max(i, j)};
}
inline Contact left(int i) {
    return {ContactKind::lower_wall, i, 0};
}
inline Contact bottom(int i) {
    return {ContactKind::lower_wall, i, 1};
}
inline Contact right(int i) {
    return {ContactKind::upper_wall, i, 0};
}
inline Contact top(int i) {
    return {ContactKind::upper_wall, i, 1};
}

struct DiskAt {
    double radius, x, y;
};

/// Every coordinate changed by up to `size`.
inline State pushed(State state, double size) {
    for (std::size_t k = 0; k < state.packing.q.size(); ++k) {
        state.packing.q[k] += size * std::sin(7.0 * static_cast<double>(k));
    }
    return state;
}

/// A state in the box [0, lx] x [0, ly] under wall forces f1, f2.
inline State in_box(const std::vector<DiskAt>& disks, double lx, double ly, double f1, double f2,
                    std::vector<Contact> contacts) {
    State state;
    for (const DiskAt& d : disks) {
        state.packing.radius.push_back(d.radius);
        state.packing.q.push_back(d.x);
        state.packing.q.push_back(d.y);
    }
    state.packing.q.push_back(lx);
    state.packing.q.push_back(ly);
    state.load.stress = {f1, f2};
    state.load.reference_length = {1, 1};
    state.load.infinitesimal = isostat::generic_infinitesimal(state.packing.radius, 7);
    state.contacts = std::move(contacts);
    isostat::snap_to_grid(state.packing);
    return state;
}

/// Case 1: one disk of radius 1 between the four walls.
inline State one_disk(double f1, double f2) {
    return in_box({{1, 1, 1}}, 2, 2, f1, f2, {left(0), right(0), bottom(0), top(0)});
}

/// Case 2: disk 0 in the bottom-left corner, disk 1 on bottom, right and top; R0 < R1 < (3 + 2 sqrt 2) R0.
inline State two_disks(double r0, double r1, double f1, double f2) {
    const double dx = 2 * std::sqrt(r0 * r1);
    return in_box({{r0, r0, r0}, {r1, r0 + dx, r1}}, r0 + dx + r1, 2 * r1, f1, f2,
                  {left(0), bottom(0), pair(0, 1), right(1), top(1), bottom(1)});
}

/// Case 3: base disks of radii ra, rb touching each other, the side walls and the bottom; a disk of radius rt on both,
/// under the top wall.
inline State three_disks(double ra, double rb, double rt, double f1, double f2) {
    const double xa = ra;
    const double xb = ra + 2 * std::sqrt(ra * rb);
    // Apex over two circles: intersection of the circles of radii ra + rt and rb + rt about the base centres.
    const double d0 = ra + rt;
    const double d1 = rb + rt;
    const double bx = xb - xa;
    const double by = rb - ra;
    const double d = std::hypot(bx, by);
    const double along = (d0 * d0 - d1 * d1 + d * d) / (2 * d);
    const double across = std::sqrt(d0 * d0 - along * along);
    const double x = xa + (along * bx - across * by) / d;
    const double y = ra + (along * by + across * bx) / d;
    return in_box({{ra, xa, ra}, {rb, xb, rb}, {rt, x, y}}, xb + rb, y + rt, f1, f2,
                  {left(0), bottom(0), pair(0, 1), pair(0, 2), pair(1, 2), right(1), bottom(1), top(2)});
}

/// Case 4: m x m square lattice of unit disks with every contact.
inline State square_lattice(int m) {
    std::vector<DiskAt> disks;
    std::vector<Contact> contacts;
    for (int row = 0; row < m; ++row) {
        for (int column = 0; column < m; ++column) {
            const int i = row * m + column;
            disks.push_back({1, 1.0 + 2 * column, 1.0 + 2 * row});
            contacts.push_back(column == 0 ? left(i) : pair(i - 1, i));
            contacts.push_back(row == 0 ? bottom(i) : pair(i - m, i));
            if (column == m - 1) {
                contacts.push_back(right(i));
            }
            if (row == m - 1) {
                contacts.push_back(top(i));
            }
        }
    }
    return in_box(disks, 2.0 * m, 2.0 * m, 1, 1, contacts);
}

/// Case 5: rows x columns triangular patch of unit disks in its box, odd rows shifted by one radius, with every contact
/// (to rounding).
inline State triangular_patch(int rows, int columns) {
    std::vector<DiskAt> disks;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            disks.push_back({1, 1.0 + 2 * column + (row % 2), 1 + std::sqrt(3.0) * row});
        }
    }
    const double lx = 2.0 * columns + (rows > 1 ? 1 : 0);
    const double ly = 2 + std::sqrt(3.0) * (rows - 1);
    State state = in_box(disks, lx, ly, 1, 1, {});
    const auto touches = [&](const Contact& c) { return std::abs(isostat::gap(state.packing, c)) < 1e-12; };
    const int n = rows * columns;
    for (int i = 0; i < n; ++i) {
        for (const Contact& c : {left(i), bottom(i), right(i), top(i)}) {
            if (touches(c)) {
                state.contacts.push_back(c);
            }
        }
        for (int j = i + 1; j < n; ++j) {
            if (touches(pair(i, j))) {
                state.contacts.push_back(pair(i, j));
            }
        }
    }
    return state;
}

/// One segment from a state, with the records.
struct Played {
    /// Why it did not complete, for messages.
    [[nodiscard]] std::string why() const { return outcome.failure ? outcome.failure->message() : "completed"; }

    State state;
    Recorder records;
    isostat::RunCounters counters;
    isostat::SegmentOutcome outcome;
};
inline Played play(State state, int direction, std::optional<int> equilibria, std::optional<double> to = {},
                   isostat::RunOptions options = {}) {
    options.max_strain = 1e9; // strains are relative to reference lengths of 1 here
    Played played;
    played.state = std::move(state);
    isostat::Segment segment;
    segment.direction = direction;
    segment.equilibria = equilibria;
    segment.to_stress = to;
    played.outcome = isostat::run_segment(played.state, segment, 0, options, played.counters, played.records);
    return played;
}

/// The run, which must have come to its end.
inline Played completed(Played played) {
    BOOST_TEST_REQUIRE(played.outcome.completed, played.why());
    return played;
}

/// One arc alone, at this stress.
inline void check_arc(const Played& played, const Contact& opened, const Contact& closed, double stress) {
    BOOST_TEST_REQUIRE(played.outcome.completed, played.why());
    BOOST_TEST_REQUIRE(played.records.arcs.size() == 1U);
    const isostat::ArcRecord& arc = played.records.arcs.front();
    BOOST_TEST((arc.opened == opened), to_string(arc.opened) << " opened");
    BOOST_TEST((arc.closed == closed), to_string(arc.closed) << " closed");
    BOOST_TEST(arc.stress == stress, boost::test_tools::tolerance(1e-12));
}

} // namespace crafted
