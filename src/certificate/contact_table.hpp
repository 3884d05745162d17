#pragma once
/// \file
/// The contacts of a state as a table for other programs.

#include <isostat/certificate/certify.hpp>

#include <string>

namespace isostat {

/// The unit normal from the first grain to the second one, or to the wall.
PerAxis<double> outward(const State& state, const Contact& contact);

/// CSV, one row per contact in the order of the state: `contact` (its name), `i`, `j` (of a wall its name), the image
/// `mx`, `my`, `mz` of j, the point on the surface of i `x`, `y`, `z`, the unit normal from i to j `nx`, `ny`, `nz`,
/// the gap of the stored coordinates `gap`, the finite force `force` with proved ends `force_low`, `force_high` (empty
/// where they are not known, 0 where the force is exactly 0) and `force_infinitesimal` where that is claimed. In the
/// plane without the columns of z. Lengths in the unit of the file, forces in stress times length, in space times
/// length squared.
std::string contact_table(const State& state, const Certification& truth);

/// What the text begins with.
inline constexpr const char* contact_table_mark = "contact,i,j,mx,my";

} // namespace isostat
