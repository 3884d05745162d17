#include "io/files.hpp"
#include "io/foreign_source.hpp"
#include "io/numbers.hpp"
#include "packing/cell_wrap.hpp"
#include "packing/words.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/foreign.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isostat {

namespace {

using foreign::Boundary;
using foreign::Raw;

[[noreturn]] void refuse(const std::string& source, const std::string& message) {
    throw Error(ErrorKind::bad_input, source + ": " + message);
}

/// Whether period vectors are written as the cell is. \p d: so many axes of them count.
bool are_upper(const PerAxis<PerAxis<double>>& vectors, std::size_t d) {
    bool upper = true;
    for (std::size_t a = 0; a < d; ++a) {
        upper = upper && vectors[a][a] > 0;
        for (std::size_t b = a + 1; b < d; ++b) {
            upper = upper && vectors[a][b] == 0;
        }
    }
    return upper;
}

/// Disks where z is the same, or differs by so little that no gap of two disks, sqrt(d^2 + z^2), is another double.
int dimension_of(Raw& raw, const std::string& source, const ForeignOptions& options) {
    const std::optional<int> stated = options.dimension ? options.dimension : raw.dimension;
    if (stated.value_or(2) != raw.dimension.value_or(stated.value_or(2))) {
        refuse(source,
               fmt::format("dimension {} was stated and the file has {}: expected that", *stated, *raw.dimension));
    }
    if (stated == 3 && !raw.has_z) {
        refuse(source, "dimension 3 was stated and there is no column z: expected one");
    }
    const auto off = [&](std::size_t i) { return std::abs(raw.centre[i][2] - raw.centre[0][2]); };
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < raw.centre.size(); ++i) {
        farthest = off(i) > off(farthest) ? i : farthest;
    }
    const double radius =
        *std::min_element(raw.size.begin(), raw.size.end()) / (raw.meaning == SizeMeaning::radius ? 1 : 2);
    const bool flat = off(farthest) <= 0x1p-27 * radius;
    const int dimension = stated.value_or(flat ? 2 : 3);
    if (dimension == 2 && !flat) {
        refuse(fmt::format("{}:{}", source, raw.line[farthest]),
               fmt::format("z of disk {} is '{}': expected {}, as of disk 0: disks were stated, in a plane "
                           "(--dimension 3 takes spheres)",
                           farthest, raw.centre[farthest][2], raw.centre[0][2]));
    }
    if (dimension == 2 && off(farthest) > 0) {
        raw.notes.push_back(
            fmt::format("z differs by up to {:.2g}, which changes no gap: taken for a plane", off(farthest)));
    }
    if (dimension == 2 && !raw.not_plane.empty()) {
        throw Error(ErrorKind::bad_input, raw.not_plane);
    }
    if (raw.vectors && are_upper(*raw.vectors, static_cast<std::size_t>(dimension))) {
        raw.vectors.reset();
    }
    return dimension;
}

/// A box that was stated has as many sides as there are axes. Of a file without one it is the cell where the axes are
/// periodic, as stated; else it says where the walls are.
void take_box(Raw& raw, std::size_t axes, const std::string& source, ForeignOptions& options) {
    if (options.box.empty()) {
        return;
    }
    if (options.box.size() != 2 * axes) {
        refuse(source, fmt::format("a box of {} bounds was stated: expected {}, low and high of each axis of {}",
                                   options.box.size(), 2 * axes,
                                   axes == 2 ? "disks (z is the same for all; --dimension 3 takes spheres in a plane)"
                                             : "spheres"));
    }
    if (!raw.box && options.periodic) {
        raw.box.emplace();
        for (std::size_t k = 0; k < options.box.size(); ++k) {
            (*raw.box)[k / 2][k % 2] = options.box[k];
        }
        options.box.clear();
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
            refuse(source, fmt::format("boundaries along {} are periodic: expected open ones or walls; contacts across "
                                       "them are not supported (--not-periodic looks at the disks as they lie)",
                                       axis));
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
        refuse(source, fmt::format("the first period vector (Lattice) is not along x, or the second one not in the "
                                   "plane of x and y: expected that, or all axes periodic{}",
                                   stated));
    }
    for (std::size_t b = 1; b < axes; ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            const double tilt = raw.tilt[Cell::tilt(a, b)];
            if (tilt != 0 && !(raw.boundary[a] == Boundary::periodic && raw.boundary[b] == Boundary::periodic)) {
                refuse(source, fmt::format("the box (Lattice, or {}) is tilted by {}: expected one along the axes, or "
                                           "both axes periodic{}",
                                           tilt_names[Cell::tilt(a, b)], tilt, stated));
            }
        }
    }
}

/// Not `validate`: disks of any size may overlap, and reach beyond the walls.
void check_range(const Packing& packing, const std::string& source) {
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        if (!(packing.radius[i] >= shortest_length && packing.radius[i] <= longest_length)) {
            refuse(source, fmt::format("radius of disk {} is {}: expected one from {} to {}", i, packing.radius[i],
                                       shortest_length, longest_length));
        }
    }
    for (const double x : packing.q) {
        if (!(std::abs(x) <= longest_length)) {
            refuse(source, fmt::format("a coordinate is {}: expected a size of at most {}", x, longest_length));
        }
    }
}

/// x - origin; the rounding of the difference (Knuth's, exact) goes to `worst` if it is larger.
double shifted(double x, double origin, double& worst) {
    const double d = x - origin;
    const double moved = x - d;
    worst = std::max(worst, std::abs((x - (d + moved)) + (moved - origin)));
    return d;
}

/// Low and high of an axis, as stated or in the file.
std::array<double, 2> sides_of(const Raw& raw, const ForeignOptions& options, std::size_t a) {
    return options.box.empty() ? raw.box.value()[a] : std::array{options.box[2 * a], options.box[2 * a + 1]};
}

/// The walls of one axis, where they were asked for.
void add_wall_pair(ForeignPacking& out, std::size_t a, const Raw& raw, const std::string& source,
                   const ForeignOptions& options, double& worst) {
    Packing& packing = out.packing;
    if (options.walls == ForeignWalls::none) {
        packing.q.push_back(0);
        return;
    }
    const auto [low, high] = sides_of(raw, options, a);
    if (options.box.empty() && raw.loose[a]) {
        refuse(source, fmt::format("bounds along {} are shrink-wrapped: expected fixed ones for walls, or --box",
                                   axis_names[a]));
    }
    if (!(low < high)) {
        refuse(source, fmt::format("box from {} to {}: expected a lower and a higher bound", low, high));
    }
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        double& x = packing.q[packing.axes() * i + a];
        if (!(low < x && x < high)) {
            refuse(source, fmt::format("{} of disk {} is {}: expected a centre between the walls at {} and {}{}{}",
                                       axis_names[a], i, x, low, high, raw.types.empty() ? "" : "; ", raw.types));
        }
        x = shifted(x, low, worst);
    }
    packing.q.push_back(shifted(high, low, worst));
    packing.walls.lower[a] = WallKind::fixed;
    packing.walls.upper[a] = options.walls == ForeignWalls::box ? WallKind::movable : WallKind::fixed;
}

/// Turns the packing until the period vectors are written as those of a cell: each entry below the diagonal by a
/// rotation, which moves no distance by more than some 2^-50 of it. By how much that rounds a coordinate.
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
    return 0x1p-48 * largest; // up to three rotations and a mirror, each rounds by less than 2^-50
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

/// Periodic axes: the cell of the file, which does not move, with its lower corner at 0 and the disks in it. By how
/// much that rounds a coordinate.
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
        if (packing.cell.periodic[a] && !(packing.lattice(a, a) > 0)) {
            refuse(source,
                   fmt::format("period {} along {}: expected a positive one", packing.lattice(a, a), axis_names[a]));
        }
    }
    worst = std::max(worst, wrap_into_cell(packing).rounding);
    note_cell(out, options);
    if (worst > 0) {
        out.notes.push_back(fmt::format("coordinates were moved into the cell: rounded by up to {:.2g}", worst));
    }
    return worst;
}

/// By how much the shift to them rounds a coordinate.
double add_walls(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options) {
    Packing& packing = out.packing;
    if (options.walls == ForeignWalls::none) {
        packing.q.insert(packing.q.end(), packing.axes(), 0);
        if (!options.box.empty()) {
            refuse(source, "a box was stated without walls: expected walls box or fixed");
        }
        if (raw.box) {
            out.notes.emplace_back("no walls: the bounds of the box in the file are not used");
        }
        return 0;
    }
    if (options.box.empty() && !raw.box) {
        refuse(source, fmt::format("walls were asked for and the file has no bounds of a box: expected --box "
                                   "xlo:xhi,ylo:yhi{}",
                                   packing.dimension == 2 ? "" : ",zlo:zhi"));
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
                                    : packing.dimension == 2 ? "left and bottom fixed, right and top movable"
                                                             : "lower ones fixed, upper ones movable"));
    if (worst > 0) {
        out.notes.push_back(fmt::format("coordinates were shifted to the lower walls: rounded by up to {:.2g}", worst));
    }
    return worst;
}

/// Three rows with one number each: in XYZ the third one has a place at least.
bool begins_with_centres(const std::vector<TextLine>& start) {
    return start.size() >= 3 && std::all_of(start.begin(), start.begin() + 3, [](const TextLine& line) {
               return line.size() == 1 && finite_number(line.field(0));
           });
}

/// What multiplying out scaled coordinates rounds, and (`factor`) what it makes of their digits.
struct Scaling {
    double factor = 1, rounding = 0;
};
Scaling scaling_of(const Raw& raw, std::size_t axes) {
    if (!raw.scaled) {
        return {};
    }
    Scaling out{0, 0};
    double bound = 0;
    for (std::size_t a = 0; a < axes; ++a) {
        const auto& [low, high] = (*raw.box)[a];
        double reach = high - low;
        for (std::size_t b = a + 1; b < axes; ++b) {
            reach += std::abs(raw.tilt[Cell::tilt(a, b)]);
        }
        out.factor = std::max(out.factor, reach);
        bound = std::max({bound, std::abs(low), std::abs(high)});
    }
    out.rounding = 0x1p-52 * static_cast<double>(axes) * (out.factor + bound); // two operations for each axis
    return out;
}

/// \p moved: the rounding of a coordinate that came with the walls or the cell.
double rounding_of(const Raw& raw, const ForeignPacking& found, const ForeignOptions& options, double moved) {
    const Packing& packing = found.packing;
    const bool walls = !(packing.walls == Walls::none());
    const bool in_file = packing.cell.any() || (walls && options.box.empty());
    Digits places, sides;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        places.see(raw.places[a]);
        sides.see(in_file ? raw.sides[a] : Digits());
    }
    const int digits = std::max({places.most(), raw.sizes.most(), sides.most()});
    double size = raw.sizes.rounding(digits);
    size = std::max(raw.meaning == SizeMeaning::radius ? size : size / 2, 0x1p-53 * packing.max_radius());
    double side = in_file ? sides.rounding(digits) + moved : 0;
    for (const double stated : options.box) {
        side = std::max(side, 0x1p-53 * std::abs(stated) + moved);
    }
    const bool tilted =
        raw.vectors || std::any_of(raw.tilt.begin(), raw.tilt.end(), [](double tilt) { return tilt != 0; });
    const Scaling scaling = scaling_of(raw, packing.axes());
    // Coordinates of a packing have as many digits as they were given: fewer than radii have were cut off.
    return rounding_of_gaps(places.rounding() * scaling.factor + scaling.rounding + moved, side, size,
                            {packing.dimension, packing.cell.any() && tilted});
}

} // namespace

const std::vector<std::string>& foreign_formats() {
    static const std::vector<std::string> formats{"lammps-data", "lammps-dump", "xyz", "table", "centres"};
    return formats;
}

std::string recognise_format(const std::string& marked) {
    const std::string_view text = without_byte_order_mark(marked);
    const std::string source;
    TextLines lines(text, source);
    const auto blank = [](std::string_view line) { return line.find_first_not_of(" \t\r") == std::string_view::npos; };
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) {
        return "";
    }
    if (text[first] == '{') {
        return "state";
    }
    if (text.compare(first, 5, "ITEM:") == 0) {
        return "lammps-dump";
    }
    // Vertex texts and XYZ start with a number of rows; the next row tells them apart.
    TextLines rows = lines;
    std::vector<TextLine> start;
    while (!rows.at_end() && start.size() < 3) {
        const std::string_view line = rows.take("");
        if (start.empty() && (blank(line) || line[line.find_first_not_of(" \t\r")] == '#')) {
            continue;
        }
        start.emplace_back(line, rows.number(), &source);
    }
    const auto is_count = [](const TextLine& line) {
        return line.size() >= 1 && line.field(0).find_first_not_of("0123456789") == std::string_view::npos;
    };
    if (!start.empty() && is_count(start[0]) && start[0].size() > 1 && start[0].field(1) == "x") {
        return "vertex";
    }
    if (begins_with_centres(start)) {
        return "centres";
    }
    if (start.size() >= 2 && is_count(start[0]) && start[0].size() == 1) {
        const bool numbers = start[1].size() == 5 && finite_number(start[1].field(0)).has_value();
        return numbers || (!start[1].text().empty() && start[1].text().starts_with('#')) ? "vertex" : "xyz";
    }
    constexpr int header_lines = 60;
    for (int k = 0; k < header_lines && !lines.at_end(); ++k) {
        const TextLine line = lines.next("");
        if (line.size() >= 2 && finite_number(line.field(0)) && line.field(1) == "atoms") {
            return "lammps-data";
        }
        const std::string_view word = line.size() > 0 ? line.field(0) : std::string_view();
        if ((word == "format" || word.starts_with("format=")) &&
            line.text().find("isostat-packing") != std::string_view::npos) {
            return "packing";
        }
    }
    return "table";
}

ForeignPacking parse_foreign(const std::string& text, const std::string& source, const ForeignOptions& options) {
    ForeignPacking out;
    out.format = options.format.empty() ? recognise_format(text) : options.format;
    if (options.size && options.size->column.empty() &&
        !(options.size->value > 0 && std::isfinite(options.size->value))) {
        refuse(source, fmt::format("stated size {}: expected a positive number", options.size->value));
    }
    if (!options.columns.empty() && out.format != "table") {
        refuse(source, fmt::format("names of columns were stated: expected a table, the format is {}", out.format));
    }
    if ((out.format == "lammps-data" || out.format == "centres") && options.frame.value_or(0) != 0) {
        refuse(source, fmt::format("frame {} was asked for: expected frame 0, a file of {} has one", *options.frame,
                                   out.format));
    }
    Raw raw;
    if (out.format == "lammps-data") {
        raw = foreign::read_lammps_data(text, source, options);
    } else if (out.format == "lammps-dump") {
        raw = foreign::read_lammps_dump(text, source, options);
    } else if (out.format == "xyz") {
        raw = foreign::read_xyz(text, source, options);
    } else if (out.format == "table") {
        raw = foreign::read_table(text, source, options);
    } else if (out.format == "centres") {
        raw = foreign::read_centres(text, source, options);
    } else {
        refuse(source, fmt::format("format '{}': expected one of {}", out.format, fmt::join(foreign_formats(), ", ")));
    }
    Packing& packing = out.packing;
    packing.dimension = packing.cell.dimension = dimension_of(raw, source, options);
    packing.walls = Walls::none();
    const std::size_t d = packing.axes();
    ForeignOptions stated = options;
    take_box(raw, d, source, stated);
    check_boundaries(raw, d, source, stated);
    out.notes = raw.notes;
    out.ids = raw.ids;
    if (!text.ends_with('\n')) {
        out.notes.emplace_back("the last line has no end: was the file cut there?");
    }
    for (std::size_t i = 0; i < raw.centre.size(); ++i) {
        packing.q.insert(packing.q.end(), raw.centre[i].begin(),
                         raw.centre[i].begin() + static_cast<std::ptrdiff_t>(d));
        packing.radius.push_back(raw.meaning == SizeMeaning::radius ? raw.size[i] : raw.size[i] / 2);
    }
    const bool periodic =
        std::count(raw.boundary.begin(), raw.boundary.begin() + static_cast<std::ptrdiff_t>(d), Boundary::periodic) > 0;
    const double moved = (periodic ? add_cell : add_walls)(out, raw, source, stated);
    check_range(packing, source);
    out.rounding = rounding_of(raw, out, options, moved);
    return out;
}

ForeignPacking read_foreign(const std::filesystem::path& path, const ForeignOptions& options) {
    return parse_foreign(read_text(path), path.string(), options);
}

} // namespace isostat
