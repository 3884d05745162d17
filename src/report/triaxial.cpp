#include "report/triaxial.hpp"

#include "io/text.hpp"
#include "report/statistics.hpp"

#include <fmt/format.h>

#include <cmath>

namespace isostat {

std::vector<std::pair<double, double>> TriaxialBranch::stairs() const {
    std::vector<std::pair<double, double>> all;
    for (const TriaxialPoint& at : points) {
        if (!all.empty()) {
            all.emplace_back(all.back().first, at.q / at.p);
        }
        all.emplace_back(at.axial, at.q / at.p);
    }
    return all;
}

std::vector<std::pair<double, double>> TriaxialBranch::volume() const {
    std::vector<std::pair<double, double>> all;
    for (const TriaxialPoint& at : points) {
        all.emplace_back(at.axial, at.volumetric);
    }
    return all;
}

std::vector<TriaxialBranch> triaxial_branches(const std::vector<EquilibriumRow>& rows, const Load& load,
                                              const std::vector<std::string>& names) {
    std::vector<TriaxialBranch> all;
    for (const auto& [segment, path] : segment_paths(rows, names)) {
        all.push_back({path.title, triaxial_points(path.rows, load)});
    }
    return all;
}

std::vector<TriaxialPoint> triaxial_points(std::span<const EquilibriumRow> rows, Load load) {
    std::vector<TriaxialPoint> points;
    for (const EquilibriumRow& row : rows) {
        load.set_loaded_stress(row.stress);
        TriaxialPoint at{row.number, 0, 0, load.mean_stress(), load.deviator()};
        for (std::size_t a = 0; a < row.length.size(); ++a) {
            at.axial = std::log(load.reference_length[a] / row.length[a]); // the value of the last axis remains
            at.volumetric += at.axial;
        }
        points.push_back(at);
    }
    return points;
}

Chart triaxial_chart(const std::vector<TriaxialBranch>& branches, bool pdf) {
    Chart chart;
    chart.name = "triaxial";
    std::string ratio;
    std::string volume;
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
                                k % 5 + 1, text::gnuplot(chart_hues[k % chart_hues.size()]),
                                text::gnuplot(branches[k].title));
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

} // namespace isostat
