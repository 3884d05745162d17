#pragma once
/// \file
/// The charts of a run: data and gnuplot scripts.

#include "report/words.hpp"

#include <isostat/io/run_directory.hpp>

#include <string>
#include <vector>

namespace isostat {

/// One chart: NAME.dat, NAME.gp; the script makes NAME.svg and NAME.png.
struct Chart {
    std::string name, data, script;
};

/// The gnuplot script that draws `body` to NAME.svg and NAME.png of this size in pixels; with `pdf` also to NAME.pdf.
std::string chart_script(const std::string& name, int width, int height, const std::string& body, bool pdf = false);

/// Staircase of the main path, cycles, distributions, as far as they have data. `names`: names of the segments.
std::vector<Chart> make_charts(const std::vector<EquilibriumRow>& rows, const std::vector<std::string>& names,
                               const LoadWords& words = biaxial_words, bool pdf = false);

} // namespace isostat
