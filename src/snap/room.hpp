#pragma once
/// \file
/// Places for rattlers without overlap beside a vertex.

#include "contact/candidates.hpp"

#include <isostat/snap/snap.hpp>

#include <string>

namespace isostat::compare {

/// Moves the rattlers of `snap.packing` until no pair with one of them overlaps at
/// the true vertex, and sets `snap.cage`. Empty, or the pair that still overlaps:
/// this does not prove that no place exists. \pre the vertex is claimed.
std::string make_room(Snap& snap);

/// A rattler proved to have no place: anywhere within a quarter of the smallest radius of `snap.packing` it overlaps a
/// grain of the list at the true vertex. Empty: not proved of any. \pre the vertex is claimed.
std::string without_room(const Snap& snap);

} // namespace isostat::compare
