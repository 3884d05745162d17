#include "report/charts.hpp"

#include "io/text.hpp"
#include "packing/words.hpp"
#include "report/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace isostat {

namespace {

/// Dash of curve k, because colours are lost in a grey print. 1 is a full line.
std::size_t dash(std::size_t k) {
    constexpr std::size_t dashes = 5; // of gnuplot
    return k % dashes + 1;
}

void append_points(std::string& data, const std::string& title, const std::vector<std::pair<double, double>>& points) {
    data += fmt::format("# {}\n", text::shown(title));
    for (const auto& [x, y] : points) {
        data += fmt::format("{} {}\n", x, y);
    }
    data += "\n\n";
}

/// (eps2, ratio) along a path: the stress changes at constant structure, and the strain jumps at constant stress.
std::vector<std::pair<double, double>> stairs(const std::vector<EquilibriumRow>& path) {
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < path.size(); ++k) {
        if (k > 0) {
            points.emplace_back(path[k - 1].strain2, path[k].ratio);
        }
        points.emplace_back(path[k].strain2, path[k].ratio);
    }
    return points;
}

Chart stairs_chart(const std::string& name, const std::vector<SegmentPath>& curves, const LoadWords& words, bool pdf) {
    Chart chart;
    chart.name = name;
    std::string plot;
    for (std::size_t k = 0; k < curves.size(); ++k) {
        append_points(chart.data, fmt::format("{} {}: {}", words.strain, words.ratio, curves[k].title),
                      stairs(curves[k].rows));
        plot += fmt::format("{} {} index {} with lines lw 1.5 dt {} lc rgb {} title {} noenhanced",
                            k == 0 ? "plot" : ",\\\n    ", text::gnuplot(name + ".dat"), k, dash(k),
                            text::gnuplot(chart_hues[k % chart_hues.size()]), text::gnuplot(curves[k].title));
    }
    chart.script = chart_script(
        name, 800, 560,
        fmt::format("set xlabel {}\nset ylabel {}\n", text::gnuplot(words.strain_axis),
                    text::gnuplot(words.ratio_axis)) +
            "set key top left reverse Left\nset format x \"%g\"\nset autoscale xfixmin\nset grid back lt 1 lw 0.5 lc "
            "rgb \"#cccccc\"\n" +
            plot + "\n",
        pdf);
    return chart;
}

/// Whether the first equilibrium of a segment does not follow the previous one, so that the path branches.
bool branches(const std::vector<EquilibriumRow>& rows, const std::vector<EquilibriumRow>& path) {
    const auto first = std::ranges::find_if(rows, [&](const auto& r) { return r.number == path[1].number; });
    return first != rows.begin() && (first - 1)->number != path.front().number;
}

void add_stairs(std::vector<Chart>& charts, const std::vector<EquilibriumRow>& rows,
                const std::vector<std::string>& names, const LoadWords& words, bool pdf) {
    std::vector<SegmentPath> main_path;
    std::vector<SegmentPath> cycles;
    int highest_branch = -1;
    for (auto& [segment, path] : segment_paths(rows, names)) {
        if (path.rows.size() < 2) {
            continue;
        }
        const int start = path.rows.front().number;
        const bool branch =
            branches(rows, path.rows) || (!cycles.empty() && main_path.back().rows.back().number != start);
        if (branch) {
            highest_branch = std::max(highest_branch, start);
        }
        (branch ? cycles : main_path).push_back(std::move(path));
    }
    if (!main_path.empty()) {
        charts.push_back(stairs_chart("staircase", main_path, words, pdf));
    }
    if (!cycles.empty()) {
        cycles.insert(cycles.begin(),
                      {fmt::format("path to equilibrium {}", highest_branch), path_to(rows, highest_branch)});
        charts.push_back(stairs_chart("cycles", cycles, words, pdf));
    }
}

struct Distribution {
    std::string name, label;
    bool power_law;
};

/// The script of both panels; `left` and `right` are their plot commands.
std::string two_panels(const std::string& label, bool power_law, const std::string& left, const std::string& right) {
    const std::string x = text::gnuplot(label);
    const std::string x_left = power_law ? text::gnuplot("log_{10} " + label) : x;
    std::string body = "set multiplot layout 1,2\nset xtics font \",11\" rotate by -30\nset key outside below samplen "
                       "2 font \",11\"\nset grid lc rgb "
                       "\"#dddddd\"\nset yrange [0:*]\n";
    body += fmt::format("set xlabel {}\nset ylabel \"density\"\n{}\n", x_left, left);
    body += fmt::format("set xlabel {}\nset ylabel \"share of the values ≥ x\"\nset logscale y\nset "
                        "yrange [*:1.5]\nset format y "
                        "\"10^{{%L}}\"\n{}{}\nunset multiplot\n",
                        x, power_law ? "set logscale x\nset format x \"10^{%L}\"\n" : "", right);
    return body;
}

/// Two panels: histogram, and complementary distribution with logarithmic scales.
void add_distribution(std::vector<Chart>& charts, const Distribution& of, const Increments& increments,
                      const LoadWords& words, bool pdf) {
    const auto& [name, label, power_law] = of;
    constexpr std::size_t fewest = 3;
    Chart chart;
    chart.name = name;
    std::string left;
    std::string right;
    int index = 0;
    const std::array<std::pair<const char*, const std::vector<double>*>, 2> kinds{
        {{words.rising.c_str(), &increments.loading}, {words.falling.c_str(), &increments.unloading}}};
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const std::vector<double>& values = *kinds[k].second;
        if (values.size() < fewest) {
            continue;
        }
        std::vector<double> shown = values;
        if (power_law) {
            std::ranges::transform(values, shown.begin(), [](double v) { return std::log10(v); });
        }
        const auto [low, high] = std::ranges::minmax_element(shown);
        const double from = power_law ? *low : 0;
        if (!(*high > from)) {
            continue;
        }
        const double average = mean(values);
        const int bins = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(values.size()))), 4, 30);
        append_points(chart.data, fmt::format("{}, {}: centre density", label, kinds[k].first),
                      histogram(shown, from, *high, bins));
        std::vector<std::pair<double, double>> tail = complementary_distribution(values);
        append_points(chart.data,
                      fmt::format("{}, {}: value, share of the values that are not smaller", label, kinds[k].first),
                      tail);
        const std::string title = fmt::format("{}: {} values, mean {:.3g}", kinds[k].first, values.size(), average);
        const auto curve = [&](std::string& plot, int block, const char* style) {
            plot += fmt::format("{} {} index {} with {} lw 1.5 dt {} lc rgb {} title {}",
                                plot.empty() ? "plot" : ",\\\n    ", text::gnuplot(name + ".dat"), block, style,
                                2 * k + 1, text::gnuplot(chart_hues[k]), text::gnuplot(title));
        };
        curve(left, index, "histeps");
        curve(right, index + 1, "fsteps");
        if (!power_law) {
            right += fmt::format(",\\\n     exp(-x/{}) dt 2 lc rgb {} title \"exponential of the same mean\"", average,
                                 text::gnuplot(chart_hues[k]));
        }
        index += 2;
    }
    if (index == 0) {
        return;
    }
    const std::string body = two_panels(label, power_law, left, right);
    chart.script = chart_script(name, 1100, 480, body, pdf);
    charts.push_back(std::move(chart));
}

} // namespace

LoadWords load_words(const Load& load) {
    if (load.path) {
        return {"t/p0",
                load.strain_name(),
                "t rises",
                "t falls",
                "way in stress space t/p_0",
                "axial strain ε_3",
                "increment of Δt/p_0",
                "strain increment Δε_3",
                "t/p₀",
                "ε₃",
                "ε₁",
                "t"};
    }
    constexpr std::array numbers{"₁", "₂", "₃"};
    const bool in_plane = load.dimension == plane, shear = load.loads_tilt();
    // In the plane the loaded axis is the second one by name, and there is one tilt.
    const auto axis = static_cast<std::size_t>(in_plane ? 1 : load.loaded_axis);
    const auto other = static_cast<std::size_t>(in_plane && !shear ? 0 : load.other_axis());
    const std::string of = !shear     ? fmt::format("_{}", axis + 1)
                           : in_plane ? ""
                                      : fmt::format("_{}", tilt_names[load.loaded_tilt()]);
    const std::string sign = shear ? of : numbers[axis];
    LoadWords words;
    words.ratio = load.ratio_name();
    words.strain = load.strain_name();
    words.rising = shear ? "shear up" : "loading";
    words.falling = shear ? "shear down" : "unloading";
    words.ratio_axis =
        fmt::format("{}{}/σ_{}", shear ? "shear stress over normal stress τ" : "stress ratio σ", of, other + 1);
    words.strain_axis = (shear ? "shear strain γ" : "axial strain ε") + of;
    words.ratio_step = fmt::format(
        "{}{}/σ_{}", shear ? "increment of the shear stress Δτ" : "increment of the stress ratio Δσ", of, other + 1);
    words.strain_step = (shear ? "increment of the shear strain Δγ" : "strain increment Δε") + of;
    words.stress_sign = (shear ? "τ" : "σ") + sign;
    words.ratio_sign = fmt::format("{}/σ{}", words.stress_sign, numbers[other]);
    words.strain_sign = (shear ? "γ" : "ε") + sign;
    words.other_strain = shear && in_plane ? "strain of the height" : fmt::format("ε{}", numbers[other]);
    return words;
}

std::string chart_script(const std::string& name, int width, int height, const std::string& body, bool pdf) {
    std::string script = "# gnuplot script; run it in this folder\n";
    std::vector<std::pair<std::string, std::string>> terminals{
        {"svg",
         fmt::format("set terminal svg size {},{} dynamic font \"sans,14\" background \"#ffffff\"", width, height)},
        {"png", fmt::format("set terminal pngcairo size {},{} font \"sans,14\"", width, height)}};
    if (pdf) {
        constexpr double pixels = 96; // per inch
        terminals.emplace_back("pdf", fmt::format("set terminal pdfcairo size {:.2f}in,{:.2f}in font \"sans,12\"",
                                                  width / pixels, height / pixels));
    }
    for (const auto& [suffix, terminal] : terminals) {
        script += fmt::format("reset\nset encoding utf8\n{}\nset output {}\n{}unset output\n", terminal,
                              text::gnuplot(fmt::format("{}.{}", name, suffix)), body);
    }
    return script;
}

std::vector<Chart> make_charts(const std::vector<EquilibriumRow>& rows, const std::vector<std::string>& names,
                               const LoadWords& words, bool pdf) {
    std::vector<Chart> charts;
    add_stairs(charts, rows, names, words, pdf);
    add_distribution(charts, {"stress_increments", words.ratio_step, false}, stress_increments(rows), words, pdf);
    add_distribution(charts, {"strain_increments", words.strain_step, true}, strain_increments(rows), words, pdf);
    return charts;
}

} // namespace isostat
