#include "io/files.hpp"
#include "io/foreign_source.hpp"
#include "io/numbers.hpp"
#include "packing/cell_wrap.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/foreign.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using foreign::Boundary;
using foreign::Raw;

[[noreturn]] void refuse(const std::string& source, const std::string& message) {
    throw Error(ErrorKind::bad_input, source + ": " + message);
}

void check_boundaries(Raw& raw, const std::string& source, const ForeignOptions& options) {
    for (std::size_t a = 0; a < 2; ++a) {
        const char axis = a == 0 ? 'x' : 'y';
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
    const bool both = raw.boundary[0] == Boundary::periodic && raw.boundary[1] == Boundary::periodic;
    if (raw.tilt != 0 && !both) {
        refuse(source,
               fmt::format(
                   "the box (Lattice, or xy) is tilted by {}: expected one along the axes, or both axes periodic{}",
                   raw.tilt, options.cells ? " (--periodic says so where the file does not)" : ""));
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

/// The walls of one axis, where they were asked for.
void add_wall_pair(ForeignPacking& out, std::size_t a, const Raw& raw, const std::string& source,
                   const ForeignOptions& options, double& worst) {
    Packing& packing = out.packing;
    if (options.walls == ForeignWalls::none) {
        packing.q.push_back(0);
        return;
    }
    const std::array<double, 4> box = options.box ? *options.box : *raw.box;
    if (!options.box && raw.loose[a]) {
        refuse(source, fmt::format("bounds along {} are shrink-wrapped: expected fixed ones for walls, or --box",
                                   a == 0 ? 'x' : 'y'));
    }
    const double low = box[2 * a], high = box[2 * a + 1];
    if (!(low < high)) {
        refuse(source, fmt::format("box from {} to {}: expected a lower and a higher bound", low, high));
    }
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        double& x = packing.q[2 * i + a];
        if (!(low < x && x < high)) {
            refuse(source, fmt::format("{} of disk {} is {}: expected a centre between the walls at {} and {}{}{}",
                                       a == 0 ? 'x' : 'y', i, x, low, high, raw.types.empty() ? "" : "; ", raw.types));
        }
        x = shifted(x, low, worst);
    }
    packing.q.push_back(shifted(high, low, worst));
    packing.walls.lower[a] = WallKind::fixed;
    packing.walls.upper[a] = options.walls == ForeignWalls::box ? WallKind::movable : WallKind::fixed;
}

/// Periodic axes: the cell of the file, which does not move, with its lower corner at 0 and the disks in it. By how
/// much that rounds a coordinate.
double add_cell(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options) {
    Packing& packing = out.packing;
    if (!raw.box) {
        refuse(source, "periodic, and the file has no bounds of a box: expected some");
    }
    const bool all = raw.boundary[0] == raw.boundary[1];
    if (all && ((options.walls != ForeignWalls::none && !options.walls_unless_periodic) || options.box)) {
        refuse(source, "walls or a box were stated of a periodic packing: expected none (--not-periodic looks at the "
                       "disks as they lie)");
    }
    packing.walls = Walls::none();
    double worst = 0;
    for (std::size_t a = 0; a < 2; ++a) {
        packing.cell.periodic[a] = raw.boundary[a] == Boundary::periodic;
        if (!packing.cell.periodic[a]) {
            add_wall_pair(out, a, raw, source, options, worst);
            continue;
        }
        const double low = (*raw.box)[2 * a];
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            double& x = packing.q[2 * i + a];
            x = shifted(x, low, worst);
        }
        packing.q.push_back(shifted((*raw.box)[2 * a + 1], low, worst));
    }
    packing.q.push_back(raw.tilt);
    for (std::size_t a = 0; a < 2; ++a) {
        if (packing.cell.periodic[a] && !(packing.lattice(a, a) > 0)) {
            refuse(source, fmt::format("period {} along {}: expected a positive one", packing.lattice(a, a),
                                       a == 0 ? 'x' : 'y'));
        }
    }
    worst = std::max(worst, wrap_into_cell(packing).rounding);
    const std::string along = options.walls == ForeignWalls::none ? "open along" : "walls along";
    out.notes.push_back(fmt::format("periodic along {}: lengths {} and {}, tilt {}",
                                    packing.cell.all()         ? "x and y"
                                    : packing.cell.periodic[0] ? "x, " + along + " y"
                                                               : "y, " + along + " x",
                                    packing.lattice(0, 0), packing.lattice(1, 1), raw.tilt));
    if (worst > 0) {
        out.notes.push_back(fmt::format("coordinates were moved into the cell: rounded by up to {:.2g}", worst));
    }
    return worst;
}

/// By how much the shift to them rounds a coordinate.
double add_walls(ForeignPacking& out, const Raw& raw, const std::string& source, const ForeignOptions& options) {
    Packing& packing = out.packing;
    packing.walls = Walls::none();
    if (options.walls == ForeignWalls::none) {
        packing.q.insert(packing.q.end(), {0, 0});
        if (options.box) {
            refuse(source, "a box was stated without walls: expected walls box or fixed");
        }
        if (raw.box) {
            out.notes.emplace_back("no walls: the bounds of the box in the file are not used");
        }
        return 0;
    }
    if (!options.box && !raw.box) {
        refuse(source, "walls were asked for and the file has no bounds of a box: expected --box xlo:xhi,ylo:yhi");
    }
    const std::array<double, 4> box = options.box ? *options.box : *raw.box;
    double worst = 0;
    for (std::size_t a = 0; a < 2; ++a) {
        add_wall_pair(out, a, raw, source, options, worst);
    }
    out.notes.push_back(
        fmt::format("walls at x = {}, {} and y = {}, {}: {}", box[0], box[1], box[2], box[3],
                    options.walls == ForeignWalls::box ? "left and bottom fixed, right and top movable" : "fixed"));
    if (worst > 0) {
        out.notes.push_back(fmt::format("coordinates were shifted to the lower walls: rounded by up to {:.2g}", worst));
    }
    return worst;
}

/// \p moved: the rounding of a coordinate that came with the walls or the cell.
double rounding_of(const Raw& raw, const ForeignPacking& found, const ForeignOptions& options, double moved) {
    const bool walls = !(found.packing.walls == Walls::none());
    const bool sides = found.packing.cell.any() || (walls && !options.box);
    const int digits = std::max({raw.places.most(), raw.sizes.most(), sides ? raw.sides.most() : 0});
    const double scaled = raw.scale == 1 ? 0 : 0x1p-51 * raw.scale; // three operations
    double size = raw.sizes.rounding(digits);
    size = std::max(raw.meaning == SizeMeaning::radius ? size : size / 2, 0x1p-53 * found.packing.max_radius());
    double side = sides ? raw.sides.rounding(digits) + moved : 0;
    for (std::size_t k = 0; options.box && k < 4; ++k) {
        side = std::max(side, 0x1p-53 * std::abs((*options.box)[k]) + moved);
    }
    return rounding_of_gaps(raw.places.rounding(digits) * raw.scale + scaled + moved, side, size);
}

} // namespace

const std::vector<std::string>& foreign_formats() {
    static const std::vector<std::string> formats{"lammps-data", "lammps-dump", "xyz", "table"};
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
    while (!rows.at_end() && start.size() < 2) {
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
    if (start.size() == 2 && is_count(start[0]) && start[0].size() == 1) {
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
    if (out.format == "lammps-data" && options.frame.value_or(0) != 0) {
        refuse(source, fmt::format("frame {} was asked for: expected frame 0, a data file has one", *options.frame));
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
    } else {
        refuse(source, fmt::format("format '{}': expected one of {}", out.format, fmt::join(foreign_formats(), ", ")));
    }
    check_boundaries(raw, source, options);
    out.notes = raw.notes;
    out.ids = raw.ids;
    if (!text.ends_with('\n')) {
        out.notes.emplace_back("the last line has no end: was the file cut there?");
    }
    for (std::size_t i = 0; i < raw.x.size(); ++i) {
        out.packing.q.push_back(raw.x[i]);
        out.packing.q.push_back(raw.y[i]);
        out.packing.radius.push_back(raw.meaning == SizeMeaning::radius ? raw.size[i] : raw.size[i] / 2);
    }
    const bool periodic = raw.boundary[0] == Boundary::periodic || raw.boundary[1] == Boundary::periodic;
    const double moved = (periodic ? add_cell : add_walls)(out, raw, source, options);
    check_range(out.packing, source);
    out.rounding = rounding_of(raw, out, options, moved);
    return out;
}

ForeignPacking read_foreign(const std::filesystem::path& path, const ForeignOptions& options) {
    return parse_foreign(read_text(path), path.string(), options);
}

} // namespace isostat
