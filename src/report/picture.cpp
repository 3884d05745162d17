#include "report/picture.hpp"

#include "io/text.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/bodies.hpp"
#include "packing/cell_wrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

namespace isostat {

namespace {

using Point = PerAxis<double>;

/// Corners of the cell, in order.
std::array<Point, 4> corners(const Packing& packing) {
    return {corner(packing, 0), corner(packing, 1), corner(packing, 3), corner(packing, 2)};
}

/// The drawn area: the box, or the cell with space for images.
struct Frame {
    Point low{}, high{};
};

/// The largest coordinate of what a disk shows: of an arc at its ends, or where its normal is along the axis.
double farthest(const ArcBodies& arcs, const Packing& packing, int disk, int axis) {
    const double at = packing.coordinate(DiskId(disk), axis);
    const double radius = packing.radius[static_cast<std::size_t>(disk)];
    const auto sector = arcs.angles(disk);
    if (!sector) {
        return at + radius;
    }
    const double along = axis * std::numbers::pi / 2;
    const double turned = along < (*sector)[0] ? along + 2 * std::numbers::pi : along;
    return at +
           radius *
               (turned <= (*sector)[1] ? 1 : std::max(std::cos((*sector)[0] - along), std::cos((*sector)[1] - along)));
}

Frame frame_of(const State& state) {
    Frame frame;
    if (state.packing.cell.any()) {
        constexpr double radii = 2.5; // a disk that touches a disk of the cell is shown
        const PerAxis<bool>& periodic = state.packing.cell.periodic;
        const Point room{periodic[0] ? radii * state.packing.max_radius() : 0,
                         periodic[1] ? radii * state.packing.max_radius() : 0};
        frame = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
        for (const Point& p : corners(state.packing)) {
            frame.low = {std::min(frame.low[0], p[0] - room[0]), std::min(frame.low[1], p[1] - room[1])};
            frame.high = {std::max(frame.high[0], p[0] + room[0]), std::max(frame.high[1], p[1] + room[1])};
        }
        return frame;
    }
    const ArcBodies arcs(state.packing);
    const auto extent = [&](int axis) {
        double most = state.packing.walls.upper[static_cast<std::size_t>(axis)] == WallKind::absent
                          ? 0
                          : state.packing.length(axis);
        for (int i = 0; i < state.packing.disk_count(); ++i) {
            most = std::max(most, farthest(arcs, state.packing, i, axis));
        }
        return most > 0 ? most : 1;
    };
    frame.high = {extent(0), extent(1)};
    return frame;
}

/// Writes shapes in picture units: 1000 units across the drawn area, y downwards.
class Canvas {
  public:
    explicit Canvas(const State& state) : frame_(frame_of(state)), scale_(1000 / (frame_.high[0] - frame_.low[0])) {}

    [[nodiscard]] double scale() const { return scale_; }
    [[nodiscard]] double height() const { return (frame_.high[1] - frame_.low[1]) * scale_; }
    [[nodiscard]] Point low() const { return frame_.low; }
    /// Whether most of a disk is in the drawn area.
    [[nodiscard]] bool shows(Point at, double radius) const {
        const double in = radius / 2;
        return at[0] >= frame_.low[0] + in && at[0] <= frame_.high[0] - in && at[1] >= frame_.low[1] + in &&
               at[1] <= frame_.high[1] - in;
    }
    void circle(Point at, double radius, const char* style) {
        add(R"(<circle cx="{:.3f}" cy="{:.3f}" r="{:.3f}" class="{}"/>)", x(at), y(at), radius * scale_, style);
    }
    /// Where a curve of arcs begins, its arcs, and its end.
    void begin(Point at) { add(R"(<path d="M {:.3f} {:.3f})", x(at), y(at)); }
    void arc_to(Point at, double radius) {
        add("A {0:.3f} {0:.3f} 0 0 0 {1:.3f} {2:.3f}", radius * scale_, x(at), y(at));
    }
    void end(const char* style) { add(R"(Z" class="{}"/>)", style); }
    void line(Point from, Point to, double width, const char* style) {
        add(R"(<line x1="{:.3f}" y1="{:.3f}" x2="{:.3f}" y2="{:.3f}" stroke-width="{:.3f}" class="{}"/>)", x(from),
            y(from), x(to), y(to), width, style);
    }
    void text(Point at, const std::string& words) {
        add(R"(<text x="{:.1f}" y="{:.1f}">{}</text>)", x(at), y(at), text::markup(words));
    }
    std::string take() { return std::move(text_); }

  private:
    [[nodiscard]] double x(Point p) const { return (p[0] - frame_.low[0]) * scale_; }
    [[nodiscard]] double y(Point p) const { return (frame_.high[1] - p[1]) * scale_; }
    template <class... Values> void add(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
        text_ += '\n';
    }
    Frame frame_;
    double scale_;
    std::string text_;
};

constexpr double wall_width = 8; // picture units

/// Draws the walls outside the box, so that they hide no disk and no force.
void draw_walls(Canvas& canvas, const State& state) {
    constexpr double thickness = wall_width;
    const double out = thickness / 2 / canvas.scale();
    const auto& walls = state.packing.walls;
    const double lx = state.packing.length(0);
    const double ly = state.packing.length(1);
    const auto draw = [&](WallKind kind, Point from, Point to) {
        if (kind != WallKind::absent) {
            canvas.line(from, to, thickness, kind == WallKind::fixed ? "fixed" : "movable");
        }
    };
    draw(walls.lower[0], {-out, 0}, {-out, ly});
    draw(walls.lower[1], {0, -out}, {lx, -out});
    draw(walls.upper[0], {lx + out, 0}, {lx + out, ly});
    draw(walls.upper[1], {0, ly + out}, {lx, ly + out});
}

/// Draws the periodic sides, dashed.
void draw_cell(Canvas& canvas, const Packing& packing) {
    if (!packing.cell.any()) {
        return;
    }
    const std::array<Point, 4> corner = corners(packing);
    for (std::size_t k = 0; k < 4; ++k) {
        if (packing.cell.periodic[(k + 1) % 2]) { // sides 0 and 2 are along x and repeat along y
            canvas.line(corner[k], corner[(k + 1) % 4], 2.5, "cell");
        }
    }
}

/// Draws the disks, and in a cell their images; the images outside the cell are fainter.
void draw_disks(Canvas& canvas, const State& state, const std::vector<unsigned char>& rattler) {
    const Packing& packing = state.packing;
    constexpr int around = 1; // images: the disks were put into the cell
    const ArcBodies arcs(packing);
    for (const std::vector<int>& ring : packing.arcs) {
        const auto point = [&](int member, double angle) {
            const double r = packing.radius[static_cast<std::size_t>(member)];
            const Point at = centre_of(packing, member);
            return Point{at[0] + r * std::cos(angle), at[1] + r * std::sin(angle)};
        };
        canvas.begin(point(ring.front(), (*arcs.angles(ring.front()))[0]));
        for (const int member : ring) {
            canvas.arc_to(point(member, (*arcs.angles(member))[1]), packing.radius[static_cast<std::size_t>(member)]);
        }
        canvas.end(rattler[static_cast<std::size_t>(ring.front())] != 0 ? "rattler" : "disk");
    }
    for (int i = 0; i < packing.disk_count(); ++i) {
        const auto s = static_cast<std::size_t>(i);
        if (arcs.angles(i)) {
            continue;
        }
        for (int m = -around; m <= around; ++m) {
            for (int p = -around; p <= around; ++p) {
                const bool here = m == 0 && p == 0;
                const bool there = (m == 0 || packing.cell.periodic[0]) && (p == 0 || packing.cell.periodic[1]);
                Point at = centre_of(packing, i);
                if (there) {
                    add_periods(at, packing, std::array{m, p});
                }
                if (here) {
                    canvas.circle(at, packing.radius[s], rattler[s] != 0 ? "rattler" : "disk");
                } else if (there && canvas.shows(at, packing.radius[s])) {
                    canvas.circle(at, packing.radius[s], rattler[s] != 0 ? "rattler image" : "disk image");
                }
            }
        }
    }
}

/// How far from the centre of an arc a force is drawn: as deep in the body as the smallest circle reaches. 0: no arc.
double arc_depth(const Packing& packing, const ArcBodies& arcs, int disk) {
    if (!arcs.angles(disk)) {
        return 0;
    }
    const auto ring = std::ranges::find_if(packing.arcs, [disk](const std::vector<int>& members) {
        return std::ranges::find(members, disk) != members.end();
    });
    double smallest = HUGE_VAL;
    for (const int member : *ring) {
        smallest = std::min(smallest, packing.radius[static_cast<std::size_t>(member)]);
    }
    return packing.radius[static_cast<std::size_t>(disk)] - smallest;
}

/// Width of the line of a force 1.
double width_of_force(const Canvas& canvas, const State& state, std::span<const double> forces) {
    constexpr double width_at_mean = 0.2; // of the mean radius
    double radius = 0;
    const ArcBodies arcs(state.packing);
    for (int i = 0; i < state.packing.disk_count(); ++i) {
        radius += (state.packing.radius[static_cast<std::size_t>(i)] - arc_depth(state.packing, arcs, i)) /
                  static_cast<double>(state.packing.radius.size());
    }
    return width_at_mean * radius * canvas.scale() / mean_force(forces);
}

Point towards(Point from, Point to, double length) {
    const double distance = std::hypot(to[0] - from[0], to[1] - from[1]);
    return {from[0] + (to[0] - from[0]) * length / distance, from[1] + (to[1] - from[1]) * length / distance};
}

void draw_contacts(Canvas& canvas, const State& state, std::span<const double> forces) {
    const ArcBodies arcs(state.packing);
    constexpr double hairline = 0.4;
    const double unit = width_of_force(canvas, state, forces);
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& contact = state.contacts[l];
        if (contact.kind == ContactKind::held) {
            continue;
        }
        const double force = forces.empty() ? 0 : forces[l];
        const bool pair = contact.of_disks();
        if (contact.kind == ContactKind::bar && arcs.angles(contact.i)) {
            continue;
        }
        Point end = end_of(state.packing, contact);
        Point start = centre_of(state.packing, contact.i);
        if (const double shift = arc_depth(state.packing, arcs, contact.i); shift > 0) {
            start = towards(start, end, shift);
        }
        if (const double shift = pair ? arc_depth(state.packing, arcs, contact.j) : 0; shift > 0) {
            end = towards(end, start, shift);
        }
        const char* const style = force == 0 ? "contact" : force < 0 ? "traction" : pair ? "force" : "force wall";
        const double width = force == 0 ? hairline : std::abs(force) * unit;
        canvas.line(start, end, width, style);
        if (!contact.image.is_here()) { // from the other side too
            const Point first = centre_of(state.packing, contact.i);
            const Point other = centre_of(state.packing, contact.j);
            canvas.line({first[0] - (end[0] - other[0]), first[1] - (end[1] - other[1])}, other, width, style);
        }
    }
}

/// Draws arrows outside the box that press on the movable walls, with their stresses.
void draw_stresses(Canvas& canvas, const State& state) {
    constexpr double length = 34; // picture units
    constexpr double head = 9;
    const auto& walls = state.packing.walls;
    const double unit = 1 / canvas.scale();
    for (int axis = 0; axis < 2; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (walls.upper[a] != WallKind::movable || state.load.stress[a] == 0) {
            continue;
        }
        const double out = state.load.stress[a] > 0 ? 1 : -1; // a traction pulls
        const auto at = [&](double along, double beyond) {
            const Point p{along, state.packing.length(axis) + beyond * unit};
            return axis == 1 ? p : Point{p[1], p[0]};
        };
        for (const double part : {0.2, 0.5, 0.8}) {
            const double along = part * state.packing.length(1 - axis);
            const double tip = out > 0 ? wall_width + 2 : wall_width + 2 + length;
            canvas.line(at(along, wall_width + 2), at(along, wall_width + 2 + length), 2.5, "stress");
            for (const double side : {-0.5, 0.5}) {
                canvas.line(at(along, tip), at(along + side * head * unit, tip + out * head), 2.5, "stress");
            }
        }
        canvas.text(at(0.5 * state.packing.length(1 - axis) + 14 * unit, wall_width + length / 2),
                    fmt::format("\u03c3{} = {:.6g}", axis == 0 ? "\u2081" : "\u2082", state.load.stress[a]));
    }
}

/// Draws lines of known forces below the box.
void draw_scale(Canvas& canvas, const State& state, std::span<const double> forces) {
    const double unit = width_of_force(canvas, state, forces);
    const double mean = mean_force(forces);
    double at = canvas.low()[0];
    for (const double times : {1.0, 3.0}) {
        const double low = canvas.low()[1] - 34 / canvas.scale();
        canvas.line({at, low}, {at + 60 / canvas.scale(), low}, times * mean * unit, "force scale");
        at += 70 / canvas.scale();
        const std::string name = times == 1 ? "mean force" : "3 times";
        canvas.text({at, low - 6 / canvas.scale()}, fmt::format("{}: {:.3g}", name, times * mean));
        at += 190 / canvas.scale();
    }
}

} // namespace

std::vector<unsigned char> rattler_flags(const State& state, std::span<const double> forces) {
    assert(forces.empty() || forces.size() == state.contacts.size());
    const Bodies bodies(state.packing);
    std::vector<unsigned char> flags(state.packing.radius.size(), forces.empty() ? 0 : 1);
    for (std::size_t l = 0; l < forces.size(); ++l) {
        const Contact& contact = state.contacts[l];
        if (forces[l] == 0 || !contact.is_unilateral()) {
            continue;
        }
        flags[static_cast<std::size_t>(bodies.of(contact.i))] = 0;
        if (contact.of_disks()) {
            flags[static_cast<std::size_t>(bodies.of(contact.j))] = 0;
        }
    }
    for (int i = 0; i < state.packing.disk_count(); ++i) {
        flags[static_cast<std::size_t>(i)] = flags[static_cast<std::size_t>(bodies.of(i))];
    }
    return flags;
}

std::string force_picture(const State& stored, std::span<const double> forces, const std::string& caption) {
    const State state = in_cell(stored);
    Canvas canvas(state);
    draw_disks(canvas, state, rattler_flags(state, forces));
    draw_contacts(canvas, state, forces);
    draw_walls(canvas, state);
    draw_cell(canvas, state.packing);
    draw_stresses(canvas, state);
    if (!forces.empty()) {
        draw_scale(canvas, state, forces);
    }
    constexpr double border = 20;
    constexpr double above = 56;  // the box, for arrows
    constexpr double right = 150; // to the right of the box, for arrows and their stress
    constexpr double below = 84;  // for scale and caption
    const double width = 1000 + border + right;
    const double height = canvas.height() + above + below;
    std::string text = fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- forces by isostat -->\n<svg "
                                   "xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" "
                                   "height=\"{:.0f}\" viewBox=\"{:.0f} {:.0f} {:.0f} {:.0f}\">\n",
                                   width, height, -border, -above, width, height);
    text +=
        "<style>.disk{fill:#e9e6df;stroke:#a9a59b;stroke-width:0.5}.rattler{fill:#9fb8cf;stroke:#6f89a3;stroke-width:0."
        "5}"
        ".force{stroke:#8c1c13;stroke-linecap:round}.wall,.scale{stroke-linecap:butt}"
        ".traction{stroke:#1b5fbf;stroke-dasharray:6 3}.contact{stroke:#777}.stress{stroke:#222;stroke-linecap:round}"
        ".fixed{stroke:#222;stroke-linecap:square}.movable{stroke:#8f8f8f;stroke-linecap:square}"
        "text{font-family:sans-serif;font-size:20px;fill:#222}";
    if (state.packing.cell.any()) {
        text += ".image{opacity:0.4}.cell{stroke:#222;stroke-dasharray:12 8}";
    }
    text += "</style>\n";
    text += fmt::format(
        "<title>{}</title>\n<rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#ffffff\"/>\n",
        text::markup(caption), -border, -above, width, height);
    text += canvas.take();
    text += fmt::format("<text x=\"0\" y=\"{:.0f}\">{}</text>\n</svg>\n", canvas.height() + below - 16,
                        text::markup(caption));
    return text;
}

} // namespace isostat
