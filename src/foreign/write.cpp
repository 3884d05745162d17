#include "io/text.hpp"
#include "packing/cell_wrap.hpp"
#include "packing/words.hpp"

#include <isostat/foreign/foreign.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace isostat {

namespace {

/// The box along three axes: from wall to wall, or one period from 0; without both, to the outermost grains. Disks are
/// in the middle of a layer as thick as the largest disk.
struct Box {
    PerAxis<double> low{}, high{};
    PerTilt<double> tilt{};
    explicit Box(const Packing& packing) {
        const std::size_t d = packing.axes();
        low.fill(-packing.max_radius());
        high.fill(packing.max_radius());
        for (std::size_t a = 0; a < d; ++a) {
            for (std::size_t i = 0; i < packing.radius.size(); ++i) {
                const double x = packing.q[d * i + a], r = packing.radius[i];
                low[a] = i == 0 ? x - r : std::min(low[a], x - r);
                high[a] = i == 0 ? x + r : std::max(high[a], x + r);
            }
            const bool repeats = packing.cell.periodic[a];
            low[a] = packing.walls.lower[a] == WallKind::absent && !repeats ? low[a] : 0;
            high[a] = packing.walls.upper[a] == WallKind::absent && !repeats ? high[a] : packing.lattice(a, a);
        }
        for (std::size_t t = 0; packing.cell.any() && t < packing.tilts(); ++t) {
            tilt[t] = packing.q[packing.length_at(d + t)];
        }
    }
    [[nodiscard]] double length(std::size_t axis) const { return high[axis] - low[axis]; }
};

/// The three numbers of grain i, with 0 for the z of a disk.
std::string three(const Packing& packing, const std::vector<double>& of_grains, std::size_t i) {
    const std::size_t d = packing.axes();
    PerAxis<double> out{};
    std::copy_n(&of_grains[d * i], d, out.begin());
    return fmt::format("{} {} {}", out[0], out[1], out[2]);
}

} // namespace

std::string lammps_data_text(const Packing& stored, const std::string& title) {
    Packing packing = stored;
    const Wrapped wrapped = packing.cell.any() ? wrap_into_cell(packing) : Wrapped{};
    const Box box(packing);
    std::string text = fmt::format("{}\n\n{} atoms\n1 atom types\n\n", text::shown(title), packing.disk_count());
    for (std::size_t a = 0; a < most_axes; ++a) {
        text += fmt::format("{0} {1} {2}lo {2}hi\n", box.low[a], box.high[a], axis_names[a]);
    }
    const auto& moves = packing.cell.tilt_moves;
    if (box.tilt != PerTilt<double>{} || std::ranges::find(moves, true) != moves.end()) {
        // The box is triclinic for LAMMPS, even at tilt 0.
        text += fmt::format("{} {} {} xy xz yz\n", box.tilt[0], box.tilt[1], box.tilt[2]);
    }
    text += "\nAtoms # sphere\n\n";
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        text += fmt::format("{} 1 {} 1 {}", i + 1, 2 * packing.radius[i], three(packing, packing.q, i));
        if (packing.cell.any()) {
            const auto& [x, y, z] = wrapped.periods[i];
            text += fmt::format(" {:.0f} {:.0f} {:.0f}", x, y, z);
        }
        text += '\n';
    }
    return text;
}

std::string xyz_text(const Packing& packing, const std::vector<double>& displacement, std::span<const int> contacts) {
    const Box box(packing);
    const auto repeats = [&](std::size_t axis) { return packing.cell.periodic[axis] ? "T" : "F"; };
    std::string text =
        fmt::format("{}\nLattice=\"{} 0 0 {} {} 0 {} {} {}\" Origin=\"{} {} {}\" pbc=\"{} {} {}\" "
                    "Properties=id:I:1:species:S:1:pos:R:3:radius:R:1{}{}\n",
                    packing.disk_count(), box.length(0), box.tilt[0], box.length(1), box.tilt[1], box.tilt[2],
                    box.length(2), box.low[0], box.low[1], box.low[2], repeats(0), repeats(1), repeats(2),
                    displacement.empty() ? "" : ":displacement:R:3", contacts.empty() ? "" : ":contacts:I:1");
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        text += fmt::format("{} D {} {}{}{}\n", i, three(packing, packing.q, i), packing.radius[i],
                            displacement.empty() ? "" : " " + three(packing, displacement, i),
                            contacts.empty() ? "" : fmt::format(" {}", contacts[i]));
    }
    return text;
}

std::string csv_text(const Packing& packing, std::span<const int> contacts) {
    const Box box(packing);
    const std::size_t d = packing.axes();
    std::vector<std::string> sides, tilts;
    std::string names, periodic;
    for (std::size_t a = 0; a < d; ++a) {
        sides.push_back(fmt::format("{}:{}", box.low[a], box.high[a]));
        names += fmt::format(",{}", axis_names[a]);
        periodic += packing.cell.periodic[a] ? axis_names[a] : "";
    }
    for (std::size_t t = 0; t < packing.tilts(); ++t) {
        tilts.push_back(fmt::format("{}", box.tilt[t]));
    }
    std::string text = fmt::format("# box {}", fmt::join(sides, ","));
    if (packing.cell.any()) {
        text += fmt::format(", tilt {}, periodic along {}", fmt::join(tilts, " "), periodic);
    }
    text += fmt::format("\nid{},r{}\n", names, contacts.empty() ? "" : ",contacts");
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        text += fmt::format("{},{},{}{}\n", i, fmt::join(&packing.q[d * i], &packing.q[d * i] + d, ","),
                            packing.radius[i], contacts.empty() ? "" : fmt::format(",{}", contacts[i]));
    }
    return text;
}

} // namespace isostat
