#include "foreign/source.hpp"
#include "io/files.hpp"
#include "io/numbers.hpp"
#include "packing/words.hpp"

#include <isostat/foreign/foreign.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <span>
#include <string_view>

namespace isostat {

namespace {

using foreign::Boundary;
using foreign::Raw;

/// Permutes the axes so that the plane of the disks is that of x and y.
void take_plane(Raw& raw, const std::string& plane, const std::string& source) {
    if (plane == "xy") {
        return;
    }
    if (!raw.has_z) {
        refuse(source, "--plane {} was stated and there is no column z: expected one", plane);
    }
    const PerAxis<std::size_t> from{plane == "xz" ? 0U : 1U, 2, plane == "xz" ? 1U : 0U};
    const auto permuted = [&](auto& of_axes) {
        const auto before = of_axes;
        for (std::size_t a = 0; a < most_axes; ++a) {
            of_axes[a] = before[from[a]];
        }
    };
    std::ranges::for_each(raw.centre, permuted);
    permuted(raw.places);
    permuted(raw.boundary);
    permuted(raw.loose);
    if (raw.box && !raw.vectors) {
        const auto& [xy, xz, yz] = raw.tilt;
        const auto length = [&](std::size_t a) { return (*raw.box)[a][1] - (*raw.box)[a][0]; };
        raw.vectors = {{{length(0), 0, 0}, {xy, length(1), 0}, {xz, yz, length(2)}}};
    }
    if (raw.vectors) {
        auto box = *raw.box;
        std::ranges::for_each(*raw.vectors, permuted);
        permuted(*raw.vectors);
        permuted(box);
        const Digits digits = raw.sides[0];
        permuted(raw.sides);
        raw.sides[0].see(digits); // these include the tilts
        raw.take_vectors(*raw.vectors, {box[0][0], box[1][0], box[2][0]});
        raw.box = box;
    }
    raw.notes.push_back(fmt::format("the plane of {} is taken for that of the disks", plane));
}

/// Converts coordinates in units of the box to lengths.
void multiply_out(Raw& raw, const std::string& source) {
    if (!raw.box) {
        refuse(source, "scaled coordinates, and the file has no bounds of a box: expected some");
    }
    const auto& box = *raw.box;
    for (PerAxis<double>& x : raw.centre) {
        const PerAxis<double> s = x;
        for (std::size_t a = 0; a < most_axes; ++a) {
            x[a] = box[a][0] + s[a] * (box[a][1] - box[a][0]);
            for (std::size_t b = 0; b < most_axes; ++b) {
                x[a] += b == a ? 0
                               : s[b] * (raw.vectors ? (*raw.vectors)[b][a]
                                         : b > a     ? raw.tilt[Cell::tilt(a, b)]
                                                     : 0);
            }
        }
    }
    raw.notes.emplace_back("scaled coordinates were multiplied out in double: rounded at 2^-52 of the box");
}

/// For formats that are not read, recognised by their first characters: the name and the remedy.
std::string not_read(std::string_view text) {
    struct Known {
        std::string_view begin;
        const char* words;
    };
    using namespace std::string_view_literals;
    static constexpr std::array<Known, 17> all{
        {{"\x1f\x8b"sv, "is packed with gzip: unpack it (gunzip -k FILE)"},
         {"BZh"sv, "is packed with bzip2: unpack it (bunzip2 -k FILE)"},
         {"\xfd"
          "7zXZ"sv,
          "is packed with xz: unpack it (unxz -k FILE)"},
         {"\x28\xb5\x2f\xfd"sv, "is packed with zstd: unpack it (unzstd FILE)"},
         {"PK\x03\x04"sv, "is a zip archive (npz too): expected a text in it"},
         {"\xff\xfe"sv, "is in UTF-16: iconv -f UTF-16 -t UTF-8 FILE makes a text of it"},
         {"\xfe\xff"sv, "is in UTF-16: iconv -f UTF-16 -t UTF-8 FILE makes a text of it"},
         {"\x89HDF"sv, "is an HDF5 file: write its centres and radii as a table x,y,r"},
         {"CDF\x01"sv, "is a NetCDF file: write its centres and radii as a table x,y,r"},
         {"CDF\x02"sv, "is a NetCDF file: write its centres and radii as a table x,y,r"},
         {"MATLAB 5"sv, "is a MAT file: write its centres and radii as a table x,y,r (writematrix)"},
         {"\x93NUMPY"sv, "is a file of numpy: numpy.savetxt(FILE, a, header='x y r') writes a table"},
         {"---\n"sv, "is in YAML (a dump of style yaml?): dump of style custom, or a table x,y,r, is read"},
         {"# vtk DataFile"sv, "is a VTK file: --skip N --columns x,y,z takes rows of points, or write a table x,y,r"},
         {"<VTKFile"sv, "is a VTK file in XML: write a table x,y,r"},
         {"<?xml"sv, "is in XML: write a table x,y,r"},
         {"[{"sv, "is a list in JSON: write a table x,y,r"}}};
    for (const Known& known : all) {
        if (text.starts_with(known.begin)) {
            return known.words;
        }
    }
    return text.find('\0') != std::string_view::npos
               ? "has bytes that are no text (a binary file?): write centres and radii as a table x,y,r"
               : "";
}

/// The text after its first lines.
std::string_view after_lines(std::string_view text, long lines) {
    for (long k = 0; k < lines && !text.empty(); ++k) {
        text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    }
    return text;
}

/// The dimension: disks if z is constant, or varies by so little that no gap of two disks, sqrt(d^2 + z^2), is another
/// double; `rounding` is the change of a gap.
int dimension_of(Raw& raw, const std::string& source, const ForeignOptions& options, double& rounding) {
    const std::optional<int> stated = options.dimension ? options.dimension : raw.dimension;
    if (stated.value_or(2) != raw.dimension.value_or(stated.value_or(2))) {
        refuse(source, "dimension {} was stated and the file has {}: expected that", *stated, *raw.dimension);
    }
    if (stated == 3 && !raw.has_z) {
        refuse(source, "dimension 3 was stated and there is no column z: expected one");
    }
    const auto off = [&](std::size_t i) { return std::abs(raw.centre[i][2] - raw.centre[0][2]); };
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < raw.centre.size(); ++i) {
        farthest = off(i) > off(farthest) ? i : farthest;
    }
    const double radius = *std::ranges::min_element(raw.size) / (raw.meaning == SizeMeaning::radius ? 1 : 2);
    const bool flat = off(farthest) <= 0x1p-27 * radius;
    const int dimension = stated.value_or(flat ? 2 : 3);
    if (dimension == 2 && !flat) {
        refuse(fmt::format("{}:{}", source, raw.line[farthest]),
               "z of disk {} is '{}': expected {}, as of disk 0: disks were stated, in a plane (--dimension 3 takes "
               "spheres)",
               farthest, raw.centre[farthest][2], raw.centre[0][2]);
    }
    if (dimension == 2 && off(farthest) > 0) {
        raw.notes.push_back(
            fmt::format("z differs by up to {:.2g}, which changes no gap: taken for a plane", off(farthest)));
        rounding = off(farthest) * off(farthest) / radius; // two disks differ by up to 2 off
    }
    if (dimension == 2 && raw.leaves_the_plane()) {
        refuse(raw.place.empty() ? source : raw.place, "expected a cell in the plane of the disks");
    }
    for (std::size_t a = 0; dimension == 3 && !stated && a < 2; ++a) {
        if (std::ranges::all_of(raw.centre, [&](const auto& x) { return x[a] == raw.centre[0][a]; })) {
            raw.notes.push_back(fmt::format("{} is the same for all: --plane {} takes them for disks", axis_names[a],
                                            a == 0 ? "yz" : "xz"));
        }
    }
    if (raw.vectors && foreign::are_upper(*raw.vectors, static_cast<std::size_t>(dimension))) {
        raw.vectors.reset();
    }
    return dimension;
}

/// `validate` is not used, because disks of any size may overlap and may be beyond the walls.
void check_range(const Packing& packing, const std::string& source) {
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        if (!(packing.radius[i] >= shortest_length && packing.radius[i] <= longest_length)) {
            refuse(source, "radius of disk {} is {}: expected one from {} to {}", i, packing.radius[i], shortest_length,
                   longest_length);
        }
    }
    for (const double x : packing.q) {
        if (!(std::abs(x) <= longest_length)) {
            refuse(source, "a coordinate is {}: expected a size of at most {}", x, longest_length);
        }
    }
}

/// The rounding of multiplying out scaled coordinates, and the `factor` of their digits.
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
        double reach = std::abs(high - low);
        for (std::size_t b = 0; b < axes; ++b) {
            reach += b == a ? 0 : std::abs(raw.vectors ? (*raw.vectors)[b][a] : b > a ? raw.tilt[Cell::tilt(a, b)] : 0);
        }
        out.factor = std::max(out.factor, reach);
        bound = std::max({bound, std::abs(low), std::abs(high)});
    }
    out.rounding = 0x1p-52 * static_cast<double>(axes) * (out.factor + bound); // two operations for each axis
    return out;
}

/// The rounding of a gap. \p moved: the rounding of a coordinate by the shift to the walls or the cell.
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
    const bool tilted = raw.vectors || std::ranges::any_of(raw.tilt, [](double tilt) { return tilt != 0; });
    const Scaling scaling = scaling_of(raw, packing.axes());
    // All coordinates have as many digits as given; where that is fewer than radii have, digits were cut off.
    return rounding_of_gaps(places.rounding() * scaling.factor + scaling.rounding + moved, side, size,
                            {packing.dimension, packing.cell.any() && tilted});
}

bool one_frame(const std::string& format) {
    return format != "lammps-dump" && format != "xyz";
}

Raw read_raw(const std::string& format, const std::string& text, const std::string& source,
             const ForeignOptions& options) {
    const auto* const found = std::ranges::find(foreign::formats, format, &foreign::Format::name);
    if (found == foreign::formats.end()) {
        refuse(source, "format '{}': expected one of {}", format, fmt::join(foreign_formats(), ", "));
    }
    return found->read(text, source, options);
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
    static const auto names = foreign::formats | std::views::transform(&foreign::Format::name);
    static const std::vector<std::string> all(names.begin(), names.end());
    return all;
}

ForeignPacking parse_foreign(const std::string& whole, const std::string& source, const ForeignOptions& options) {
    ForeignPacking out;
    const std::string rest(options.skip > 0 ? after_lines(whole, options.skip) : "");
    const std::string& text = options.skip > 0 ? rest : whole;
    if (const std::string words = not_read(text); !words.empty()) {
        refuse(source, words);
    }
    out.format = !options.format.empty() ? options.format : options.skip > 0 ? "table" : recognise_format(text);
    if (options.skip > 0 && out.format != "table") {
        refuse(source, "{} lines were to be passed over: expected a table, the format is {}", options.skip, out.format);
    }
    if (options.size && options.size->column.empty() &&
        !(options.size->value > 0 && std::isfinite(options.size->value))) {
        refuse(source, "stated size {}: expected a positive number", options.size->value);
    }
    if (!options.columns.empty() && out.format == "centres") {
        refuse(source, "names of columns were stated: expected none, a file of centres has coordinates alone");
    }
    if (options.frame.value_or(0) != 0 && one_frame(out.format)) {
        refuse(source, "frame {} was asked for: expected frame 0, a file of {} has one", *options.frame, out.format);
    }
    Raw raw = read_raw(out.format, text, source, options);
    if (raw.scaled) {
        multiply_out(raw, source);
    }
    take_plane(raw, options.plane, source);
    Packing& packing = out.packing;
    packing.dimension = packing.cell.dimension = dimension_of(raw, source, options, out.rounding);
    packing.walls = Walls::none();
    const std::size_t d = packing.axes();
    ForeignOptions stated = options;
    foreign::settle_bounds(raw, d, source, stated);
    out.notes = raw.notes;
    out.ids = raw.ids;
    packing.fixed = raw.fixed;
    const auto axes = std::span(raw.boundary).first(d);
    if (!raw.fixed.empty() && std::ranges::find(axes, Boundary::periodic) != axes.end()) {
        refuse(source, "disks that cannot move were stated, of a periodic packing: expected walls or open boundaries");
    }
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
    if (!raw.bodies.empty()) {
        foreign::add_bodies(out, raw.bodies, source);
    }
    return out;
}

ForeignPacking read_foreign(const std::filesystem::path& path, const ForeignOptions& options) {
    return parse_foreign(read_packed_text(path), path.string(), options);
}

} // namespace isostat
