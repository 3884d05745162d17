#pragma once
/// \file
/// A run of spheres as a triaxial test: the axis z is axial.

#include "report/charts.hpp"

#include <isostat/contact/state.hpp>

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// An equilibrium: logarithmic strains since the lengths of reference, positive in compression; mean stress p, and q,
/// the axial stress less the mean of the others.
struct TriaxialPoint {
    int number = 0, segment = 0, previous = -1;
    double axial = 0, volumetric = 0, p = 0, q = 0;
};

/// `load`: of any state of the run. \pre rows of spheres
std::vector<TriaxialPoint> triaxial_points(std::span<const EquilibriumRow> rows, Load load);

/// q/p and the volumetric strain against the axial strain; the data are the table of the points.
Chart triaxial_chart(std::span<const TriaxialPoint> points, const std::vector<std::string>& names, bool pdf);

/// A page that opens without network: both curves, the table of the equilibria, and the pictures of the stored states
/// (number and SVG), one at a time. `title` is a line of text.
std::string triaxial_page(std::span<const TriaxialPoint> points, std::span<const EquilibriumRow> rows,
                          const std::vector<std::string>& names, const LoadWords& words, const std::string& title,
                          std::span<const std::pair<int, std::string>> pictures);

} // namespace isostat
