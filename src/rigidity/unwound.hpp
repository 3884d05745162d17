#pragma once
/// \file
/// Contacts among images as contacts among disks (proofs/degenerate.md, R1): private to the rooms on the right.

#include <isostat/core/contact.hpp>

#include <optional>
#include <vector>

namespace isostat {

/// The same contacts after every disk is replaced by one of its images so that no contact goes to another image: a
/// change of coordinates x_i + A k_i. Nothing where a cycle of contacts winds around the cell, or where a contact is a
/// held coordinate. Cost O(contacts + disks); without images O(contacts).
std::optional<std::vector<Contact>> unwound(int disks, std::vector<Contact> contacts);

} // namespace isostat
