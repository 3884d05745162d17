#pragma once
/// \file
/// The figures of a run as text.

#include "report/words.hpp"

#include <isostat/io/run_directory.hpp>

#include <string>
#include <vector>

namespace isostat {

/// Segments, increments, arcs, checks. `names`: names of the segments; `status`: status in run.json.
std::string run_tables(const std::vector<EquilibriumRow>& rows, const std::vector<std::string>& names,
                       const std::string& status, const LoadWords& words = biaxial_words);

} // namespace isostat
