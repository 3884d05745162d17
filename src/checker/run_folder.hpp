#pragma once
/// \file
/// What can be said of the folder of a run before its records are replayed: finished or not, damaged or not.

#include "checker/replay.hpp"

namespace isostat::checker {

/// run.json says that the run goes on, or was killed: its records are not complete.
bool is_running(const std::filesystem::path& directory);

/// Digests of checkpoint.json; the last state is that of the last row; what checkpoint.json and summary.json repeat of
/// the records is there. Throws `Error(bad_input)` where one of them cannot be read.
Objections check_folder(const std::filesystem::path& directory, const RunRecords& records);

/// Files that no run writes, and those of equilibria that there are not: in words.
std::vector<std::string> files_apart(const RunRecords& records);

/// The certificate file of an equilibrium of a run of level `states` or above is of this equilibrium, and its claims
/// are right. `line`: the row of equilibria.csv, which says whether it claims everything.
Objections check_certificate(const RunRecords& records, const Place& place, const EquilibriumLine& line);

} // namespace isostat::checker
