// Walls and cells in packings of other programs.
#include "foreign/source.hpp"
#include "packing/cell_wrap.hpp"
#include "packing/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace isostat::foreign {

namespace {

/// A stated box must have as many sides as there are axes. For a file without a box it is the cell when the axes are
/// periodic, as stated; otherwise it gives the places of the walls.
void take_box(Raw& raw, std::size_t axes, const std::string& source, ForeignOptions& options) {
    if (options.box.empty()) {
        return;
    }
    if (options.box.size() != 2 * axes) {
        refuse(source, "a box of {} bounds was stated: expected {}, low and high of each axis of {}",
               options.box.size(), 2 * axes,
               axes == 2 ? "disks (z is the same for all; --dimension 3 takes spheres in a plane)" : "spheres");
    }
    if (!raw.box && options.periodic) {
        raw.box.emplace();
        for (std::size_t k = 0; k < options.box.size(); ++k) {
            (*raw.box)[k / 2][k % 2] = options.box[k];
        }
        options.box.clear();
    }
}

/// Takes the stated cell of a file without one: lengths and tilts, or period vectors.
void take_lattice(Raw& raw, std::size_t axes, const std::string& source, const ForeignOptions& options) {
    const std::vector<double>& stated = options.lattice;
    if (stated.empty()) {
        return;
    }
    if (raw.box) {
        refuse(source, "a lattice was stated and the file has one: expected one of them");
    }
    const std::size_t tilts = axes == 2 ? 1 : most_tilts;
    PerAxis<PerAxis<double>> vectors{{{}, {}, {0, 0, 1}}};
    if (stated.size() == axes || stated.size() == axes + tilts) {
        for (std::size_t b = 0; b < axes; ++b) {
            vectors[b][b] = stated[b];
            for (std::size_t a = 0; a < b && stated.size() > axes; ++a) {
                vectors[b][a] = stated[axes + Cell::tilt(a, b)];
            }
        }
    } else if (stated.size() == axes * axes) {
        for (std::size_t k = 0; k < stated.size(); ++k) {
            vectors[k / axes][k % axes] = stated[k];
        }
    } else {
        refuse(source,
               "a lattice of {} numbers was stated: expected {} lengths, {} more for tilts, or {} entries of period "
               "vectors",
               stated.size(), axes, tilts, axes * axes);
    }
    raw.take_vectors(vectors, {});
    raw.boundary.fill(Boundary::periodic);
    if (are_upper(vectors, axes)) {
        raw.vectors.reset();
    }
}

void check_boundaries(Raw& raw, std::size_t axes, const std::string& source, const ForeignOptions& options) {
    for (std::size_t a = 0; a < axes; ++a) {
        const char* axis = axis_names[a];
        if (options.not_periodic) {
            raw.boundary[a] = Boundary::open;
            continue;
        }
        if (options.periodic && raw.boundary[a] == Boundary::unknown) {
            raw.boundary[a] = Boundary::periodic;
            raw.notes.push_back(fmt::format("{} is periodic, as stated", axis));
        }
        if (raw.boundary[a] == Boundary::periodic && !options.cells) {
            refuse(source,
                   "boundaries along {} are periodic: expected open ones or walls; contacts across them are not "
                   "supported (--not-periodic looks at the disks as they lie)",
                   axis);
        }
        if (raw.boundary[a] == Boundary::unknown && raw.box) {
            raw.notes.push_back(fmt::format(
                "the file does not say whether {} is periodic: no contact is looked for across the boundary", axis));
        }
    }
    const char* stated = options.cells ? " (--periodic says so where the file does not)" : "";
    const auto open = [](Boundary boundary) { return boundary != Boundary::periodic; };
    if (raw.vectors &&
        std::any_of(raw.boundary.begin(), raw.boundary.begin() + static_cast<std::ptrdiff_t>(axes), open)) {
        refuse(source,
               "the first period vector (Lattice) is not along x, or the second one not in the plane of x and y: "
               "expected that, or all axes periodic{}",
               stated);
    }
    for (std::size_t b = 1; b < axes; ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            const double tilt = raw.tilt[Cell::tilt(a, b)];
            if (tilt != 0 && !(raw.boundary[a] == Boundary::periodic && raw.boundary[b] == Boundary::periodic)) {
                refuse(source,
                       "the box (Lattice, or {}) is tilted by {}: expected one along the axes, or both axes periodic{}",
                       tilt_names[Cell::tilt(a, b)], tilt, stated);
            }
        }
    }
}

/// x - origin; raises `worst` to the rounding of this difference, which is exact (Knuth).
double shifted(double x, double origin, double& worst) {
    const double d = x - origin;
    const double moved = x - d;
    worst = std::max(worst, std::abs((x - (d + moved)) + (moved - origin)));
    return d;
}

/// The low and high side of an axis, as stated or in the file.
std::array<double, 2> sides_of(const Raw& raw, const ForeignOptions& options, std::size_t a) {
    return options.box.empty() ? raw.box.value()[a] : std::array{options.box[2 * a], options.box[2 * a + 1]};
}

/// Adds the walls of one axis, if these were requested.
void add_wall_pair(ForeignPacking& out, std::size_t a, const Raw& raw, const std::string& source,
                   const ForeignOptions& options, double& worst) {
    Packing& packing = out.packing;
    if (options.walls == ForeignWalls::none) {
        packing.q.push_back(0);
        return;
    }
    const auto [low, high] = sides_of(raw, options, a);
    if (options.box.empty() && raw.loose[a]) {
        refuse(source, "bounds along {} are shrink-wrapped: expected fixed ones for walls, or --box", axis_names[a]);
    }
    if (!(low < high)) {
        refuse(source, "box from {} to {}: expected a lower and a higher bound", low, high);
    }
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        double& x = packing.q[packing.axes() * i + a];
        if (!(low < x && x < high)) {
            refuse(source, "{} of disk {} is {}: expected a centre between the walls at {} and {}{}{}", axis_names[a],
                   i, x, low, high, raw.types.empty() ? "" : "; ", raw.types);
        }
        x = shifted(x, low, worst);
    }
    packing.q.push_back(shifted(high, low, worst));
    packing.walls.lower[a] = WallKind::fixed;
    const bool moves =
        options.walls == ForeignWalls::box || (options.walls == ForeignWalls::square && a + 1 == packing.axes());
    packing.walls.upper[a] = moves ? WallKind::movable : WallKind::fixed;
}

/// Turns the packing until the period vectors have the form of a cell: each entry below the diagonal becomes 0 by a
/// rotation, which changes a distance by at most about 2^-50 of it. Returns the rounding of a coordinate.
double turn(Packing& packing, PerAxis<PerAxis<double>> vectors, std::vector<std::string>& notes) {
    const std::size_t d = packing.axes(), n = packing.radius.size();
    double largest = 0;
    const auto each = [&](const auto& change) {
        for (std::size_t i = 0; i < n; ++i) {
            change(&packing.q[d * i]);
        }
        for (std::size_t a = 0; a < d; ++a) {
            change(vectors[a].data());
        }
    };
    each([&](const double* x) { largest = std::max(largest, std::sqrt(std::inner_product(x, x + d, x, 0.0))); });
    for (std::size_t a = 0; a < d; ++a) {
        for (std::size_t b = a + 1; b < d; ++b) {
            const double along = vectors[a][a], off = vectors[a][b], length = std::hypot(along, off);
            if (off != 0) {
                each([&](double* x) {
                    const double x_a = x[a];
                    x[a] = (along * x_a + off * x[b]) / length;
                    x[b] = (along * x[b] - off * x_a) / length;
                });
                vectors[a][b] = 0;
            }
        }
        if (vectors[a][a] < 0) {
            each([&](double* x) { x[a] = -x[a]; });
            notes.emplace_back("the packing is the mirror image of that of the file");
        }
    }
    for (std::size_t a = 0; a < d; ++a) {
        packing.length(static_cast<int>(a)) = vectors[a][a];
        for (std::size_t b = a + 1; b < d; ++b) {
            packing.q[packing.tilt_at(a, b)] = vectors[b][a];
        }
    }
    notes.emplace_back("the cell is turned, its first vector along x and the second one in the plane of x and y");
    return 0x1p-48 * largest; // up to three rotations and a mirror, which each round by less than 2^-50
}

void note_cell(ForeignPacking& out, const ForeignOptions& options) {
    const Packing& packing = out.packing;
    std::vector<std::string> periodic, other, lengths, tilts;
    for (std::size_t b = 0; b < packing.axes(); ++b) {
        (packing.cell.periodic[b] ? periodic : other).emplace_back(axis_names[b]);
        lengths.push_back(fmt::format("{}", packing.lattice(b, b)));
        for (std::size_t a = 0; a < b; ++a) {
            tilts.push_back(fmt::format("{}", packing.lattice(a, b)));
        }
    }
    const std::string along = options.walls == ForeignWalls::none ? ", open along " : ", walls along ";
    out.notes.push_back(fmt::format("periodic along {}{}{}: lengths {}, tilt{} {}", fmt::join(periodic, " and "),
                                    other.empty() ? "" : along, fmt::join(other, " and "), fmt::join(lengths, " and "),
                                    tilts.size() == 1 ? "" : "s xy, xz, yz", fmt::join(tilts, ", ")));
}

/// Takes the cell of the file for the periodic axes, which does not move, with its lower corner at 0 and the disks
/// inside. Returns the rounding of a coordinate.
double add_cell(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options) {
    Packing& packing = out.packing;
    const std::size_t d = packing.axes();
    if (!raw.box) {
        refuse(source, "periodic, and the file has no bounds of a box: expected some");
    }
    for (std::size_t a = 0; a < d; ++a) {
        packing.cell.periodic[a] = raw.boundary[a] == Boundary::periodic;
    }
    if (packing.cell.all() &&
        ((options.walls != ForeignWalls::none && !options.walls_unless_periodic) || !options.box.empty())) {
        refuse(source, "walls or a box were stated of a periodic packing: expected none (--not-periodic looks at the "
                       "disks as they lie)");
    }
    double worst = 0;
    for (std::size_t a = 0; a < d; ++a) {
        if (!packing.cell.periodic[a]) {
            add_wall_pair(out, a, raw, source, options, worst);
            continue;
        }
        const auto [low, high] = (*raw.box)[a];
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            double& x = packing.q[d * i + a];
            x = shifted(x, low, worst);
        }
        packing.q.push_back(shifted(high, low, worst));
    }
    packing.q.insert(packing.q.end(), raw.tilt.begin(),
                     raw.tilt.begin() + static_cast<std::ptrdiff_t>(packing.tilts()));
    if (raw.vectors) {
        worst += turn(packing, *raw.vectors, out.notes);
    }
    for (std::size_t a = 0; a < d; ++a) {
        const double period = packing.lattice(a, a), width = 2 * packing.max_radius();
        if (packing.cell.periodic[a] && !(period > 0)) {
            refuse(source, "period {} along {}: expected a positive one", period, axis_names[a]);
        }
        constexpr double too_wide = 1.5;
        if (packing.cell.periodic[a] && width > too_wide * period) {
            refuse(source,
                   "a {} {} wide in a period of {} along {}: expected at most one period (sizes in another unit, or "
                   "diameters for radii?{})",
                   grain_word(packing.dimension), width, period, axis_names[a],
                   d == 2 ? "" : "; a packing of disks has one z, or --plane says which plane");
        }
    }
    worst = std::max(worst, wrap_into_cell(packing).rounding);
    note_cell(out, options);
    if (worst > 0) {
        out.notes.push_back(fmt::format("coordinates were moved into the cell: rounded by up to {:.2g}", worst));
    }
    return worst;
}

/// Adds the walls; returns how much the shift to them rounds a coordinate.
double add_walls(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options) {
    Packing& packing = out.packing;
    if (options.walls == ForeignWalls::none) {
        packing.q.insert(packing.q.end(), packing.axes(), 0);
        if (!options.box.empty()) {
            refuse(source, "a box was stated without walls: expected walls box or fixed");
        }
        out.notes.emplace_back(raw.box ? "no walls: the bounds of the box in the file are not used"
                                       : "neither walls nor a cell: --lattice, --periodic with --box, or --walls with "
                                         "--box state them");
        return 0;
    }
    if (options.box.empty() && !raw.box) {
        refuse(source, "walls were asked for and the file has no bounds of a box: expected --box xlo:xhi,ylo:yhi{}",
               packing.dimension == 2 ? "" : ",zlo:zhi");
    }
    double worst = 0;
    std::vector<std::string> places;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        add_wall_pair(out, a, raw, source, options, worst);
        const auto [low, high] = sides_of(raw, options, a);
        places.push_back(fmt::format("{} = {}, {}", axis_names[a], low, high));
    }
    out.notes.push_back(fmt::format("walls at {}: {}", fmt::join(places, " and "),
                                    options.walls == ForeignWalls::fixed ? "fixed"
                                    : options.walls == ForeignWalls::square
                                        ? "their size alone moves, as the last upper one"
                                    : packing.dimension == 2 ? "left and bottom fixed, right and top movable"
                                                             : "lower ones fixed, upper ones movable"));
    if (worst > 0) {
        out.notes.push_back(fmt::format("coordinates were shifted to the lower walls: rounded by up to {:.2g}", worst));
    }
    return worst;
}

} // namespace

void settle_bounds(Raw& raw, std::size_t axes, const std::string& source, ForeignOptions& options) {
    take_lattice(raw, axes, source, options);
    take_box(raw, axes, source, options);
    check_boundaries(raw, axes, source, options);
}

double add_box(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options) {
    const auto axes = std::span(raw.boundary).first(out.packing.axes());
    const bool periodic = std::ranges::find(axes, Boundary::periodic) != axes.end();
    return (periodic ? add_cell : add_walls)(out, raw, source, options);
}

} // namespace isostat::foreign
