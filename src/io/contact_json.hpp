#pragma once
/// \file
/// Contacts in state files: [i, j] for two disks, [i, j, [mx, my]] for the image of the second, [i, "left"] for a wall,
/// ["held", coordinate] for a held coordinate.

#include "io/json.hpp"

namespace isostat::json {

template <int Dim> Json contact_to_json(const Contact& contact);

/// The contact. Throws `Error(bad_input)` when an index is out of range, a disk touches itself, a wall is unknown or
/// absent, or `contact_to_json` spells it otherwise (disks in increasing order, no image [0, 0]).
template <int Dim> Contact contact_from_json(const Field& field, const Packing<Dim>& packing);

/// Throws `Error(bad_input)` naming the first contact that is listed twice, and its position. `name` is that of the
/// list.
template <int Dim>
void refuse_duplicates(const std::vector<Contact>& contacts, const std::string& source, const std::string& name);

} // namespace isostat::json
