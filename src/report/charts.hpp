#pragma once
/// \file
/// The figures of a run as charts and as text: data, scripts of gnuplot (an external program), tables.

#include <isostat/io/run_directory.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace isostat {

/// Names of the loaded quantity in tables and figures.
struct LoadWords {
    std::string ratio;      ///< as `Load::ratio_name`
    std::string strain;     ///< as `Load::strain_name`
    std::string rising;     ///< words for a rising ratio
    std::string falling;    ///< words for a falling ratio
    std::string ratio_axis; ///< labels of axes, UTF-8
    std::string strain_axis;
    std::string ratio_step; ///< labels of distributions of increments
    std::string strain_step;
    std::string ratio_sign; ///< short, UTF-8
    std::string strain_sign;
    std::string other_strain; ///< strain of the axis of the denominator of the ratio
    std::string stress_sign;
};

/// The words for a load; in space they name the loaded axis or tilt.
LoadWords load_words(const Load& load);

/// One chart: NAME.dat, NAME.gp; the script makes NAME.svg and NAME.png.
struct Chart {
    std::string name, data, script;
};

/// Colours of the curves, in turn.
inline constexpr std::array<const char*, 6> chart_hues{"#1f4e79", "#c55a11", "#548235",
                                                       "#7b3f99", "#997300", "#a61c3c"};

/// The gnuplot script that draws `body` to NAME.svg and NAME.png of this size in pixels; with `pdf` also to NAME.pdf.
std::string chart_script(const std::string& name, int width, int height, const std::string& body, bool pdf = false);

/// Staircase of the main path, cycles, distributions, as far as they have data. `names`: names of the segments.
std::vector<Chart> make_charts(const std::vector<EquilibriumRow>& rows, const std::vector<std::string>& names,
                               const LoadWords& words = load_words({}), bool pdf = false);

/// Segments, increments, arcs, checks. `names`: names of the segments; `status`: status in run.json.
std::string run_tables(const std::vector<EquilibriumRow>& rows, const std::vector<std::string>& names,
                       const std::string& status, const LoadWords& words = load_words({}));

/// Runs `gnuplot SCRIPT` in a folder (no shell). Empty on success, otherwise why there is no chart: gnuplot is missing,
/// or its status. The output of gnuplot goes to NAME.log beside the script, which is removed on success.
std::string run_gnuplot(const std::filesystem::path& folder, const std::string& script);

} // namespace isostat
