#include "io/text.hpp"
#include "packing/cell_wrap.hpp"

#include <isostat/io/foreign.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace isostat {

namespace {

/// xlo, xhi, ylo, yhi: the walls, or a period from 0; where there is neither, the last disk.
std::array<double, 4> bounds_of(const Packing& packing) {
    std::array<double, 4> box{};
    for (std::size_t a = 0; a < 2; ++a) {
        double low = 0, high = 0;
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            const double x = packing.q[2 * i + a], r = packing.radius[i];
            low = i == 0 ? x - r : std::min(low, x - r);
            high = i == 0 ? x + r : std::max(high, x + r);
        }
        const bool repeats = packing.cell.periodic[a];
        box[2 * a] = packing.walls.lower[a] == WallKind::absent && !repeats ? low : 0;
        box[2 * a + 1] = packing.walls.upper[a] == WallKind::absent && !repeats ? high : packing.lattice(a, a);
    }
    return box;
}

/// A_xy; 0 in a box.
double tilt_of(const Packing& packing) {
    return packing.cell.all() ? packing.lattice(0, 1) : 0;
}

} // namespace

std::string lammps_data_text(const Packing& stored, const std::string& title) {
    Packing packing = stored;
    const Wrapped wrapped = packing.cell.any() ? wrap_into_cell(packing) : Wrapped{};
    const auto [xlo, xhi, ylo, yhi] = bounds_of(packing);
    const double r = packing.max_radius();
    std::string text = fmt::format("{}\n\n{} atoms\n1 atom types\n\n{} {} xlo xhi\n{} {} ylo yhi\n{} {} zlo zhi\n",
                                   text::shown(title), packing.disk_count(), xlo, xhi, ylo, yhi, -r, r);
    if (tilt_of(packing) != 0 || packing.cell.tilt_moves[0]) { // triclinic for LAMMPS, even at tilt 0
        text += fmt::format("{} 0 0 xy xz yz\n", tilt_of(packing));
    }
    text += "\nAtoms # sphere\n\n";
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        text += fmt::format("{} 1 {} 1 {} {} 0", i + 1, 2 * packing.radius[i], packing.q[2 * i], packing.q[2 * i + 1]);
        if (packing.cell.any()) {
            text += fmt::format(" {:.0f} {:.0f} 0", wrapped.periods[i][0], wrapped.periods[i][1]);
        }
        text += '\n';
    }
    return text;
}

std::string xyz_text(const Packing& packing, const std::vector<double>& displacement) {
    const auto [xlo, xhi, ylo, yhi] = bounds_of(packing);
    const double r = packing.max_radius();
    std::string text = fmt::format("{}\nLattice=\"{} 0 0 {} {} 0 0 0 {}\" Origin=\"{} {} {}\" pbc=\"{} {} F\" "
                                   "Properties=id:I:1:species:S:1:pos:R:3:radius:R:1{}\n",
                                   packing.disk_count(), xhi - xlo, tilt_of(packing), yhi - ylo, 2 * r, xlo, ylo, -r,
                                   packing.cell.periodic[0] ? "T" : "F", packing.cell.periodic[1] ? "T" : "F",
                                   displacement.empty() ? "" : ":displacement:R:3");
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        text += fmt::format("{} D {} {} 0 {}", i, packing.q[2 * i], packing.q[2 * i + 1], packing.radius[i]);
        if (!displacement.empty()) {
            text += fmt::format(" {} {} 0", displacement[2 * i], displacement[2 * i + 1]);
        }
        text += '\n';
    }
    return text;
}

std::string csv_text(const Packing& packing) {
    const auto [xlo, xhi, ylo, yhi] = bounds_of(packing);
    std::string text = fmt::format("# box {}:{},{}:{}", xlo, xhi, ylo, yhi);
    if (packing.cell.any()) {
        text += fmt::format(", tilt {}, periodic along {}{}", tilt_of(packing), packing.cell.periodic[0] ? "x" : "",
                            packing.cell.periodic[1] ? "y" : "");
    }
    text += "\nid,x,y,r\n";
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        text += fmt::format("{},{},{},{}\n", i, packing.q[2 * i], packing.q[2 * i + 1], packing.radius[i]);
    }
    return text;
}

} // namespace isostat
