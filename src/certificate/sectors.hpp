#pragma once
/// \file
/// Contacts of bodies bounded by arcs: private to the room.

#include "packing/arc_bodies.hpp"

#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// Why the circles of these contacts may not be those that touch, the true vertex being `distance` (2-norm) from the
/// packing at most; nothing: every normal is inside the sectors of both members (U9).
std::optional<std::string> beyond_sectors(const ArcBodies& arcs, const std::vector<Contact>& contacts, double distance);

} // namespace isostat
