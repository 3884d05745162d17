// Reads the header of LAMMPS dumps of styles custom and local.
#include "foreign/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace isostat::foreign {

namespace {

/// Reads a general triclinic box: the period vectors, each with a coordinate of the origin.
void read_general_bounds(TextLines& lines, FrameHeader& frame) {
    PerAxis<PerAxis<double>> vectors{};
    PerAxis<double> origin{};
    for (std::size_t b = 0; b < most_axes; ++b) {
        const TextLine line = lines.next("a period vector and a coordinate of the origin");
        line.require_size(4, "a period vector and a coordinate of the origin");
        take_vector(line, vectors[b], frame);
        origin[b] = line.number(3, "origin");
        frame.sides[0].see(line.field(3));
    }
    frame.take_vectors(vectors, origin);
}

void read_bounds(TextLines& lines, std::string_view flags_text, FrameHeader& frame) {
    const TextLine flags(flags_text, lines.number(), &lines.source());
    std::vector<std::string_view> codes;
    bool tilted = false, general = false;
    for (std::size_t k = 0; k < flags.size(); ++k) {
        const std::string_view code = flags.field(k);
        if (code == "xy" || code == "xz" || code == "yz") {
            tilted = true;
        } else if (code == "abc" || code == "origin") {
            general = true;
        } else if (code.size() == 2 && code.find_first_not_of("pfsm") == std::string_view::npos) {
            codes.push_back(code);
        } else if (code != "xx" && code != "yy" && code != "zz") { // some programs write the placeholders of the manual
            flags.fail(code, "boundary", "two of the letters p f s m, for instance ff");
        }
    }
    if (!codes.empty() && codes.size() != 3) {
        flags.fail(flags_text, "boundaries", "three of them");
    }
    for (std::size_t a = 0; a < codes.size(); ++a) {
        frame.boundary[a] = codes[a].find('p') != std::string_view::npos ? Boundary::periodic : Boundary::open;
        frame.loose[a] = codes[a].find_first_of("sm") != std::string_view::npos;
    }
    if (general) {
        read_general_bounds(lines, frame);
        return;
    }
    PerAxis<std::array<double, 2>> box{};
    for (std::size_t a = 0; a < most_axes; ++a) {
        const TextLine line = lines.next("the bounds of the box: low high");
        line.require_size(tilted ? 3 : 2, "bounds of the box");
        const double low = line.number(0, "lower bound"), high = line.number(1, "upper bound");
        if (!(low <= high)) {
            line.fail(line.field(1), "upper bound", "a number above the lower bound {}", low);
        }
        frame.sides[a].see(line.field(0));
        frame.sides[a].see(line.field(1));
        if (tilted) {
            take_tilt(line, 2, a, frame);
        }
        box[a] = {low, high};
    }
    // A dump bounds the whole parallelepiped: xlo + min(0, xy, xz, xy + xz), xhi + max(...), ylo + min(0, yz).
    const auto& [xy, xz, yz] = frame.tilt;
    box[0][0] -= std::min({0.0, xy, xz, xy + xz});
    box[0][1] -= std::max({0.0, xy, xz, xy + xz});
    box[1][0] -= std::min(0.0, yz);
    box[1][1] -= std::max(0.0, yz);
    frame.box = box;
}

} // namespace

void Bounds::take_vectors(const PerAxis<PerAxis<double>>& periods, const PerAxis<double>& origin) {
    vectors = periods;
    tilt = {periods[1][0], periods[2][0], periods[2][1]};
    box.emplace();
    for (std::size_t a = 0; a < most_axes; ++a) {
        (*box)[a] = {origin[a], origin[a] + periods[a][a]};
    }
}

bool Bounds::leaves_the_plane() const {
    bool out = tilt[1] != 0 || tilt[2] != 0;
    for (std::size_t a = 0; vectors && a < 2; ++a) {
        out = out || (*vectors)[a][2] != 0 || (*vectors)[2][a] != 0;
    }
    return out;
}

void take_vector(const TextLine& line, PerAxis<double>& vector, Bounds& bounds) {
    for (std::size_t a = 0; a < most_axes; ++a) {
        vector[a] = line.number(a, "entry of a period vector");
        bounds.sides[0].see(line.field(a));
    }
    bounds.place = fmt::format("{}: the period vector is '{}'", line.place(), line.text());
}

void take_tilt(const TextLine& line, std::size_t field, std::size_t tilt, Bounds& bounds) {
    bounds.tilt[tilt] = line.number(field, "tilt");
    bounds.sides[0].see(line.field(field));
    if (tilt > 0 && bounds.tilt[tilt] != 0 && bounds.place.empty()) {
        bounds.place = fmt::format("{}: tilt of the box is '{}'", line.place(), line.field(field));
    }
}

FrameHeader read_dump_header(TextLines& lines, const std::string& item) {
    FrameHeader frame;
    const std::string rows = item == "ATOMS" ? "atoms" : "entries";
    std::set<std::string> seen;
    for (bool first = true;; first = false) {
        const std::string_view text = lines.take("ITEM: " + item);
        const TextLine line(text, lines.number(), &lines.source());
        const auto starts = [&](const std::string& name) {
            return text.starts_with(name) &&
                   (text.size() == name.size() || std::isspace(static_cast<unsigned char>(text[name.size()])) != 0);
        };
        if (line.size() > 1 && !seen.insert(std::string(line.field(1))).second) {
            line.fail(text, "item", "it once in a frame");
        }
        if (first && !starts("ITEM: TIMESTEP") && !starts("ITEM: UNITS") && !starts("ITEM: TIME")) {
            line.fail(text, "start of a frame", "ITEM: TIMESTEP");
        }
        if (starts("ITEM: TIMESTEP")) {
            const TextLine value = lines.next("the time step");
            value.require_size(1, "the time step");
            frame.timestep = value.integer(0, "time step", 0, 1L << 62);
        } else if (starts("ITEM: UNITS") || starts("ITEM: TIME")) {
            (void)lines.take("units or time");
        } else if (starts("ITEM: NUMBER OF " + item)) {
            const TextLine value = lines.next("the number of " + rows);
            value.require_size(1, "the number of " + rows);
            frame.rows = value.integer(0, "number of " + rows, 0, most_disks);
        } else if (starts("ITEM: BOX BOUNDS")) {
            read_bounds(lines, text.substr(std::string_view("ITEM: BOX BOUNDS").size()), frame);
        } else if (starts("ITEM: " + item)) {
            if (frame.rows < 0 || !frame.box) {
                line.fail(text, "item", "ITEM: NUMBER OF {} and ITEM: BOX BOUNDS before it", item);
            }
            frame.line = line.number();
            frame.names.assign(line.fields().begin() + 2, line.fields().end());
            return frame;
        } else {
            line.fail(text, "item", "TIMESTEP, UNITS, TIME, NUMBER OF {0}, BOX BOUNDS or {0} (a dump of style {1})",
                      item, item == "ATOMS" ? "custom" : "local");
        }
    }
}

} // namespace isostat::foreign
