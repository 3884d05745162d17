#pragma once
/// \file
/// A comparison as files: tables, JSON, the figure; and the table of what stiffness does to a run.

#include <isostat/compare/compare.hpp>

#include <filesystem>
#include <string>

namespace isostat::compare {

/// The tables comparison.csv (one row per frame), path.csv (one per equilibrium of the exact run), bundle/nodes.csv and
/// bundle/members.csv. Of spheres the loaded stress is sigma3.
std::string frames_csv(const Comparison& comparison);
std::string path_csv(const Comparison& comparison);
std::string bundle_csv(const Comparison& comparison);
std::string members_csv(const Comparison& comparison);
/// One object: frames, path, counts, departure, status. null where a number was not found.
std::string comparison_json(const Series& series, const Comparison& comparison);

/// Writes comparison.csv, path.csv, comparison.json, bundle/ (nodes.csv, members.csv, node_NNNN.json, a state each) and
/// the figure comparison.svg, .png (staircase with the frames;
/// statuses and exact limits against the load; errors of the forces in three parts), each of them atomically. Returns
/// empty, or why there is no figure (gnuplot; its data and script are there). Throws `Error(cannot_write)`.
std::string write_comparison(const std::filesystem::path& folder, const Series& series, const Comparison& comparison);

/// The effect of finite stiffness on the loads at which the structures of a run end: table of the stored equilibria of
/// a run (box): both ends of the supported interval, the loads at which grains of this stiffness leave it (force =
/// stiffness x overlap), and the stiffness for which the end is right to 1e-3. Predictions. Writes
/// OUTPUT/soft_limits.csv and returns the table as text. Throws `Error(bad_input)` for a cell.
std::string soft_limits(const std::filesystem::path& run, const std::filesystem::path& output, double stiffness);

} // namespace isostat::compare
