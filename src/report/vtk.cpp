#include "certificate/averages.hpp"
#include "contact/separation.hpp"
#include "io/text.hpp"
#include "report/picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace isostat {

namespace {

using Place = PerAxis<double>; // with z = 0 in the plane

/// Lines of a VTK file, with the points that they add and a force per line.
struct VtkLines {
    std::string lines;
    std::string forces;
    std::vector<double> tube; ///< per point, for spheres: radius of the tube that shows the force
    std::size_t count = 0;
    std::size_t ends = 0;

    void add(const std::vector<std::size_t>& through, double force) {
        lines += fmt::format("{}", through.size());
        for (const std::size_t point : through) {
            lines += fmt::format(" {}", point);
        }
        lines += "\n";
        forces += fmt::format("{:.17g}\n", force);
        ++count;
        ends += through.size();
    }
};

/// Adds the outline of a cell: a parallelogram, or the edges of a parallelepiped as two of these and four lines.
void add_outline(const Packing& packing, std::vector<Place>& points, VtkLines& made) {
    const std::size_t first = points.size();
    for (unsigned z = 0; z < (packing.dimension == plane ? 1U : 2U); ++z) {
        for (const unsigned bits : {0U, 1U, 3U, 2U}) {
            points.push_back(corner(packing, bits + 4 * z));
        }
        const std::size_t here = first + 4 * z;
        made.add({here, here + 1, here + 2, here + 3, here}, 0);
    }
    for (std::size_t k = first; packing.dimension != plane && k < first + 4; ++k) {
        made.add({k, k + 4}, 0);
    }
}

/// Points of the line of a contact. In space both are new, because the points of a line hold the radius of its tube.
std::vector<std::size_t> ends_of(const Packing& packing, const Contact& contact, std::vector<Place>& points) {
    const bool new_begin = packing.dimension != plane;
    const bool new_end = new_begin || !contact.of_disks() || !contact.image.is_here();
    std::vector<std::size_t> ends{static_cast<std::size_t>(contact.i), static_cast<std::size_t>(contact.j)};
    if (new_begin) {
        ends[0] = points.size();
        points.push_back(centre_of(packing, contact.i));
    }
    if (new_end) {
        ends[1] = points.size();
        points.push_back(end_of(packing, contact));
    }
    return ends;
}

/// The tube of a unit force: a quarter of the mean radius at the mean force, as in the picture.
double tube_of_one(const State& state, std::span<const double> forces) {
    double sum = 0, radii = 0;
    for (const double f : forces) {
        sum += std::abs(f);
    }
    for (const double r : state.packing.radius) {
        radii += r;
    }
    const auto bearing = static_cast<double>(forces.size() - static_cast<std::size_t>(std::ranges::count(forces, 0.0)));
    return sum > 0 ? 0.25 * radii / static_cast<double>(state.packing.radius.size()) * bearing / sum : 0;
}

VtkLines vtk_lines(const State& state, std::span<const double> forces, std::vector<Place>& points) {
    VtkLines made;
    made.tube.assign(points.size(), 0);
    const double tube = tube_of_one(state, forces);
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& contact = state.contacts[l];
        if (contact.kind == ContactKind::held) {
            continue;
        }
        const double force = forces.empty() ? 0 : forces[l];
        made.add(ends_of(state.packing, contact, points), force);
        made.tube.resize(points.size(), tube * std::abs(force)); // for the new points
    }
    if (state.packing.cell.any()) {
        add_outline(state.packing, points, made);
        made.tube.resize(points.size(), 0);
    }
    return made;
}

std::string rows_of(const std::vector<Place>& places) {
    std::string text;
    for (const Place& p : places) {
        text += fmt::format("{:.17g} {:.17g} {:.17g}\n", p[0], p[1], p[2]);
    }
    return text;
}

} // namespace

std::string vtk_text(const State& state, std::span<const double> forces, const std::string& title,
                     std::span<const double> displacement) {
    const std::size_t grains = state.packing.radius.size();
    std::vector<Place> points;
    for (std::size_t i = 0; i < grains; ++i) {
        points.push_back(centre_of(state.packing, static_cast<int>(i)));
    }
    const VtkLines contacts = vtk_lines(state, forces, points);
    std::vector<unsigned char> rattler = rattler_flags(state, forces);
    rattler.resize(points.size(), 0);
    // VTK allows titles of one line of at most 256 characters.
    std::string text = fmt::format("{}{}\nASCII\nDATASET POLYDATA\nPOINTS {} double\n", vtk_mark,
                                   text::shown(title).substr(0, 200), points.size());
    text += rows_of(points) + fmt::format("VERTICES {} {}\n", grains, 2 * grains);
    for (std::size_t i = 0; i < grains; ++i) {
        text += fmt::format("1 {}\n", i);
    }
    text += fmt::format("LINES {} {}\n{}", contacts.count, contacts.count + contacts.ends, contacts.lines);
    text += fmt::format("POINT_DATA {}\nSCALARS radius double 1\nLOOKUP_TABLE default\n", points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        text += fmt::format("{:.17g}\n", i < grains ? state.packing.radius[i] : 0.0);
    }
    std::vector<int> count = contacts_of_grains(state);
    count.resize(points.size(), 0);
    text += fmt::format("SCALARS contacts int 1\nLOOKUP_TABLE default\n{}\n", fmt::join(count, "\n"));
    text += fmt::format("SCALARS rattler int 1\nLOOKUP_TABLE default\n{}\n", fmt::join(rattler, "\n"));
    if (state.packing.dimension != plane) {
        text += "SCALARS tube double 1\nLOOKUP_TABLE default\n";
        for (const double r : contacts.tube) {
            text += fmt::format("{:.6g}\n", r);
        }
    }
    if (!displacement.empty()) {
        std::vector<Place> moved(points.size(), Place{});
        for (std::size_t k = 0; k < state.packing.length_at(0); ++k) {
            moved[k / state.packing.axes()][k % state.packing.axes()] = displacement[k];
        }
        text += "VECTORS displacement double\n" + rows_of(moved);
    }
    // Cell data are in VTK's order of cells: vertices first, then lines.
    text += fmt::format("CELL_DATA {}\nSCALARS force double 1\nLOOKUP_TABLE default\n", grains + contacts.count);
    for (std::size_t i = 0; i < grains; ++i) {
        text += "0\n";
    }
    return text + contacts.forces;
}

} // namespace isostat
