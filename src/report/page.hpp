#pragma once
/// \file
/// A run as one HTML file that opens without network.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace isostat {

struct Page {
    std::string html;
    std::vector<std::string> left_out; ///< what is not on it, in words
};

/// The page of the folder of a run, finished or not: staircase, packing at every equilibrium and every arc, forces,
/// what opened and closed, tables, what was proved. Positions are found again from the records in double
/// (`walk_run`) and rounded to a fraction of the mean radius; forces are those of equilibria, rounded to a sixteenth of
/// their mean: for looking, never for computing. Beyond six million coordinates only every so many arcs, then
/// equilibria, are on it, and the page says so.
/// `progress`: arcs gone through, and of the run. Throws `Error(bad_input)`.
Page run_page(const std::filesystem::path& directory, const std::function<void(std::size_t, std::size_t)>& progress);

/// Source of the page, with a place for its data.
extern const char* const page_template;

} // namespace isostat
