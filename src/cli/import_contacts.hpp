#pragma once
/// \file
/// `isostat import`: the contacts that the vertex must have, and those that it has.

#include "cli/commands.hpp"
#include "cli/read_packing.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <string>
#include <vector>

namespace isostat::cli {

/// A packing must be this near to touching, in smallest radii: overlaps, and gaps at every wall.
inline constexpr double nearly_touching = 0.1;

/// The contacts that the vertex must have.
struct Wanted {
    bool any = false; ///< whatever the vertex has
    std::vector<Contact> contacts;
    std::string words; ///< where they come from
};

/// As the arguments ask: of the nearest vertex, of thresholds, or of forces in a file.
Result<Wanted> wanted_contacts(const ImportArguments& a, const ReadPacking& file);

/// The contacts of a state that carry a force, as its certificate says.
std::vector<Contact> carrying(const State<2>& state, const Certification& truth);

/// Words on the contacts of the vertex against those wanted; a failure where they must be the same and are not.
Result<std::string> compared(const Wanted& wanted, const std::vector<Contact>& found);

} // namespace isostat::cli
