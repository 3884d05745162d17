#pragma once
/// \file
/// States and lists without rattlers.

#include <isostat/contact/state.hpp>

#include <vector>

namespace isostat::compare {

/// These disks alone, with walls or cell. The pinned disk is the same if it is among them, else the first.
Packing of_disks(const Packing& packing, const std::vector<int>& disks);

/// The disks and movable walls that `carrying` holds, in these contacts, under the same load; infinitesimal loads are
/// generic ones of their own.
State backbone_of(const State& state, const std::vector<Contact>& carrying);

/// The contacts that can carry a force by the positions of the normals, in their order: soft rattlers touch now and
/// then, and hard ones rest on two contacts. Held coordinates are left out. Of spheres nothing else is: normals in
/// space are not looked at.
std::vector<Contact> able_to_carry(const Packing& packing, std::vector<Contact> contacts);

} // namespace isostat::compare
