#pragma once
// An arc in a channel with a known course: a disk is squeezed up between another one and its image while the period
// shrinks, past an obstacle whose clearance is given.

#include "support/cells.hpp"

namespace cells {

/// Disk 0 (radius 2) on the bottom, disk 1 (radius 1) between it and its image one period further, at an angle above
/// the horizontal; disk 2 (radius 0.1) is held so that disk 1 passes it at `passes`, as near as `clearance`. The period
/// is 6 cos(angle). Contact 6 changes: the bottom at the start, the top, which is held too, at the end.
/// A force pulls disk 1 up. `shift`: by how many periods disk 1 is stored further along x.
struct ChannelRoll {
    static constexpr double ends = 0.25 * 3.14159265358979323846;
    static constexpr double passes = 0.61;
    static constexpr double origin = -3; ///< of x: a side of the cell is between disk 1 and the obstacle
    static constexpr std::size_t slot = 6;
    double clearance = 1e-2;
    int shift = 0;

    static double begins() { return -std::asin(1.0 / 3.0); }
    [[nodiscard]] State at(double angle, const Contact& other) const {
        const double period = 6 * std::cos(angle);
        const double away = 4.1 + clearance;
        const auto short_number = [](double x) { return std::ldexp(std::nearbyint(std::ldexp(x, 40)), -40); };
        State state = in_channel(
            {{2, origin, 2},
             {1, origin + 3 * std::cos(angle) + shift * period, 2 + 3 * std::sin(angle)},
             {0.1, short_number(origin + away * std::cos(passes)), short_number(2 + away * std::sin(passes))}},
            period, short_number(3 + 3 * std::sin(ends)), 1, 1, {});
        state.load.disk_force = {0, 0, 0, 20, 0, 0};
        const auto held = [](int k) { return Contact{isostat::ContactKind::held, k, 0}; };
        state.contacts = {
            crafted::bottom(0), across(0, 1, -shift, 0), across(0, 1, -1 - shift, 0), held(4), held(5), held(7), other};
        return state;
    }
    [[nodiscard]] State start() const { return at(begins(), crafted::bottom(1)); }
    [[nodiscard]] State end() const { return at(ends, crafted::top(1)); }
    /// Disk 1 and the obstacle.
    [[nodiscard]] Contact passing() const { return across(1, 2, shift, 0); }
};

} // namespace cells
