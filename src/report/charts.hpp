#pragma once
/// \file
/// The figures of a run as charts and as text: data, scripts of gnuplot (an external program), tables.

#include "report/words.hpp"

#include <isostat/io/run_directory.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace isostat {

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
