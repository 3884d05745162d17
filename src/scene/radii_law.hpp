#pragma once
/// \file
/// The keys of [packing] that say how radii are drawn.

#include "scene/section.hpp"

#include <isostat/preparation/preparation.hpp>

namespace isostat {

/// The law, with its defaults recorded. Throws `Error(bad_input)`
/// for keys of another law and for a law with a fault.
DiameterLaw read_law(Section& section);

/// Reads every key of a law, so that all are known, and refuses
/// those that are present: "has no meaning with `source`".
void refuse_law(Section& section, const std::string& source);

} // namespace isostat
