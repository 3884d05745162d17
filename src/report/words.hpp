#pragma once
/// \file
/// Names of the loaded quantity in tables and figures.

#include <isostat/packing/load.hpp>

#include <string>

namespace isostat {

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

} // namespace isostat
