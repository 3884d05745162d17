#pragma once
/// \file
/// Room for rattlers beside a vertex.

#include "contact/candidates.hpp"

#include <isostat/snap/snap.hpp>

#include <string>

namespace isostat::compare {

/// Moves the rattlers of `snap.packing` until no pair with one of them overlaps at the true vertex, and sets
/// `snap.cage`. Empty, or which pair kept too little room: that is no proof that there is none. \pre the vertex is
/// claimed.
std::string make_room(Snap& snap);

/// Which rattler has none: wherever it is put within a quarter of the smallest radius of its place in `snap.packing`,
/// it overlaps a grain of the list at the true vertex. Proved. Empty: not shown of any. \pre the vertex is claimed.
std::string without_room(const Snap& snap);

} // namespace isostat::compare
