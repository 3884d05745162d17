#include "io/files.hpp"
#include "io/foreign_box.hpp"
#include "io/numbers.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/foreign.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using foreign::Raw;

[[noreturn]] void refuse(const std::string& source, const std::string& message) {
    throw Error(ErrorKind::bad_input, source + ": " + message);
}

/// Disks where z is the same, or differs by so little that no gap of two disks, sqrt(d^2 + z^2), is another double:
/// `rounding` is by how much.
int dimension_of(Raw& raw, const std::string& source, const ForeignOptions& options, double& rounding) {
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
        rounding = off(farthest) * off(farthest) / radius; // of two disks, 2 off
    }
    if (dimension == 2 && !raw.not_plane.empty()) {
        throw Error(ErrorKind::bad_input, raw.not_plane);
    }
    if (raw.vectors && foreign::are_upper(*raw.vectors, static_cast<std::size_t>(dimension))) {
        raw.vectors.reset();
    }
    return dimension;
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

bool foreign::are_upper(const PerAxis<PerAxis<double>>& vectors, std::size_t d) {
    bool upper = true;
    for (std::size_t a = 0; a < d; ++a) {
        upper = upper && vectors[a][a] > 0;
        for (std::size_t b = a + 1; b < d; ++b) {
            upper = upper && vectors[a][b] == 0;
        }
    }
    return upper;
}

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
    packing.dimension = packing.cell.dimension = dimension_of(raw, source, options, out.rounding);
    packing.walls = Walls::none();
    const std::size_t d = packing.axes();
    ForeignOptions stated = options;
    foreign::settle_bounds(raw, d, source, stated);
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
    const double moved = foreign::add_box(out, raw, source, stated);
    check_range(packing, source);
    out.rounding += rounding_of(raw, out, options, moved);
    return out;
}

ForeignPacking read_foreign(const std::filesystem::path& path, const ForeignOptions& options) {
    return parse_foreign(read_text(path), path.string(), options);
}

} // namespace isostat
