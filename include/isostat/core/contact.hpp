#pragma once
/// \file
/// The name of a contact: what touches what. Its geometry is in the room contact.

#include <compare>
#include <cstdint>

namespace isostat {

/// What touches what. `held` is not a contact: it is a coordinate kept at its value (design: power turns).
enum class ContactKind : std::uint8_t { disk_disk, lower_wall, upper_wall, held };

/// One contact, or one candidate.
/// - disk_disk: disks i < j;  - lower_wall, upper_wall: disk i and the wall of axis j;  - held: coordinate index i, j =
/// 0.
struct Contact {
    ContactKind kind = ContactKind::disk_disk;
    int i = 0;
    int j = 0;
    friend constexpr auto operator<=>(const Contact&, const Contact&) = default;
};

} // namespace isostat
