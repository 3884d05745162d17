#pragma once
/// \file
/// Packings of clumps: closed forms, and those of an independent program (tests/data/clumps/README.md).

#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace isostat::test {

/// What the independent program counted stands in the provenance.
inline State clumps(const std::string& name) {
    return read_any_state(std::string(ISOSTAT_TEST_DATA) + "/clumps/" + name + ".json", Dimensions::any_bodies).state;
}

inline State clumps_of(const std::string& text) {
    return parse_any_state(text, "clumps", Dimensions::any_bodies).state;
}

/// Places that are equilibria but for torques on bodies whose angles were held.
inline std::vector<State> held_angles() {
    std::vector<State> states;
    std::ifstream file(std::string(ISOSTAT_TEST_DATA) + "/clumps/held_angles.json");
    for (const auto& state : nlohmann::json::parse(file)) {
        states.push_back(clumps_of(state.dump()));
    }
    return states;
}

/// Several forces vanish together where a body rises: the infinitesimal loads say which contact opens.
inline State with_infinitesimal(State state) {
    state.load.infinitesimal = generic_infinitesimal(state.packing.radius, 1, state.packing.dimension);
    return state;
}

/// Two unequal members lie on the bottom, the larger one at the left wall and under the lid: with sin phi = (R - r) / l
/// the forces are F_1 at the sides, F_2 at the lid, F_1 tan phi below the small member, F_2 - F_1 tan phi below the
/// large one, - F_1 / cos phi in the bar (a thrust). At l = 13/8, R - r = 5/8 the cosine is 12/13.
inline State lying_dimer(double f1, double f2) {
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2,
        "load": {{"stress": [{}, {}], "reference_length": [1, 1]}}, "disks": [[1, 1, 1], [2.5, 0.375, 0.375]],
        "length": [2.875, 2], "bars": [[0, 1, 1.625]],
        "contacts": [[0, "left"], [0, "bottom"], [1, "bottom"], [1, "right"], [0, "top"]]}})",
                                 f1, f2));
}

/// A disk in the notch of a dimer that lies between the side walls: radii 5/4 and 1, at a distance of 3/2 to either
/// side and sqrt(45)/4 above. The side walls bear F_1, whatever F_2 is: the left one by the balance of the whole alone.
inline State notch(double f1, double f2) {
    const double above = std::sqrt(45.0) / 4;
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [5, {:.17g}],
        "load": {{"stress": [{}, {}], "reference_length": [1, 1]}}, "bars": [[0, 1, 3]],
        "disks": [[1, 1, 1], [4, 1, 1], [2.5, {:.17g}, 1.25]],
        "contacts": [[0, "left"], [0, "bottom"], [1, "bottom"], [1, "right"], [0, 2], [1, 2], [2, "top"]]}})",
                                 2.25 + above, f1, f2, 1 + above));
}

/// A disk between side walls and top, that stands on a dimer of equal members, 5-12-13: it bears 13 (F_2 - lift) / 24
/// at both, as nothing else presses on the dimer along the bottom.
inline State perch(double f1, double f2, double lift) {
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [5.5, 6.25],
        "load": {{"stress": [{}, {}], "reference_length": [1, 1]}}, "bars": [[0, 1, 2.5]],
        "disks": [[1.5, 0.5, 0.5], [4, 0.5, 0.5], [2.75, 3.5, 2.75]], "disk_force": [[0, 0], [0, 0], [0, {}]],
        "contacts": [[2, "left"], [2, "right"], [2, "top"], [0, 2], [1, 2], [0, "bottom"], [1, "bottom"]]}})",
                                 f1, f2, lift));
}

/// A disk between four walls with a member inside that touches nothing: it turns about the centre of the disk.
inline State disk_with_a_dangling_member() {
    return clumps_of(R"({"format": "isostat-state", "version": 2, "length": [2, 2],
        "disks": [[1, 1, 1], [1.25, 1.5, 0.25]], "bars": [[0, 1, "0x1.1e3779b97f4a8p-1"]],
        "contacts": [[0, "left"], [0, "right"], [0, "bottom"], [0, "top"]]})");
}

/// A disk of radius 1 in the corner of two walls, under the force (-3, -4) on a small member at an arm of 5/8: turned
/// by pi at `angle` 0, it hangs in the direction of the force. W'' = 25/8 per radian squared, 12.5 per x of the member.
inline State disk_in_a_corner(double angle = 0) {
    const double x = -0.375 * std::cos(angle) + 0.5 * std::sin(angle);
    const double y = -0.375 * std::sin(angle) - 0.5 * std::cos(angle);
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [10, 10],
        "walls": {{"lower": ["fixed", "fixed"], "upper": ["absent", "absent"]}}, "disk_force": [[0, 0], [-3, -4]],
        "load": {{"stress": [0, 0], "reference_length": [10, 10]}}, "bars": [[0, 1, 0.625]],
        "disks": [[1, 1, 1], [{:.17g}, {:.17g}, 0.0625]], "contacts": [[0, "left"], [0, "bottom"]]}})",
                                 1 + x, 1 + y));
}

/// Its member touches the bottom before it hangs.
inline State disk_that_lands() {
    State state = disk_in_a_corner(-0x1p-20);
    state.packing.radius[1] = 0.5 + 0x1p-23;
    return state;
}

/// A sphere in the corner of three walls, 2-3-6-7: it hangs in the direction of its load, about two axes.
inline State sphere_in_a_corner() {
    return clumps_of(R"({"format": "isostat-state", "version": 2, "dimension": 3, "length": [10, 10, 10],
        "walls": {"lower": ["fixed", "fixed", "fixed"], "upper": ["absent", "absent", "absent"]},
        "disk_force": [[0, 0, 0], [-2, -3, -6]], "bars": [[0, 1, 0.875]],
        "load": {"stress": [0, 0, 0], "reference_length": [10, 10, 10]},
        "disks": [[1, 1, 1, 1], [0.75, 0.625, 0.25, 0.0625]],
        "contacts": [[0, "left"], [0, "bottom"], [0, "back"]]})");
}

/// Two bodies that turn about fixed members, below which or above which they stand, level with them: forces along y on
/// the free members. A negative one hangs, a positive one stands on its head. W'' = |F| per x squared.
inline State pendulums(double first, double second) {
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [10, 10], "fixed": [0, 2],
        "walls": {{"lower": ["absent", "absent"], "upper": ["absent", "absent"]}}, "bars": [[0, 1, 1], [2, 3, 1]],
        "load": {{"stress": [0, 0], "reference_length": [10, 10]}},
        "disk_force": [[0, 0], [0, {}], [0, 0], [0, {}]], "contacts": [],
        "disks": [[2, 5, 0.25], [2, 4, 0.25], [7, 5, 0.25], [7, 4, 0.25]]}})",
                                 first, second));
}

/// W'' is 2^-20 along one mechanism and 1 along the other, where the pendulum is 2^-30 beside its minimum.
inline State flat_beside_steep() {
    State state = pendulums(-0x1p-20, -1);
    state.packing.q[6] = 7 + 0x1p-30;
    return state;
}

/// An oval between four walls, turned by `angle`: caps of radius 1 at a distance of 3 from the middle, flanks of radius
/// 6 with centres at a distance of 4, 3-4-5. Half lengths 4 and 2; W'' = 2 (4 F_2 - 3 F_1) per radian squared, a
/// sixteenth of that per x of a flank. Members: right cap, upper flank, left cap, lower flank.
inline State oval_in_a_box(double f1, double f2, double angle = 0) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double x = 1 + 3 * c; // of the middle
    const double y = 6 - 4 * c;
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [{:.17g}, {:.17g}],
        "load": {{"stress": [{:.17g}, {:.17g}], "reference_length": [1, 1]}},
        "disks": [[{:.17g}, {:.17g}, 1], [{:.17g}, {:.17g}, 6], [{:.17g}, {:.17g}, 1], [{:.17g}, {:.17g}, 6]],
        "bars": [[0, 1, 5], [0, 2, 6], [0, 3, 5], [1, 2, 5], [2, 3, 5]], "arcs": [[0, 1, 2, 3]],
        "contacts": [[2, "left"], [0, "right"], [3, "bottom"], [1, "top"]]}})",
                                 2 * x, 2 * y, f1, f2, x + 3 * c, y + 3 * s, x + 4 * s, y - 4 * c, x - 3 * c, y - 3 * s,
                                 x - 4 * s, y + 4 * c));
}

/// The circle of one flank lies in the corner of two walls, beyond the arc, and a force on the other flank would keep
/// it there, as the disk above. The oval itself touches nothing: its caps are 0.05 from the walls.
inline State circle_of_an_oval_in_a_corner() {
    const double h = std::sqrt(0.5);
    const double middle = 6 - 4 * h;
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [20, 20],
        "walls": {{"lower": ["fixed", "fixed"], "upper": ["absent", "absent"]}},
        "load": {{"stress": [0, 0], "reference_length": [20, 20]}},
        "disk_force": [[0, 0], [-1, -1], [0, 0], [0, 0]],
        "disks": [[{:.17g}, {:.17g}, 1], [{:.17g}, {:.17g}, 6], [{:.17g}, {:.17g}, 1], [6, 6, 6]],
        "bars": [[0, 1, 5], [0, 2, 6], [0, 3, 5], [1, 2, 5], [2, 3, 5]], "arcs": [[0, 1, 2, 3]],
        "contacts": [[3, "left"], [3, "bottom"]]}})",
                                 middle + 3 * h, middle - 3 * h, 6 - 8 * h, 6 - 8 * h, middle - 3 * h, middle + 3 * h));
}

/// Beside it on the bottom the same disk once more, which leans against the first one: k = 2.
inline State two_disks_in_a_corner() {
    return clumps_of(R"({"format": "isostat-state", "version": 2, "length": [10, 10],
        "walls": {"lower": ["fixed", "fixed"], "upper": ["absent", "absent"]},
        "disk_force": [[0, 0], [-3, -4], [0, 0], [-3, -4]],
        "load": {"stress": [0, 0], "reference_length": [10, 10]}, "bars": [[0, 1, 0.625], [2, 3, 0.625]],
        "disks": [[1, 1, 1], [0.625, 0.5, 0.0625], [3, 1, 1], [2.625, 0.5, 0.0625]],
        "contacts": [[0, "left"], [0, "bottom"], [0, 2], [2, "bottom"]]})");
}

/// Equal members in opposite corners of a box, 3-4-5: in balance where the load is along the bar, and W has a maximum
/// as the dimer turns: W'' = - 25 F / 5 along the angle.
inline State dimer_across(double f1, double f2) {
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [5, 6],
        "load": {{"stress": [{}, {}], "reference_length": [1, 1]}}, "disks": [[1, 1, 1], [4, 5, 1]],
        "bars": [[0, 1, 5]], "contacts": [[0, "left"], [0, "bottom"], [1, "right"], [1, "top"]]}})",
                                 f1, f2));
}

/// The lying dimer in space, R - r = 6, l = 11, 7 along x: tan = 6/7 towards the bottom and towards the back.
inline State lying_dimer_in_space() {
    return clumps_of(R"({"format": "isostat-state", "version": 2, "dimension": 3, "length": [15, 14, 14],
        "load": {"stress": [7, 10, 10], "reference_length": [1, 1, 1]}, "disks": [[7, 7, 7, 7], [14, 1, 1, 1]],
        "bars": [[0, 1, 11]], "contacts": [[0, "left"], [1, "right"], [0, "bottom"], [1, "bottom"], [0, "top"],
        [0, "back"], [1, "back"], [0, "front"]]})");
}

/// Dimers in a row that lie on the bottom of a channel, one in each period: the small member touches the large one of
/// the next dimer (tan 3/4; 5/12 along the bar).
inline State row_of_dimers() {
    return clumps_of(R"({"format": "isostat-state", "version": 2, "length": [2.8, 2],
        "cell": {"axes": ["periodic", "walls"], "moves": ["x"], "tilt": [0], "pin": 0},
        "load": {"stress": [12, 20], "reference_length": [1, 1]}, "disks": [[1, 1, 1], [2.8, 0.25, 0.25]],
        "bars": [[0, 1, 1.95]], "contacts": [[0, 1, [-1, 0]], [0, "bottom"], [1, "bottom"], [0, "top"]]})");
}

/// One dimer per period, both of which move: it touches its next images along x and along y, where its bar, 3-3, leans
/// towards both, at 4-3. A couple (g, g) on the members holds it upright: with L = 3 (cos + sin) + (25 - 9 (cos -
/// sin)^2)^(1/2) along x, and so on, W'' = 6 g - (3 + 81/64) (F_1 + F_2) per radian squared, L_x' = -21/4 = -L_y'.
/// `moves`: of the cell; "xy" leaves the tilt without a load.
inline State dimer_in_a_cell(double g, double f1 = 1, double f2 = 1, const char* moves = R"("x", "y")") {
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [7, 7],
        "cell": {{"axes": ["periodic", "periodic"], "moves": [{}], "tilt": [0], "pin": 0}},
        "load": {{"stress": [{:.17g}, {:.17g}], "reference_length": [1, 1]}},
        "disk_force": [[{:.17g}, {:.17g}], [{:.17g}, {:.17g}]], "disks": [[1, 1, 2.5], [4, 4, 2.5]],
        "bars": [[0, 1, "0x1.0f876ccdf6cd9p+2"]], "contacts": [[0, 1, [-1, 0]], [0, 1, [0, -1]]]}})",
                                 moves, f1, f2, -g, -g, g, g));
}

/// One period moves, along which its bar leans on the next image under forces (2, 15/4): W'' = 69/4 - 3 - 81/64.
inline State dimer_that_leans_along_one_period() {
    State state = dimer_in_a_cell(0, 1, 1, R"("y")");
    state.load.disk_force = {-2, -3.75, 2, 3.75};
    state.packing.length(0) = 7.5;
    state.contacts.erase(std::ranges::find(state.contacts, pair_of(0, 1, {{-1, 0, 0}})));
    return state;
}

/// The same in space, three periods, the bar 6-6-6 and the images at 7-6-6: W'' = 18 (g - 1) - 3888/343 about
/// two axes, L_a' = 78/7 sqrt 3 tau_a for a turn along tau.
inline State spheres_in_a_cell(double g) {
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "dimension": 3, "length": [13, 13, 13],
        "cell": {{"axes": ["periodic", "periodic", "periodic"], "moves": ["x", "y", "z"], "tilt": [0, 0, 0], "pin": 0}},
        "load": {{"stress": [1, 1, 1], "reference_length": [1, 1, 1]}},
        "disk_force": [[{0:.17g}, {0:.17g}, {0:.17g}], [{1:.17g}, {1:.17g}, {1:.17g}]],
        "disks": [[1, 1, 1, 5.5], [7, 7, 7, 5.5]], "bars": [[0, 1, {2:.17g}]],
        "contacts": [[0, 1, [-1, 0, 0]], [0, 1, [0, -1, 0]], [0, 1, [0, 0, -1]]]}})",
                                 -g, g, std::sqrt(108.0)));
}

/// A rectangle of eight arcs between four walls, its flanks turned by +-alpha from the walls, cos = 12/13: with flanks
/// of radius 6 whose centres are 4 from the middle L = 12 - 8 cos(theta -+ alpha). Under equal true stresses the area
/// times their potential has the second derivative 8320/169 per radian squared, 5760/169 twice of it that of the
/// forces.
inline State turned_rectangle(double s1, double s2) {
    const double alpha = std::asin(5.0 / 13);
    const double right = std::asin(1.0);
    const std::array<double, 4> flank{alpha, right - alpha, 2 * right + alpha, 3 * right - alpha}; // outward normals
    const auto radius = [](std::size_t k) { return k % 2 == 0 ? 6.0 : 0.25; };
    std::array<std::array<double, 2>, 8> at{}; // flanks and the caps after them
    for (std::size_t k = 0; k < 4; ++k) {
        const double next = k < 3 ? flank[k + 1] : flank[0] + 4 * right;
        const double half = (next - flank[k]) / 2;
        const double far = std::sqrt(5.75 * 5.75 - 16 * std::sin(half) * std::sin(half)) - 4 * std::cos(half);
        at[2 * k] = {-4 * std::cos(flank[k]), -4 * std::sin(flank[k])};
        at[2 * k + 1] = {far * std::cos(flank[k] + half), far * std::sin(flank[k] + half)};
    }
    std::string disks, bars;
    for (std::size_t i = 0; i < 8; ++i) {
        disks += fmt::format("{}[{:.17g}, {:.17g}, {}]", i == 0 ? "" : ", ", 30.0 / 13 + at[i][0], 30.0 / 13 + at[i][1],
                             radius(i));
        for (std::size_t j = i + 1; j < 8; ++j) {
            if (j == i + 1 || (j == i + 2 && j < 7) || (i == 0 && j == 7)) { // the ring, and neighbours but one
                const double length = j == i + 2 ? std::hypot(at[i][0] - at[j][0], at[i][1] - at[j][1]) : 5.75;
                bars += fmt::format("{}[{}, {}, {:.17g}]", bars.empty() ? "" : ", ", i, j, length);
            }
        }
    }
    return clumps_of(fmt::format(R"({{"format": "isostat-state", "version": 2, "length": [{0:.17g}, {0:.17g}],
        "load": {{"kind": "true", "stress": [{1:.17g}, {2:.17g}]}}, "disks": [{3}], "bars": [{4}],
        "arcs": [[0, 1, 2, 3, 4, 5, 6, 7]],
        "contacts": [[0, "right"], [2, "top"], [4, "left"], [6, "bottom"]]}})",
                                 60.0 / 13, s1, s2, disks, bars));
}

} // namespace isostat::test
