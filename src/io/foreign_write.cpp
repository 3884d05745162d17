#include <isostat/io/foreign.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace isostat {

namespace {

/// xlo, xhi, ylo, yhi: the walls; where there is none, the last disk.
std::array<double, 4> bounds_of(const Packing<2>& packing) {
    std::array<double, 4> box{};
    for (std::size_t a = 0; a < 2; ++a) {
        double low = 0, high = 0;
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            const double x = packing.q[2 * i + a], r = packing.radius[i];
            low = i == 0 ? x - r : std::min(low, x - r);
            high = i == 0 ? x + r : std::max(high, x + r);
        }
        box[2 * a] = packing.walls.lower[a] == WallKind::absent ? low : 0;
        box[2 * a + 1] = packing.walls.upper[a] == WallKind::absent ? high : packing.length(static_cast<int>(a));
    }
    return box;
}

} // namespace

std::string lammps_data_text(const Packing<2>& packing, const std::string& title) {
    const auto [xlo, xhi, ylo, yhi] = bounds_of(packing);
    const double r = packing.max_radius();
    std::string text = fmt::format("{}\n\n{} atoms\n1 atom types\n\n{} {} xlo xhi\n{} {} ylo yhi\n{} {} zlo zhi\n\n"
                                   "Atoms # sphere\n\n",
                                   title.substr(0, title.find('\n')), packing.disk_count(), xlo, xhi, ylo, yhi, -r, r);
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        text +=
            fmt::format("{} 1 {} 1 {} {} 0\n", i + 1, 2 * packing.radius[i], packing.q[2 * i], packing.q[2 * i + 1]);
    }
    return text;
}

std::string xyz_text(const Packing<2>& packing, const std::vector<double>& displacement) {
    const auto [xlo, xhi, ylo, yhi] = bounds_of(packing);
    const double r = packing.max_radius();
    std::string text = fmt::format("{}\nLattice=\"{} 0 0 0 {} 0 0 0 {}\" Origin=\"{} {} {}\" pbc=\"F F F\" "
                                   "Properties=id:I:1:species:S:1:pos:R:3:radius:R:1{}\n",
                                   packing.disk_count(), xhi - xlo, yhi - ylo, 2 * r, xlo, ylo, -r,
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

std::string csv_text(const Packing<2>& packing) {
    const auto [xlo, xhi, ylo, yhi] = bounds_of(packing);
    std::string text = fmt::format("# box {}:{},{}:{}\nid,x,y,r\n", xlo, xhi, ylo, yhi);
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        text += fmt::format("{},{},{},{}\n", i, packing.q[2 * i], packing.q[2 * i + 1], packing.radius[i]);
    }
    return text;
}

} // namespace isostat
