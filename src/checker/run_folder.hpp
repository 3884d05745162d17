#pragma once
/// \file
/// Checks of the folder of a run before its records are replayed: finished or not, damaged or not.

#include "checker/replay.hpp"

namespace isostat::checker {

/// run.json says that the run goes on, or was killed: its records are not complete.
bool is_running(const std::filesystem::path& directory);

/// Checks the digests of checkpoint.json, that the last state is that of the last row, and that checkpoint.json and
/// summary.json agree with the records. Throws `Error(bad_input)` where a file cannot be read.
Objections check_folder(const std::filesystem::path& directory, const RunRecords& records);

/// Files that no run writes, and files of equilibria that do not exist, in words.
std::vector<std::string> files_apart(const RunRecords& records);

/// Checks that the certificate file of an equilibrium, in a run of level `states` or above, is of this equilibrium and
/// has right claims. `line`: the row of equilibria.csv, which says whether everything is claimed.
Objections check_certificate(const RunRecords& records, const Place& place, const EquilibriumLine& line);

} // namespace isostat::checker
