#pragma once
/// \file
/// A run, or packings of spheres, as one HTML file that opens without network; numbers as text that such a page can
/// hold.

#include "io/json.hpp"
#include "report/triaxial.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace isostat {

struct Page {
    std::string html;
    std::vector<std::string> left_out; ///< parts of the run that the page omits, in words
};

/// The page of the folder of a run, finished or not: staircase, packing at every equilibrium and every
/// arc, forces, contacts that opened and closed, tables, what was proved. Positions are recomputed
/// from the records in double (`walk_run`) and rounded to a fraction of the mean radius; forces are
/// those of equilibria, rounded to a sixteenth of their mean: for display, not for computation. Beyond
/// six million coordinates the page omits arcs, then equilibria, at regular intervals, and says so.
/// `progress`: arcs processed, and arcs of the run. Throws `Error(bad_input)`.
Page run_page(const std::filesystem::path& directory, const std::function<void(std::size_t, std::size_t)>& progress);

/// Source of the page, with a placeholder for its data.
extern const char* const page_template;

/// Integers of few bytes each when they are small: seven bits per byte, lowest first, the sign in the lowest bit.
void append_varint(std::string& bytes, std::int64_t value);

/// Base64 of the bytes in zlib's format, which browsers undo (`DecompressionStream("deflate")`).
std::string packed(const std::string& bytes);

/// Further data on the page of a run.
struct SphereRun {
    bool triaxial = false; ///< the length of an axis is loaded: q/p is drawn against the axial strain
    std::vector<EquilibriumRow> rows{};
    Load load{};                      ///< of any state of the run
    std::vector<std::string> names{}; ///< names of the segments
};

/// A page with a rotating view of the packings, one stored state at a time, with its forces; for a run also q/p and the
/// volumetric strain against the axial strain, and the table of the equilibria. For display, not for computation.
/// \param states array of `sphere_view`
std::string sphere_page(const std::string& title, const json::Json& states, const SphereRun& run = {});

} // namespace isostat
