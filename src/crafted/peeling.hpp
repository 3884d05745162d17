#pragma once
// Rattlers and carrying contacts for every initial part of a list of contacts at once.

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <vector>

namespace isostat::crafted {

/// The result of `exclude_contacts` for the first m contacts of a list, for every m: adding contacts never makes
/// another contact unable to carry, so each contact and each disk has one m from which on it carries.
struct Peeling {
    std::vector<int> contact_from; ///< contact l carries with the first m contacts exactly when m >= contact_from[l]
    std::vector<int> disk_from;    ///< disk i is no rattler exactly when m >= disk_from[i]; 0 for fixed disks
};

/// Removes the contacts from the last to the first; each removal compares only the two neighbours in angle. Every sign
/// is decided. Throws `Error(bad_input)` when two disks of a contact have the same centre. Cost O(N log N) without
/// near-parallel normals, which are decided in rationals. For spheres and clumps: `peel_in_space`.
Peeling peel(const Packing& packing, const std::vector<Contact>& contacts);

/// Peels spheres by planes through a centre that leave every contact of the sphere on one side, each sign decided by
/// intervals or in rationals. Bodies are peeled as wholes: in the plane forces and torques are to balance, in space
/// the forces. Cost: for a grain with z contacts O(z^3) signs for every contact that it loses.
Peeling peel_in_space(const Packing& packing, const std::vector<Contact>& contacts);

} // namespace isostat::crafted
