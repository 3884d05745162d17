#include "io/text.hpp"
#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace isostat {

extern const char* const spheres_template; ///< source of the page, with placeholders for its parts

namespace {

using Polyline = std::vector<std::pair<double, double>>;

/// Curves in a frame with ticks, as SVG.
class Plot {
  public:
    void add(const Polyline& curve, const std::string& title) {
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
        const auto number = [](double value, double size) { // rounding noise is shown as 0
            return fmt::format("{:.3g}", std::abs(value) < 1e-9 * size ? 0 : value);
        };
        for (int k = 0; k <= ticks; ++k) {
            const double part = static_cast<double>(k) / ticks;
            const double wide = high_x_ - low_x_, tall = high_y_ - low_y_;
            text += label(left + part * across, top + up + 18, "middle", number(low_x_ + part * wide, wide));
            text += label(left - 6, top + (1 - part) * up + 4, "end", number(low_y_ + part * tall, tall));
        }
        for (std::size_t k = 0; k < curves_.size(); ++k) {
            std::string line;
            for (const auto& [x, y] : curves_[k].second) {
                line += fmt::format("{:.2f},{:.2f} ", left + across * share(x, low_x_, high_x_),
                                    top + up * (1 - share(y, low_y_, high_y_)));
            }
            text += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"><title>{}"
                                "</title></polyline>\n",
                                line, chart_hues[k % chart_hues.size()], text::markup(curves_[k].first));
        }
        return text + label(left + across / 2, height - 6, "middle", x_label) + label(left, top - 8, "start", y_label) +
               "</svg>\n";
    }

  private:
    static constexpr double width = 540, height = 360, left = 70, top = 30, across = 430, up = 270;
    static double share(double x, double low, double high) { return high > low ? (x - low) / (high - low) : 0.5; }
    static std::string label(double x, double y, const char* anchor, const std::string& text) {
        return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"12\">{}</text>\n", x, y,
                           anchor, text);
    }
    std::vector<std::pair<std::string, Polyline>> curves_;
    double low_x_ = HUGE_VAL, high_x_ = -HUGE_VAL, low_y_ = HUGE_VAL, high_y_ = -HUGE_VAL;
};

std::string table_of(const SphereRun& run) {
    std::string text =
        fmt::format("<table><thead><tr><th>equilibrium</th><th>segment</th><th>{}</th><th>p</th><th>q</th>"
                    "<th>q/p</th><th>axial strain</th><th>volumetric strain</th><th>solid fraction</th>"
                    "<th>arcs</th><th>rattlers</th><th>h</th><th>proved</th></tr></thead><tbody>\n",
                    load_words(run.load).ratio_sign);
    const std::vector<TriaxialPoint> points = triaxial_points(run.rows, run.load);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const TriaxialPoint& at = points[k];
        const EquilibriumRow& row = run.rows[k];
        text += fmt::format("<tr><td>{}</td><td>{}</td><td>{:.9g}</td><td>{:.6g}</td><td>{:.6g}</td><td>{:.6f}</td>"
                            "<td>{:.5e}</td><td>{:.5e}</td><td>{:.6f}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
                            "</tr>\n",
                            at.number, row.segment + 1, row.ratio, at.p, at.q, at.q / at.p, at.axial, at.volumetric,
                            row.solid_fraction, row.arcs, row.rattlers, row.hyperstaticity, row.proved ? "yes" : "no");
    }
    return text + "</tbody></table>\n";
}

/// The template with each placeholder replaced by its text; placeholders inside a text are not replaced.
std::string filled(std::string_view source, std::initializer_list<std::pair<std::string_view, std::string>> parts) {
    std::string page;
    std::size_t from = 0;
    for (const auto& [place, text] : parts) {
        const std::size_t at = source.find(place, from);
        page.append(source.substr(from, at - from)).append(text);
        from = at + place.size();
    }
    return page.append(source.substr(from));
}

} // namespace

std::string sphere_page(const std::string& title, const json::Json& states, const SphereRun& run) {
    std::string plots;
    if (run.triaxial) {
        Plot ratio;
        Plot volume;
        for (const TriaxialBranch& branch : triaxial_branches(run.rows, run.load, run.names)) {
            ratio.add(branch.stairs(), branch.title);
            volume.add(branch.volume(), branch.title);
        }
        plots = "<div class=\"panels\">\n" + ratio.svg("axial strain ln(L₃,₀/L₃)", "q/p") +
                volume.svg("axial strain ln(L₃,₀/L₃)", "volumetric strain ln(V₀/V)") + "</div>\n";
    }
    return filled(spheres_template, {{"@TITLE@", text::markup(title)},
                                     {"@PLOTS@", plots},
                                     {"@TABLE@", run.rows.empty() ? "" : table_of(run)},
                                     {"@DATA@", text::in_script(json::dumped(states))}});
}

} // namespace isostat
