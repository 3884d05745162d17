#pragma once
/// \file
/// One state as a picture: SVG for people, VTK for ParaView. Places are those in the plane (third component 0) and in
/// space.

#include "io/json.hpp"

#include <isostat/contact/state.hpp>

#include <span>
#include <string>

namespace isostat {

/// SVG text: disks (rattlers in another shade), walls (fixed ones dark, movable ones light) and a line per contact from
/// centre to centre, or to the wall, of width proportional to the force (a quarter of the mean radius at the mean
/// force). Traction, which no equilibrium has, is drawn in another colour; contacts without force are hairlines. Arrows
/// on movable walls stand for their stresses; below the box are lines of the mean force and of three times the mean
/// force. `forces`: one per contact, or empty (contacts are then hairlines, no disk is marked as a rattler). `caption`
/// is a line below. The text is a function of the arguments alone. In a cell periodic sides are dashed, the disks are
/// moved into the cell, images outside are fainter, and a contact with an image is drawn from both sides.
std::string force_picture(const State& state, std::span<const double> forces, const std::string& caption);

/// The same for spheres: a view along y, far spheres first and darker; the forces as lines; the cuts of horizontal
/// planes at a quarter, half and three quarters of the height, images included. Rattlers are blue. In a cell the
/// spheres are moved into it. \pre `state.packing.dimension` is 3
std::string sphere_picture(const State& state, std::span<const double> forces, const std::string& caption);

/// The data that the page of spheres draws: `equilibrium`, `centre` and `reach` (half the diagonal) of all, mean
/// `radius`, `balls` (x, y, z, radius, 1 for a rattler), `lines` (a contact from centre to centre, to the wall or to
/// the image; the force over the mean force, with its sign), `edges` of box or cell. \pre as above
json::Json sphere_view(const State& state, std::span<const double> forces);

/// The first line of a VTK file.
inline constexpr const char* vtk_mark = "# vtk DataFile Version 3.0\n";

/// VTK legacy file (ASCII POLYDATA) of disks or spheres: a point and a vertex per grain with `radius`, `contacts`
/// (their number) and `rattler`, a line per contact with `force`; contacts with walls end in extra points of radius 0
/// on the wall, those with images at the centre of the image, of radius 0 too. The last lines, of force 0, are the
/// outline of a cell. 17 digits. `displacement`: empty, or d per grain: `displacement`, 0 on the extra points. Of
/// spheres every line has points of its own with `tube`, a radius proportional to the force (a quarter of the mean
/// radius at the mean force): ParaView's filter Tube draws the forces with "Vary Radius: By Absolute Scalar".
std::string vtk_text(const State& state, std::span<const double> forces, const std::string& title,
                     std::span<const double> displacement = {});

/// 1 for disks without a contact of non-zero force; 0 for all where there are no forces. \pre none, or one per contact
std::vector<unsigned char> rattler_flags(const State& state, std::span<const double> forces);

/// The same packing with its grains in the cell, and with the images that its contacts then have.
State in_cell(State state);

PerAxis<double> centre_of(const Packing& packing, int grain);

/// End of the line of a contact: on the wall, or at the centre of the second grain or of its image.
PerAxis<double> end_of(const Packing& packing, const Contact& contact);

/// A corner of the box or cell, with 0 or the whole length along each axis by the bits of a number. Along an axis with
/// walls the cell extends from wall to wall.
PerAxis<double> corner(const Packing& packing, unsigned bits);

/// Of the forces that are not 0; 1 without such forces.
double mean_force(std::span<const double> forces);

} // namespace isostat
