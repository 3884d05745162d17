#include "report/triaxial.hpp"

#include "io/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace isostat {

namespace {

using Points = std::vector<std::pair<double, double>>;

constexpr std::array<const char*, 4> hues{"#1f4e79", "#c55a11", "#548235", "#7b3f99"};

/// Per segment: at constant structure the stress moves, at constant stress the strain jumps.
struct Branch {
    std::string title;
    std::vector<TriaxialPoint> points; ///< the one that it starts from, and its own
    [[nodiscard]] Points stairs() const {
        Points all;
        for (const TriaxialPoint& at : points) {
            if (!all.empty()) {
                all.emplace_back(all.back().first, at.q / at.p);
            }
            all.emplace_back(at.axial, at.q / at.p);
        }
        return all;
    }
    [[nodiscard]] Points volume() const {
        Points all;
        for (const TriaxialPoint& at : points) {
            all.emplace_back(at.axial, at.volumetric);
        }
        return all;
    }
};

std::vector<Branch> branches_of(std::span<const TriaxialPoint> points, const std::vector<std::string>& names) {
    std::vector<Branch> all;
    int segment = -1;
    for (const TriaxialPoint& at : points) {
        if (at.segment != segment) {
            segment = at.segment;
            const auto s = static_cast<std::size_t>(segment);
            all.push_back({s < names.size() ? names[s] : fmt::format("segment {}", segment + 1), {}});
            const auto before = std::find_if(points.begin(), points.end(),
                                             [&](const TriaxialPoint& other) { return other.number == at.previous; });
            if (before != points.end()) {
                all.back().points.push_back(*before);
            }
        }
        all.back().points.push_back(at);
    }
    return all;
}

/// Curves in a frame with its ticks, as SVG.
class Plot {
  public:
    void add(const Points& curve, const std::string& title) {
        for (const auto& [x, y] : curve) {
            low_x_ = std::min(low_x_, x);
            high_x_ = std::max(high_x_, x);
            low_y_ = std::min(low_y_, y);
            high_y_ = std::max(high_y_, y);
        }
        curves_.emplace_back(title, curve);
    }
    [[nodiscard]] std::string svg(const std::string& x_label, const std::string& y_label) const {
        std::string text = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} against {}\">\n<rect "
                                       "x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888\"/>\n",
                                       width, height, y_label, x_label, left, top, across, up);
        constexpr int ticks = 4;
        for (int k = 0; k <= ticks; ++k) {
            const double part = static_cast<double>(k) / ticks;
            text += label(left + part * across, top + up + 18, "middle",
                          fmt::format("{:.3g}", low_x_ + part * (high_x_ - low_x_)));
            text += label(left - 6, top + (1 - part) * up + 4, "end",
                          fmt::format("{:.3g}", low_y_ + part * (high_y_ - low_y_)));
        }
        for (std::size_t k = 0; k < curves_.size(); ++k) {
            std::string line;
            for (const auto& [x, y] : curves_[k].second) {
                line += fmt::format("{:.2f},{:.2f} ", left + across * share(x, low_x_, high_x_),
                                    top + up * (1 - share(y, low_y_, high_y_)));
            }
            text += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"><title>{}"
                                "</title></polyline>\n",
                                line, hues[k % hues.size()], text::markup(curves_[k].first));
        }
        return text + label(left + across / 2, height - 6, "middle", x_label) + label(left, top - 8, "start", y_label) +
               "</svg>\n";
    }

  private:
    static constexpr double width = 520, height = 360, left = 70, top = 30, across = 430, up = 270;
    static double share(double x, double low, double high) { return high > low ? (x - low) / (high - low) : 0.5; }
    static std::string label(double x, double y, const char* anchor, const std::string& text) {
        return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"12\">{}</text>\n", x, y,
                           anchor, text);
    }
    std::vector<std::pair<std::string, Points>> curves_;
    double low_x_ = HUGE_VAL, high_x_ = -HUGE_VAL, low_y_ = HUGE_VAL, high_y_ = -HUGE_VAL;
};

std::string table_of(std::span<const TriaxialPoint> points, std::span<const EquilibriumRow> rows,
                     const LoadWords& words) {
    std::string text =
        fmt::format("<table><thead><tr><th>equilibrium</th><th>segment</th><th>{}</th><th>p</th><th>q</th>"
                    "<th>q/p</th><th>axial strain</th><th>volumetric strain</th><th>solid fraction</th>"
                    "<th>arcs</th><th>rattlers</th><th>h</th><th>proved</th></tr></thead><tbody>\n",
                    words.ratio_sign);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const TriaxialPoint& at = points[k];
        const EquilibriumRow& row = rows[k];
        text += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.9g}</td><td>{:.6g}</td><td>{:.6g}</td><td>{:.6f}</td>"
                            "<td>{:.5e}</td><td>{:.5e}</td><td>{:.6f}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
                            "</tr>\n",
                            at.number, at.segment + 1, row.ratio, at.p, at.q, at.q / at.p, at.axial, at.volumetric,
                            row.solid_fraction, row.arcs, row.rattlers, row.hyperstaticity, row.proved ? "yes" : "no");
    }
    return text + "</tbody></table>\n";
}

/// A picture in an address: names in it are its own.
std::string in_address(const std::string& svg) {
    std::string text;
    for (const char c : svg) {
        const bool plain = std::string_view("%#\"<>&\n").find(c) == std::string_view::npos;
        text += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return text;
}

constexpr const char* page_head =
    "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
    "http-equiv=\"Content-Security-Policy\" "
    "content=\"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src "
    "data:\">\n<title>Isostat</title>\n"
    "<style>body{font:15px sans-serif;max-width:1100px;margin:1em auto;padding:0 1em}svg,img{width:100%;height:auto}"
    ".panels{display:grid;grid-template-columns:1fr 1fr;gap:1em}table{border-collapse:collapse;font-size:13px}"
    "td,th{padding:2px 8px;text-align:right;border-bottom:1px solid #ddd}</style>\n</head>\n<body>\n<h1>Isostat</h1>\n";

constexpr const char* page_script =
    "<script>\nconst all=[...document.querySelectorAll('.state')],slider=document.getElementById('which');\n"
    "const show=()=>all.forEach((one,k)=>one.hidden=k!==Number(slider.value));\n"
    "if(slider){slider.oninput=show;show()}\n</script>\n";

} // namespace

std::vector<TriaxialPoint> triaxial_points(std::span<const EquilibriumRow> rows, Load load) {
    std::vector<TriaxialPoint> points;
    for (const EquilibriumRow& row : rows) {
        load.set_loaded_stress(row.stress);
        TriaxialPoint at{row.number, row.segment, row.previous, 0, 0, load.mean_stress(), load.deviator()};
        for (std::size_t a = 0; a < row.length.size(); ++a) {
            at.axial = std::log(load.reference_length[a] / row.length[a]); // the last one stays
            at.volumetric += at.axial;
        }
        points.push_back(at);
    }
    return points;
}

Chart triaxial_chart(std::span<const TriaxialPoint> points, const std::vector<std::string>& names, bool pdf) {
    Chart chart;
    chart.name = "triaxial";
    std::string ratio;
    std::string volume;
    const std::vector<Branch> branches = branches_of(points, names);
    for (std::size_t k = 0; k < branches.size(); ++k) {
        chart.data += fmt::format("# {}\n# number axial_strain volumetric_strain p q q/p sin_phi\n",
                                  text::shown(branches[k].title));
        for (const TriaxialPoint& at : branches[k].points) {
            // (s3 - s1) / (s3 + s1) where the lateral stresses are one: s3 = p + 2q/3, s1 = p - q/3.
            chart.data += fmt::format("{} {} {} {} {} {} {}\n", at.number, at.axial, at.volumetric, at.p, at.q,
                                      at.q / at.p, at.q / (2 * at.p + at.q / 3));
        }
        chart.data += "\n\n";
        const auto curve = [&](std::string& plot, const char* columns, const char* style) {
            plot += fmt::format("{} {} index {} using {} with {} lw 1.5 dt {} lc rgb {} title {} noenhanced",
                                plot.empty() ? "plot" : ",\\\n    ", text::gnuplot("triaxial.dat"), k, columns, style,
                                k % 5 + 1, text::gnuplot(hues[k % hues.size()]), text::gnuplot(branches[k].title));
        };
        curve(ratio, "2:6", "fsteps");
        curve(volume, "2:3", "linespoints pt 7 ps 0.3");
    }
    chart.script = chart_script(
        chart.name, 1100, 480,
        fmt::format("set multiplot layout 1,2\nset grid lc rgb \"#dddddd\"\nset format x \"%g\"\nset xlabel \"axial "
                    "strain ln(L_{{3,0}}/L_3)\"\nset ylabel \"q/p\"\nset key bottom right\n{}\nset ylabel "
                    "\"volumetric strain ln(V_0/V)\"\n{}\nunset multiplot\n",
                    ratio, volume),
        pdf);
    return chart;
}

std::string triaxial_page(std::span<const TriaxialPoint> points, std::span<const EquilibriumRow> rows,
                          const std::vector<std::string>& names, const LoadWords& words, const std::string& title,
                          std::span<const std::pair<int, std::string>> pictures) {
    Plot ratio;
    Plot volume;
    for (const Branch& branch : branches_of(points, names)) {
        ratio.add(branch.stairs(), branch.title);
        volume.add(branch.volume(), branch.title);
    }
    std::string text = page_head + fmt::format("<p>{}</p>\n<div class=\"panels\">\n", text::markup(title));
    text += ratio.svg("axial strain ln(L₃,₀/L₃)", "q/p") +
            volume.svg("axial strain ln(L₃,₀/L₃)", "volumetric strain ln(V₀/V)");
    text += "</div>\n";
    if (!pictures.empty()) {
        text +=
            fmt::format("<p><label>stored state <input id=\"which\" type=\"range\" min=\"0\" max=\"{}\" value=\"{}\">"
                        "</label></p>\n",
                        pictures.size() - 1, pictures.size() - 1);
    }
    for (const auto& [number, svg] : pictures) {
        text += fmt::format("<figure class=\"state\"><figcaption>equilibrium {0}</figcaption>\n<img alt=\"equilibrium "
                            "{0}\" src=\"data:image/svg+xml,{1}\"></figure>\n",
                            number, in_address(svg));
    }
    return text + table_of(points, rows, words) + page_script + "</body>\n</html>\n";
}

} // namespace isostat
