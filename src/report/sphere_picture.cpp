#include "io/json.hpp"
#include "io/text.hpp"
#include "packing/cell_wrap.hpp"
#include "report/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

namespace isostat {

namespace {

using Place = PerAxis<double>;

constexpr double margin = 20;
constexpr double heading = 34; // space above a panel

/// A sphere or an image of a sphere.
struct Ball {
    Place at;
    double radius;
    bool rattler;
};

/// Spheres in their cell, seen along y or cut at a height, in arbitrary units.
class Drawing {
  public:
    Drawing(State state, std::span<const double> forces) : state_(in_cell(std::move(state))), forces_(forces) {
        const Packing& packing = state_.packing;
        const std::vector<unsigned char> rattler = rattler_flags(state_, forces);
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            balls_.push_back({centre_of(packing, static_cast<int>(i)), packing.radius[i], rattler[i] != 0});
        }
        find_extent();
    }

    /// Width over height of a panel whose horizontal axis is x.
    [[nodiscard]] double aspect(std::size_t up) const { return (high_[0] - low_[0]) / (high_[up] - low_[up]); }

    /// The spheres from the farthest to the nearest.
    [[nodiscard]] std::string seen_along_y(double width) const {
        std::vector<std::size_t> order(balls_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, [this](std::size_t a, std::size_t b) { return balls_[a].at[1] > balls_[b].at[1]; });
        std::string text;
        for (const std::size_t i : order) {
            const Ball& ball = balls_[i];
            const double depth = (ball.at[1] - low_[1]) / (high_[1] - low_[1]); // 0 for the nearest
            const int light = 245 - static_cast<int>(std::lround(75 * std::clamp(depth, 0.0, 1.0)));
            text += circle(ball, 2, width, ball.radius,
                           ball.rattler ? fmt::format("rgb({},{},{})", light - 60, light - 30, light)
                                        : fmt::format("rgb({},{},{})", light, light - 4, light - 12));
        }
        return text;
    }

    /// Lines from centre to centre, or to the wall, with widths proportional to the forces; rattlers in blue.
    [[nodiscard]] std::string forces(double width) const {
        const double mean = mean_force(forces_);
        double radius = 0;
        std::string text;
        for (const Ball& ball : balls_) {
            radius += ball.radius / static_cast<double>(balls_.size());
            text += ball.rattler ? circle(ball, 2, width, ball.radius, "#cfdbe6") : "";
        }
        for (std::size_t l = 0; l < state_.contacts.size(); ++l) {
            const Contact& contact = state_.contacts[l];
            if (contact.kind == ContactKind::held) {
                continue;
            }
            const double force = forces_.empty() ? 0 : forces_[l];
            const Place from = balls_[static_cast<std::size_t>(contact.i)].at, to = end_of(state_.packing, contact);
            const double thickness = 0.1 * radius * scale(width) * std::abs(force) / mean;
            text += fmt::format("<line class=\"{}\" x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" "
                                "stroke-width=\"{:.2f}\"/>\n",
                                force == 0  ? "contact"
                                : force > 0 ? "force"
                                            : "traction",
                                x(from, width), y(from, 2, width), x(to, width), y(to, 2, width),
                                force == 0 ? 0.6 : std::max(0.3, thickness));
        }
        return text;
    }

    /// The cut of a horizontal plane through spheres and images, within the cell. `name`: of the clip path.
    [[nodiscard]] std::string slice(double share, double width, const std::string& name) const {
        const Packing& packing = state_.packing;
        const double height = share * packing.length(2);
        const bool lean = packing.cell.any();
        const auto side = [&](std::size_t a, std::size_t b) { return a == b || lean ? entry(a, b) : 0; };
        const Place corner{share * side(0, 2), share * side(1, 2), height};
        const Place across{side(0, 0), 0, 0}, up{side(0, 1), side(1, 1), 0};
        std::string outline;
        for (const auto& [s, t] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
            const Place p{corner[0] + s * across[0] + t * up[0], corner[1] + t * up[1], height};
            outline += fmt::format("{:.2f},{:.2f} ", x(p, width), y(p, 1, width));
        }
        std::string text = fmt::format("<clipPath id=\"{0}\"><polygon points=\"{1}\"/></clipPath>\n"
                                       "<g clip-path=\"url(#{0})\">\n",
                                       name, outline);
        for (const Ball& ball : balls_) {
            for_each_image([&](const PerAxis<double>& m) {
                Ball image = ball;
                add_periods(image.at, packing, m);
                const double off = image.at[2] - height;
                if (std::abs(off) < ball.radius) {
                    text += circle(image, 1, width, std::sqrt((ball.radius - off) * (ball.radius + off)),
                                   ball.rattler ? "#9fb8cf" : "#e9e6df");
                }
            });
        }
        return text + fmt::format("</g>\n<polygon class=\"cell\" points=\"{}\"/>\n", outline);
    }

    /// The data of a view in space, see `sphere_view`.
    [[nodiscard]] json::Json numbers() const {
        using json::Json;
        const auto put = [](Json& list, const Place& at) {
            for (const double x : at) {
                list.push_back(rounded(x, 6));
            }
        };
        Json all;
        all["equilibrium"] = state_.equilibrium;
        for (const char* name : {"centre", "balls", "lines", "edges"}) {
            all[name] = Json::array();
        }
        double reach = 0, radius = 0;
        for (std::size_t a = 0; a < low_.size(); ++a) {
            all["centre"].push_back(rounded((low_[a] + high_[a]) / 2, 6));
            reach = std::hypot(reach, (high_[a] - low_[a]) / 2);
        }
        for (const Ball& ball : balls_) {
            Json& row = all["balls"].emplace_back(Json::array());
            put(row, ball.at);
            row.push_back(rounded(ball.radius, 6));
            row.push_back(ball.rattler ? 1 : 0);
            radius += ball.radius / static_cast<double>(balls_.size());
        }
        all["reach"] = reach;
        all["radius"] = radius;
        const double mean = mean_force(forces_);
        for (std::size_t l = 0; l < state_.contacts.size(); ++l) {
            const Contact& contact = state_.contacts[l];
            if (contact.kind != ContactKind::held) {
                Json& row = all["lines"].emplace_back(Json::array());
                put(row, balls_[static_cast<std::size_t>(contact.i)].at);
                put(row, end_of(state_.packing, contact));
                row.push_back(forces_.empty() ? 0 : rounded(forces_[l] / mean, 3));
            }
        }
        for_each_edge([&](const Place& from, const Place& to) {
            Json& row = all["edges"].emplace_back(Json::array());
            put(row, from);
            put(row, to);
        });
        return all;
    }

    /// The edges of the box or cell.
    [[nodiscard]] std::string edges(double width) const {
        std::string text;
        for_each_edge([&](const Place& from, const Place& to) {
            text += fmt::format("<line class=\"cell\" x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\"/>\n",
                                x(from, width), y(from, 2, width), x(to, width), y(to, 2, width));
        });
        return text;
    }

  private:
    /// The value rounded to so many digits.
    [[nodiscard]] static double rounded(double value, int digits) {
        return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr); // throws no exception at 1e-310
    }
    template <class Visit> void for_each_edge(Visit visit) const {
        for (unsigned bits = 0; bits < 8; ++bits) {
            for (unsigned a = 0; a < 3; ++a) {
                if ((bits >> a & 1U) == 0) {
                    visit(corner(state_.packing, bits), corner(state_.packing, bits | 1U << a));
                }
            }
        }
    }
    [[nodiscard]] double entry(std::size_t a, std::size_t b) const { return state_.packing.lattice(a, b); }
    template <class Visit> void for_each_image(Visit visit) const {
        const auto& periodic = state_.packing.cell.periodic;
        for (int m = 0; m < 27; ++m) {
            const std::array<int, most_axes> times{m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1};
            PerAxis<double> periods{};
            std::ranges::copy(times, periods.begin());
            bool there = true;
            for (std::size_t a = 0; a < periods.size(); ++a) {
                there = there && (periods[a] == 0 || periodic[a]);
            }
            if (there) {
                visit(periods);
            }
        }
    }
    void find_extent() {
        low_.fill(HUGE_VAL);
        high_.fill(-HUGE_VAL);
        const auto show = [this](const Place& at, double room) {
            for (std::size_t a = 0; a < at.size(); ++a) {
                low_[a] = std::min(low_[a], at[a] - room);
                high_[a] = std::max(high_[a], at[a] + room);
            }
        };
        for (unsigned bits = 0; bits < 8; ++bits) {
            show(corner(state_.packing, bits), 0);
        }
        for (const Ball& ball : balls_) {
            show(ball.at, ball.radius);
        }
    }
    [[nodiscard]] double scale(double width) const { return width / (high_[0] - low_[0]); }
    [[nodiscard]] double x(const Place& at, double width) const { return (at[0] - low_[0]) * scale(width); }
    [[nodiscard]] double y(const Place& at, std::size_t up, double width) const {
        return (high_[up] - at[up]) * scale(width);
    }
    [[nodiscard]] std::string circle(const Ball& ball, std::size_t up, double width, double radius,
                                     const std::string& fill) const {
        return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" fill=\"{}\"/>\n", x(ball.at, width),
                           y(ball.at, up, width), radius * scale(width), fill);
    }

    State state_;
    std::span<const double> forces_;
    std::vector<Ball> balls_;
    Place low_{}, high_{};
};

} // namespace

std::string sphere_picture(const State& state, std::span<const double> forces, const std::string& caption) {
    constexpr double width = 480, narrow = 313; // widths of the two upper panels, and of three slices
    const Drawing drawing(state, forces);
    const double upper = width / drawing.aspect(2), lower = narrow / drawing.aspect(1);
    const double total = 2 * width + 3 * margin, down = heading + upper + heading;
    const double height = down + lower + 2 * heading;
    std::string text = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- spheres by isostat -->\n<svg "
        "xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\">\n"
        "<style>circle{{stroke:#8b877d;stroke-width:0.5}}.force{{stroke:#8c1c13;stroke-linecap:round}}.traction{{"
        "stroke:"
        "#1b5fbf;stroke-dasharray:6 3}}.contact{{stroke:#777}}.cell{{stroke:#222;stroke-dasharray:8 5;fill:none}}"
        "text{{font-family:sans-serif;font-size:16px;fill:#222}}</style>\n<title>{2}</title>\n"
        "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
        total, height, text::markup(caption));
    const auto panel = [&text](double x, double y, double wide, double tall, const std::string& title,
                               const std::string& content) {
        text += fmt::format("<text x=\"{0:.1f}\" y=\"{1:.1f}\">{2}</text>\n<svg x=\"{0:.1f}\" y=\"{3:.1f}\" "
                            "width=\"{4:.1f}\" height=\"{5:.1f}\">\n{6}</svg>\n",
                            x, y - 8, title, y, wide, tall, content);
    };
    const std::string edges = drawing.edges(width);
    panel(margin, heading, width, upper, "seen along y (rattlers blue)", drawing.seen_along_y(width) + edges);
    panel(width + 2 * margin, heading, width, upper, "forces, seen along y", drawing.forces(width) + edges);
    int place = 0;
    for (const double share : {0.25, 0.5, 0.75}) {
        panel(margin + place * (narrow + margin), down, narrow, lower,
              fmt::format("cut at z = {} of the height", share),
              drawing.slice(share, narrow, fmt::format("cut{}", place)));
        ++place;
    }
    return text +
           fmt::format("<text x=\"{}\" y=\"{:.0f}\">{}</text>\n</svg>\n", margin, height - 16, text::markup(caption));
}

json::Json sphere_view(const State& state, std::span<const double> forces) {
    return Drawing(state, forces).numbers();
}

} // namespace isostat
