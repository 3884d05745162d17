#pragma once
/// \file
/// Spheres as one HTML file that opens without network.

#include "io/json.hpp"
#include "report/triaxial.hpp"

#include <string>
#include <vector>

namespace isostat {

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
