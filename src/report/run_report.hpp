#pragma once
/// \file
/// Tables and figures of a run or of a state.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace isostat {

/// What a report has to contain.
struct ReportOptions {
    bool pictures = true;                                     ///< force pictures (SVG), data and scripts of the charts
    bool charts = true;                                       ///< call gnuplot on the scripts (SVG and PNG)
    bool vtk = false;                                         ///< ParaView files
    bool pdf = false;                                         ///< charts as PDF too
    bool contacts = false;                                    ///< contacts_*.csv of each state: `contact_table`
    bool html = false;                                        ///< of a run: trajectory.html
    std::function<void(std::size_t, std::size_t)> progress{}; ///< of the page: arcs processed, arcs of the run
};

/// What a report made.
struct ReportResult {
    std::string text;                         ///< tables, for a terminal (of a run also in report.txt)
    std::vector<std::filesystem::path> files; ///< pictures, data and scripts, in the order in which they were written
    std::vector<std::string> notes;           ///< what was not made, and the reason
};

/// Report of the folder of a run, finished or not, into `output`:
/// - staircase: sigma2/sigma1 against eps2 (paper, figure 2); cycles: the segments that start from an earlier
/// equilibrium (figure 3);
/// - stress_increments, strain_increments: their distributions, linear and logarithmic (figures 4 and 5);
/// - trajectory.html, when requested: `run_page`;
/// - force pictures of the stored states: the first, the last, and those that segments start from.
/// Each chart is a data file (.dat), a gnuplot script (.gp), and .svg and .png when gnuplot is there; otherwise a note
/// says so. Throws `Error(bad_input)` when the folder holds no run, `Error(cannot_write)`.
ReportResult report_run(const std::filesystem::path& directory, const std::filesystem::path& output,
                        const ReportOptions& options);

/// Force picture, and VTK file if requested, of one state. Forces are those of the file, or else solved for here.
ReportResult report_state(const std::filesystem::path& state, const std::filesystem::path& output,
                          const ReportOptions& options);

/// P(f / <f>) of the force-carrying contacts of all samples of an ensemble together, each over the mean force of its
/// sample: once for the first equilibria and once for the last ones, in bins of 1/4. Writes force_distribution.dat, .gp
/// and the charts of gnuplot. Forces are those of the files, as computed.
ReportResult report_forces(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& output,
                           const ReportOptions& options);

} // namespace isostat
