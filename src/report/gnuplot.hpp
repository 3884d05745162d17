#pragma once
/// \file
/// Charts by gnuplot, an external program.

#include <filesystem>
#include <string>

namespace isostat {

/// Runs `gnuplot SCRIPT` in a folder (no shell). Empty on success, otherwise why there is no chart: gnuplot is missing,
/// or its status. The output of gnuplot goes to NAME.log beside the script, which is removed on success.
std::string run_gnuplot(const std::filesystem::path& folder, const std::string& script);

} // namespace isostat
