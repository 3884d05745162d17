#pragma once
/// \file
/// Contacts among images as contacts among disks (proofs/degenerate.md, R1): private to the rooms on the right.

#include <isostat/core/contact.hpp>

#include <optional>
#include <vector>

namespace isostat {

/// The same contacts once every disk is replaced by one of its images, so that none of them goes to another image: a
/// change of coordinates x_i + A k_i. Nothing where a closed way of contacts winds around the cell, or one is a held
/// coordinate. Cost O(contacts + disks); of contacts without images O(contacts).
std::optional<std::vector<Contact>> unwound(int disks, std::vector<Contact> contacts);

} // namespace isostat
