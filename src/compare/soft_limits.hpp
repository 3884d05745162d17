#pragma once
/// \file
/// What finite stiffness does to the loads at which the structures of a run end.

#include <filesystem>
#include <string>

namespace isostat::compare {

/// Table of the stored equilibria of a run (box): both ends of the supported interval, where grains of that stiffness
/// would leave it (force = stiffness x overlap), and the stiffness for which the end is right to 1e-3. Predictions in
/// double. Writes OUTPUT/soft_limits.csv and returns the table for the screen. Throws `Error(bad_input)` for a cell.
std::string soft_limits(const std::filesystem::path& run, const std::filesystem::path& output, double stiffness);

} // namespace isostat::compare
