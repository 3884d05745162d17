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

/// Removes the contacts from the last to the first. A grain loses its contacts off a line, in space off a plane,
/// through its centre that leaves every contact on one side (`able`); each sign is decided by intervals or in
/// rationals. Bodies are peeled as wholes: in the plane forces and torques are to balance, in space the forces. Throws
/// `Error(bad_input)` when two grains of a contact have the same centre. Cost: for a grain with z contacts O(z^2)
/// signs, in space and of bodies O(z^3), for every contact that it loses.
Peeling peel(const Packing& packing, const std::vector<Contact>& contacts);

} // namespace isostat::crafted
