#pragma once
/// \file
/// The effect of finite stiffness on the loads at which the structures of a run end.

#include <filesystem>
#include <string>

namespace isostat::compare {

/// Table of the stored equilibria of a run (box): both ends of the supported interval, the loads at which grains of
/// this stiffness leave it (force = stiffness x overlap), and the stiffness for which the end is right to 1e-3.
/// Predictions. Writes OUTPUT/soft_limits.csv and returns the table as text. Throws `Error(bad_input)` for a cell.
std::string soft_limits(const std::filesystem::path& run, const std::filesystem::path& output, double stiffness);

} // namespace isostat::compare
