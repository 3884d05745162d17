#pragma once
/// \file
/// Contacts, gaps and their gradients.

#include <isostat/core/contact.hpp>
#include <isostat/packing/packing.hpp>

#include <array>
#include <string>

namespace isostat {

/// "12-40", "12-40(1,-1)" of the image one period further along x and one back along y, "12-left", "12-top", "held x of
/// disk 3".
std::string to_string(const Contact& contact, int dimension = 2);

/// Derivative of a gap with respect to the coordinates: at most 2 d entries and those of the cell, coordinate indices
/// as in `Packing::q`, components are those of the unit normal, on the cell m_a times them. Column l of H is minus this
/// vector restricted to the degrees of freedom (H = G^T, and G gives approach velocities). For a held coordinate the
/// gradient is +1 on that coordinate.
struct GapGradient {
    static constexpr std::size_t most = most_axes * 2 + most_axes + most_tilts;
    int count = 0;
    std::array<int, most> coordinate{};
    std::array<double, most> value{};
};

/// Gap h: distance of the surfaces, >= 0 in an admissible packing. Held: 0.
/// Error: at most 4 ulp of the distance of the centres beyond the exactly rounded operations, for coordinates on the
/// grid.
double gap(const Packing& packing, const Contact& contact);

/// Gradient of the gap. Each component has relative error <= 4u (u = 2^-53) for coordinates on the grid.
GapGradient gap_gradient(const Packing& packing, const Contact& contact);

/// Second derivative of the gap along a velocity v (on coordinates): |tangential relative velocity|^2 / distance; 0 for
/// walls.
double gap_curvature(const Packing& packing, const Contact& contact, const double* v);

} // namespace isostat
