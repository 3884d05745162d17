#pragma once
/// \file
/// Parts of state files and of certificates. A contact is [i, j] for two disks, [i, j, [mx, my]] for the image of the
/// second, [i, "left"] for a wall, ["bar", i, j] for a bar, ["held", coordinate] for a held coordinate. Whatever reads
/// throws `Error(bad_input)`.

#include "io/json.hpp"

#include <isostat/io/state_file.hpp>

#include <string>

namespace isostat::json {

/// The state that `parse_state` reads, from an object of a document.
StateFile state_from_json(const Field& document, const std::string& source);

/// The member "cell" of a state, \pre some axis is periodic: {"moves", "axes", "tilt", "pin"}. Throws where a tilt is
/// not finite.
Json cell_json(const Packing& packing);

Json contact_to_json(const Contact& contact, int dimension);
/// Throws when an index is out of range, a disk touches itself, a wall is unknown or absent, or `contact_to_json`
/// spells it otherwise (disks in increasing order, no image [0, 0]).
Contact contact_from_json(const Field& field, const Packing& packing);
/// Throws naming the first contact that is listed twice, and its position. `name` is that of the list.
void refuse_duplicates(const std::vector<Contact>& contacts, int dimension, const std::string& source,
                       const std::string& name);

/// What a run under `ties = "choose"` adds: {"seed", "rho": [...], "load_zero": contact, "stress_rate": [value, bound],
/// "open": [[contact, value, bound], ...], "zero": the same}; the last four only when they say something.
Json perturbation_to_json(const RadiusPerturbation& perturbation, int dimension);
RadiusPerturbation perturbation_from_json(const Field& field, const Packing& packing);

/// A member of a document in one line.
inline std::string member_line(const char* name, const Json& value) {
    return "\"" + std::string(name) + "\": " + dumped(value);
}

/// The member "claims", each claim in one line. Throws `Error(bad_input)` as `certificate_text` does.
std::string claims_text(const CertificateClaims& claims, int dimension);

/// What `claims_text` wrote. Throws as `parse_certificate` does.
CertificateClaims claims_of(const Field& field, const State& state);

/// The text of a certificate whose state has the text `state`.
std::string certificate_text(const Certificate& certificate, std::string state);

/// SHA-256 of a document without its field "digest", dumped without white space and with sorted keys.
std::string digest_of(const Json& document);

} // namespace isostat::json
