#pragma once
/// \file
/// A run of spheres as a triaxial test: the axis z is axial.

#include "report/charts.hpp"

#include <isostat/contact/state.hpp>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// An equilibrium: logarithmic strains since the reference lengths, positive in compression; mean stress p, and q, the
/// axial stress minus the mean of the other two.
struct TriaxialPoint {
    int number = 0;
    double axial = 0, volumetric = 0, p = 0, q = 0;
};

/// `load`: load of any state of the run. \pre rows of spheres
std::vector<TriaxialPoint> triaxial_points(std::span<const EquilibriumRow> rows, Load load);

/// A segment of the programme: the point at its start, and its own points. At constant structure the stress changes, at
/// constant stress the strain jumps.
struct TriaxialBranch {
    std::string title;
    std::vector<TriaxialPoint> points;
    [[nodiscard]] std::vector<std::pair<double, double>> stairs() const; ///< axial strain, q/p, both ends of a jump
    [[nodiscard]] std::vector<std::pair<double, double>> volume() const; ///< axial, volumetric strain
};
/// `names`: names of the segments. \pre as above
std::vector<TriaxialBranch> triaxial_branches(const std::vector<EquilibriumRow>& rows, const Load& load,
                                              const std::vector<std::string>& names);

/// q/p and the volumetric strain against the axial strain; the data file is the table of the points.
Chart triaxial_chart(const std::vector<TriaxialBranch>& branches, bool pdf);

} // namespace isostat
