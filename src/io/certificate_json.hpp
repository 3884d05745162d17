#pragma once
/// \file
/// Parts of the text of a certificate.

#include "io/json.hpp"

#include <isostat/io/state_file.hpp>

#include <string>

namespace isostat::json {

/// A member of a document in one line.
inline std::string member_line(const char* name, const Json& value) {
    return "\"" + std::string(name) + "\": " + dumped(value);
}

/// The member "claims", each claim in one line. Throws `Error(bad_input)` as `certificate_text` does.
std::string claims_text(const CertificateClaims& claims, int dimension);

/// What `claims_text` wrote. Throws as `parse_certificate` does.
CertificateClaims claims_of(const Field& field, const State& state);

/// SHA-256 of a document without its field "digest", dumped without white space and with sorted keys.
std::string digest_of(const Json& document);

} // namespace isostat::json
