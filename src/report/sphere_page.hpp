#pragma once
/// \file
/// Spheres as one HTML file that opens without network.

#include "io/json.hpp"
#include "report/triaxial.hpp"
#include "report/words.hpp"

#include <span>
#include <string>
#include <vector>

namespace isostat {

/// What the page of a run has besides its packings.
struct SphereRun {
    bool triaxial = false; ///< the length of an axis is loaded: q/p is drawn against the axial strain
    std::span<const TriaxialPoint> points;
    std::span<const EquilibriumRow> rows; ///< of the points
    std::vector<std::string> names;       ///< of the segments
    LoadWords words;
};

/// A page with a view of the packings that turns, one stored state at a time, with its forces; of a run also q/p and
/// the volumetric strain against the axial strain, and the table of the equilibria. For looking, never for computing.
/// \param states array of `sphere_view`
std::string sphere_page(const std::string& title, const json::Json& states, const SphereRun& run = {});

} // namespace isostat
