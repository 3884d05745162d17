#pragma once
/// \file
/// Where grains, contacts and the outline are in a picture, in the plane (third component 0) and in space.

#include <isostat/contact/state.hpp>

#include <span>

namespace isostat {

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
