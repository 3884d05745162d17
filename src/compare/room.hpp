#pragma once
/// \file
/// Room for rattlers beside a vertex.

#include "contact/candidates.hpp"

#include <isostat/compare/snap.hpp>

#include <string>

namespace isostat::compare {

/// Moves the rattlers of `snap.packing` until no pair with one of them overlaps at the true vertex, and sets
/// `snap.cage`. Empty, or which pair kept too little room: that is no proof that there is none. \pre the vertex is
/// claimed.
std::string make_room(Snap& snap);

} // namespace isostat::compare
